# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Wrong shapes, types and numbers give errors, never a crash."""

import array
import copy
import itertools
import subprocess
import sys
import unittest

import excavplan as ex

NAN, INF = float("nan"), float("inf")
MACHINE = ex.load_machine("zx120")
LOAM = ex.load_soil("loam")
REFUSED = (ex.Error, TypeError, ValueError, OverflowError, MemoryError, AttributeError)


class Raising:
    """A sequence whose items cannot be had."""

    def __len__(self):
        return 3

    def __getitem__(self, index):
        raise ZeroDivisionError


class Hostile(unittest.TestCase):
    def test_shapes_and_items(self):
        wrong = ([1, 2, 3], [[1, 2], [3]], [[1, 2], [3, 4]], [["a", "b", "c"]], [[1, 2, None]],
                 "points", b"points", None, 3, {}, {"a": 1}, [[[1, 2, 3]]], Raising(), object(),
                 array.array("u", "abc"), [[1, 2, 3], 4])
        for points in wrong:
            with self.assertRaises((*REFUSED, ZeroDivisionError), msg=repr(points)):
                ex.Cloud(points)
        for z in (None, [1, 2], "z", [[1], [2, 3]], Raising()):
            with self.assertRaises((*REFUSED, ZeroDivisionError), msg=repr(z)):
                ex.HeightMap(z)
        for cell in (0, -1, NAN, INF, "a", None, 10 ** 400):
            with self.assertRaises(REFUSED):
                ex.HeightMap([[0.0]], cell_size=cell)

    def test_no_object_is_made_without_its_constructor(self):
        for name in ("Trajectory", "DigPlan", "Cloud", "Machine", "DigParameters", "HeightMap"):
            kind = getattr(ex, name)
            with self.assertRaisesRegex(TypeError, "without its constructor", msg=name):
                kind.__new__(kind)
        for copied in (copy.copy, copy.deepcopy):
            with self.assertRaises(TypeError):
                copied(MACHINE)
        self.assertEqual(ex.DigParameters(0.7, 0.3, 1.5).drag_length, 1.5)

    def test_the_interpreter_may_end_amid_calls_of_other_threads(self):
        for search in ("ex.DigSearchOptions(evaluations=100000)",
                       "ex.DigSearchOptions(evaluations=100000, progress=lambda state: True)"):
            ended = subprocess.run([sys.executable, "-c", f"""
import sys, threading, time
import excavplan as ex
machine, loam = ex.load_machine("zx120"), ex.load_soil("loam")
search = {search}
threading.Thread(daemon=True, target=lambda: ex.plan_dig(
    machine, loam, 40, method="search", search=search)).start()
time.sleep(0.5)
sys.exit(5)
"""], check=False, stderr=subprocess.PIPE, timeout=120)
            self.assertEqual((ended.returncode, ended.stderr), (5, b""))

    def test_the_interpreter_may_end_amid_digs_of_a_simulator_in_python(self):
        inner = "return self.inner.dig(terrain, path, options)"
        busy = "while True: sum(range(100))"
        for turn in range(10):
            ended = subprocess.run([sys.executable, "-c", f"""
import sys, threading, time
import excavplan as ex
machine, loam = ex.load_machine("zx120"), ex.load_soil("loam")
digging = threading.Event()

class Own(ex.SoilSimulator):
    def __init__(self, *given):
        super().__init__()
        self.inner = ex.HeightMapSimulator(*given)

    def dig(self, terrain, path, options):
        digging.set()
        {busy if turn % 2 else inner}

search = ex.DigSearchOptions(evaluations=100000)
for _ in range(3):
    threading.Thread(daemon=True, target=lambda: ex.plan_dig(
        machine, loam, 40, method="search", search=search, simulator=Own)).start()
digging.wait()
time.sleep({0.01 * turn})
sys.exit(5)
"""], check=False, stderr=subprocess.PIPE, timeout=120)
            self.assertEqual((ended.returncode, ended.stderr), (5, b""), turn)

    def test_a_call_while_the_interpreter_ends_is_refused(self):
        ended = subprocess.run([sys.executable, "-c", """
import excavplan as ex

class Last:
    machine, loam = ex.load_machine("zx120"), ex.load_soil("loam")

    def __del__(self, plan_dig=ex.plan_dig):
        plan_dig(self.machine, self.loam, 40)

last = Last()
"""], check=False, stderr=subprocess.PIPE, timeout=60, text=True)
        self.assertEqual(ended.returncode, 0)
        self.assertIn("RuntimeError: excavplan cannot be called while Python is ending",
                      ended.stderr)

    def test_a_wrong_type_is_a_type_error(self):
        points = [[0, 0, 0]]
        for wrong in (lambda: ex.estimate_density(points, points, soil=5),
                      lambda: ex.estimate_density(points, points, soil=[1]),
                      lambda: ex.estimate_density(3, points, soil="loam"),
                      lambda: ex.estimate_density(None, points),
                      lambda: ex.Scan(3), lambda: ex.Scan(["before.pcd", 3]), lambda: ex.Cloud(3),
                      lambda: ex.DigSearchOptions(start_rule=[1]),
                      lambda: ex.DigSearchOptions(checkpoint=3),
                      lambda: ex.evaluate_dig(MACHINE, ex.HeightMapSimulator(MACHINE, LOAM, 40),
                                              ex.level_planning_ground(MACHINE),
                                              ex.paper_fixed_path(), start={}),
                      lambda: ex.load_machine(3), lambda: ex.read_cloud(None)):
            with self.assertRaises(TypeError):
                wrong()

    def test_a_plan_of_another_machine_has_no_motion(self):
        plan = ex.plan_dig(MACHINE, LOAM, 40)
        with self.assertRaisesRegex(ex.Error, "of the machine 'zx120', not of 'zx200'"):
            ex.plan_motion(ex.load_machine("zx200"), plan)

    def test_the_messages_are_those_of_the_library(self):
        with self.assertRaises(ex.Error) as raised:
            ex.plan_dig(MACHINE, LOAM, 140)
        self.assertEqual(raised.exception.kind, "bad_input")
        self.assertIn("140", str(raised.exception))
        with self.assertRaises(ex.Error) as raised:
            ex.read_cloud("/no/such/file.pcd")
        self.assertEqual(raised.exception.kind, "bad_file")
        with self.assertRaises(ex.Error) as raised:
            ex.Cloud([[1, 2]])
        self.assertEqual(str(raised.exception),
                         "the points of a cloud: found the shape (1, 2), expected (N, 3)")

    def test_numbers(self):
        for density in (NAN, INF, -1, 101, 10 ** 400, "40", None, [40]):
            with self.assertRaises(REFUSED, msg=repr(density)):
                ex.plan_dig(MACHINE, LOAM, density)
        for sd in (NAN, INF, -1):
            with self.assertRaises(REFUSED):
                ex.plan_dig(MACHINE, LOAM, ex.GroundDensity(40, sd))
        with self.assertRaises(REFUSED):
            ex.flat_ground(ex.Rectangle(0, 0, 1e9, 1e9), 0.01)
        with self.assertRaises(REFUSED):
            ex.plan_dig(MACHINE, LOAM, 40, method="search",
                        search=ex.DigSearchOptions(threads=10 ** 6))
        for given in ({"threads": -1}, {"seed": -1}, {"evaluations": 10 ** 30},
                      {"method": "other"}, {"progress": 3}, {"start": [1]}, {"nonsense": 1}):
            with self.assertRaises(REFUSED, msg=repr(given)):
                ex.DigSearchOptions(**given)

    def test_grounds(self):
        nowhere = ex.HeightMap([[NAN] * 200] * 200)
        self.assertIsNone(ex.plan_dig(MACHINE, LOAM, 40, nowhere, method="search").dig)
        for heights in ([[INF] * 9] * 9, [[1e300] * 9] * 9, [[]], []):
            with self.assertRaises(REFUSED):
                plan = ex.plan_dig(MACHINE, LOAM, 40, ex.HeightMap(heights))
                raise ex.Error(plan.reason)
        with self.assertRaises(ex.Error):
            ex.Terrain(ex.HeightMap([[0.0, 0.0]]), [[1.0]])
        with self.assertRaises(REFUSED):
            ex.estimate_density([[0, 0, 0]], [[0, 0, 0]], soil="loam")
        with self.assertRaises(ex.Error):
            ex.measure_change(ex.HeightMap([[0.0]]), ex.HeightMap([[0.0, 1.0]]))

    def test_a_patch_off_the_ground(self):
        result = ex.DigResult()
        result.patch = ex.TerrainPatch(10 ** 9, -5, [[1.0]], [[1.0]])
        with self.assertRaises(ex.Error):
            result.after(ex.level_planning_ground(MACHINE))

    def test_anything_for_every_argument(self):
        odd = (None, -1, NAN, 10 ** 400, "x", "\ud800", b"\0", [], [[NAN]], Raising(), object(),
               lambda *given: 1 / 0)
        for name in ex.__all__:
            function = getattr(ex, name)
            for count, value in itertools.product(range(5), odd):
                try:
                    function(*[value] * count)
                except Exception:  # noqa: BLE001: any but the end of the process
                    pass


if __name__ == "__main__":
    unittest.main()
