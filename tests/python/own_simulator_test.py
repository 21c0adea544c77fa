# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Simulators written in Python, in searches, plans and single digs."""

import gc
import threading
import unittest

import excavplan as ex

MACHINE = ex.load_machine("zx120")
LOAM = ex.load_soil("loam")
GROUND = ex.level_planning_ground(MACHINE)
FEW = ex.DigSearchOptions(evaluations=40, threads=8)


class Own(ex.SoilSimulator):
    """Digs with the built-in one."""

    def __init__(self, machine, soil, density_percent):
        super().__init__()
        self.inner = ex.HeightMapSimulator(machine, soil, density_percent)

    def dig(self, terrain, path, options):
        return self.inner.dig(terrain, path, options)

    def identity(self):
        return self.inner.identity()


def failing(error, after=0):
    """A simulator whose digs raise, from one on."""

    class Failing(Own):
        digs = 0

        def dig(self, terrain, path, options):
            Failing.digs += 1
            if Failing.digs > after:
                raise error
            return super().dig(terrain, path, options)

    return Failing


class OwnSimulator(unittest.TestCase):
    def test_a_search_gives_what_the_built_in_one_gives(self):
        own = ex.plan_dig(MACHINE, LOAM, 40, GROUND, method="search", search=FEW, simulator=Own)
        same = ex.plan_dig(MACHINE, LOAM, 40, GROUND, method="search", search=FEW)
        self.assertEqual(own.dig.energy, same.dig.energy)
        self.assertEqual(own.search.ranks.tolist(), same.search.ranks.tolist())

    def test_its_digs_follow_each_other(self):
        inside, most = [0], [0]
        lock = threading.Lock()

        class Watched(Own):
            def dig(self, terrain, path, options):
                with lock:
                    inside[0] += 1
                    most[0] = max(most[0], inside[0])
                try:
                    return super().dig(terrain, path, options)
                finally:
                    with lock:
                        inside[0] -= 1

        ex.plan_dig(MACHINE, LOAM, ex.GroundDensity(40, 8), method="search", simulator=Watched,
                    search=FEW)
        ex.search_dig(MACHINE, Watched(MACHINE, LOAM, 40), GROUND, FEW)
        self.assertEqual(most[0], 1)

    def test_one_of_its_own_physics(self):
        class Simple(ex.SoilSimulator):
            def __init__(self, machine, soil, density_percent):
                super().__init__()

            def dig(self, terrain, path, options):
                drag = path.parameters.drag_length
                return ex.DigResult(payload_mass=100.0 * min(drag, 2.0), payload_volume=0.1,
                                    energy=ex.EnergyLedger(total=1000.0 + 20000.0 * drag))

        found = ex.search_dig(MACHINE, Simple(MACHINE, LOAM, 0), GROUND, FEW)
        self.assertEqual(found.dig.payload_mass,
                         100.0 * min(found.dig.parameters.drag_length, 2.0))
        scene = ex.simulate_dig(MACHINE, LOAM, 40, simulator=Own)
        self.assertEqual(scene.dig.payload_mass, ex.simulate_dig(MACHINE, LOAM, 40).dig.payload_mass)

    def test_it_may_stall(self):
        class Stalling(Own):
            def dig(self, terrain, path, options):
                return ex.DigResult(energy=ex.EnergyLedger(total=5000.0),
                                    stall=ex.Stall("drag", 0.7))

        stall = ex.evaluate_dig(MACHINE, Stalling(MACHINE, LOAM, 40), GROUND, ex.paper_fixed_path())
        self.assertFalse(stall)
        self.assertEqual((stall.phase, stall.travelled, stall.cause), ("drag", 0.7, "torque"))
        self.assertIsNone(ex.plan_dig(MACHINE, LOAM, 40, method="search", simulator=Stalling,
                                      search=FEW).dig)

    def test_its_exceptions_pass_through(self):
        for error in (KeyError("mine"), ZeroDivisionError("mine"), SystemExit(3)):
            simulator = failing(error, after=15)
            with self.assertRaises(type(error)) as raised:
                ex.plan_dig(MACHINE, LOAM, 40, method="search", simulator=simulator)
            self.assertIs(raised.exception, error)
            self.assertLess(simulator.digs, 20)
        with self.assertRaises(KeyError):
            ex.evaluate_dig(MACHINE, failing(KeyError())(MACHINE, LOAM, 40), GROUND,
                            ex.paper_fixed_path())
        with self.assertRaises(KeyError):
            ex.simulate_dig(MACHINE, LOAM, 40, simulator=failing(KeyError()))

    def test_an_error_of_excavplan_is_the_failure_of_one_dig(self):
        class Sometimes(Own):
            digs = 0

            def dig(self, terrain, path, options):
                Sometimes.digs += 1
                if 10 < Sometimes.digs < 15:
                    raise ex.Error("too wet")
                return super().dig(terrain, path, options)

        plan = ex.plan_dig(MACHINE, LOAM, 40, GROUND, method="search", search=FEW,
                           simulator=Sometimes)
        self.assertIsNotNone(plan.dig)
        self.assertIn("simulator_failed", [each.code for each in plan.warnings])

    def test_nonsense_is_refused(self):
        class NoDig(ex.SoilSimulator):
            pass

        class NoResult(Own):
            def dig(self, terrain, path, options):
                return 3.0

        class Uninitialised(ex.SoilSimulator):
            def __init__(self, machine, soil, density_percent):
                pass

        class FreeLunch(Own):
            def dig(self, terrain, path, options):
                return ex.DigResult(payload_mass=500.0, payload_volume=0.4)

        path = ex.paper_fixed_path()
        for simulator, error in ((NoDig(), TypeError), (NoResult(MACHINE, LOAM, 40), TypeError),
                                 (FreeLunch(MACHINE, LOAM, 40), ex.Error), (3.0, TypeError)):
            with self.assertRaises(error):
                ex.evaluate_dig(MACHINE, simulator, GROUND, path)
        for simulator in (Uninitialised, 3.0, lambda *given: "none", lambda: None):
            with self.assertRaises(TypeError):
                ex.plan_dig(MACHINE, LOAM, 40, method="search", simulator=simulator)
        with self.assertRaises(ex.Error):
            ex.plan_dig(MACHINE, LOAM, 40, method="search", simulator="sand-box")

    def test_the_base_has_no_digs(self):
        class Super(Own):
            def dig(self, terrain, path, options):
                return ex.SoilSimulator.dig(self, terrain, path, options)

            def identity(self):
                return "super of '" + ex.SoilSimulator.identity(self) + "'"

        simulator = Super(MACHINE, LOAM, 40)
        self.assertEqual(simulator.identity(), "super of ''")
        path = ex.make_dig_path(MACHINE, ex.paper_fixed_path())
        threads = threading.active_count()
        for dig in (lambda: simulator.dig(GROUND, path, None),
                    lambda: ex.evaluate_dig(MACHINE, simulator, GROUND, ex.paper_fixed_path()),
                    lambda: ex.simulate_dig(MACHINE, LOAM, 40, simulator=Super)):
            with self.assertRaisesRegex(TypeError, "must define dig"):
                dig()
        self.assertEqual(threading.active_count(), threads)

    def test_the_built_in_one_is_no_base(self):
        with self.assertRaisesRegex(TypeError, "base type"):
            type("Derived", (ex.HeightMapSimulator,), {"dig": lambda *given: ex.DigResult()})

    def test_nothing_is_left_behind(self):
        alive = []

        class Counted(Own):
            def __init__(self, *given):
                super().__init__(*given)
                alive.append(1)

            def __del__(self):
                alive.pop()

        for _ in range(3):
            ex.plan_dig(MACHINE, LOAM, ex.GroundDensity(40, 8), method="search", search=FEW,
                        simulator=Counted)
            with self.assertRaises(KeyError):
                ex.plan_dig(MACHINE, LOAM, 40, method="search",
                            simulator=type("Bad", (Counted,), {"dig": lambda *given: {}[1]}))
        gc.collect()
        self.assertEqual(alive, [])

    def test_plans_in_several_threads_of_python(self):
        results = []

        def plan():
            results.append(ex.plan_dig(MACHINE, LOAM, 40, GROUND, method="search", search=FEW,
                                       simulator=Own).dig.energy)

        threads = [threading.Thread(target=plan) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(set(results)), 1)


if __name__ == "__main__":
    unittest.main()
