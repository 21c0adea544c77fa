# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Machine, paths, simulated digs, plans and libraries: the same numbers as the tools."""

import json
import math
import os
import pathlib
import tempfile
import unittest

import excavplan as ex
from tools import is_part_of, result_of

MACHINE = ex.load_machine("zx120")
LOAM = ex.load_soil("loam")


class Machines(unittest.TestCase):
    def test_kinematics_are_inverse(self):
        joints = (-0.4, 1.8, 0.6)
        found = MACHINE.inverse_kinematics(MACHINE.forward_kinematics(joints))
        for one, other in zip(found, joints):
            self.assertAlmostEqual(one, other, 9)
        self.assertIsNone(MACHINE.inverse_kinematics(ex.BucketPose(30.0, 0.0, 0.0)))

    def test_the_swing_and_the_root_of_a_machine(self):
        swing = ex.load_machine("zx200").swing
        self.assertEqual(swing.acceleration, 0.35)
        self.assertTrue(swing.turns_round())
        data = os.environ.get("EXCAVPLAN_DATA", pathlib.Path(__file__).parents[2] / "data")
        file = json.loads((pathlib.Path(data) / "machines" / "zx120.json").read_text())
        file["robot_root"] = {"position_m": [0.5, -1.0, 0.25], "yaw_rad": math.pi / 2}
        file["swing"].update({"lower_rad": -1.0, "upper_rad": 2.0})
        with tempfile.NamedTemporaryFile("w", suffix=".json") as stream:
            stream.write(json.dumps(file))
            stream.flush()
            machine = ex.load_machine(stream.name)
        self.assertEqual((machine.swing.lower, machine.swing.upper), (-1.0, 2.0))
        self.assertFalse(machine.swing.turns_round())
        self.assertEqual([row[3] for row in machine.site_from_root.tolist()], [0.5, -1.0, 0.25, 1])
        self.assertAlmostEqual(machine.site_from_root.tolist()[1][0], 1.0)

    def test_a_path_and_its_trajectory(self):
        path = ex.make_dig_path(MACHINE, ex.paper_fixed_path())
        self.assertEqual(path.joints.shape, (len(path), 3))
        self.assertEqual(path.phase[0], "penetrate")
        trajectory = ex.time_dig_path(MACHINE, path)
        self.assertEqual(trajectory.joints.shape, (len(trajectory), 3))
        self.assertEqual(trajectory.duration, trajectory.time.tolist()[-1])
        slow = ex.time_dig_path(MACHINE, path, speed_fraction=0.4)
        self.assertGreater(slow.duration, trajectory.duration)

    def test_why_a_path_cannot_be_driven(self):
        why = ex.make_dig_path(MACHINE, ex.paper_fixed_path(), 20.0)
        self.assertFalse(why)
        self.assertIn("must be at most", why.message)
        self.assertEqual(why.phase, "penetrate")

    def test_a_trajectory_is_read_back(self):
        path = ex.make_dig_path(MACHINE, ex.paper_fixed_path())
        trajectory = ex.time_dig_path(MACHINE, path)
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            file.write(trajectory.to_json())
            file.flush()
            self.assertEqual(ex.load_trajectory(file.name).to_csv(), trajectory.to_csv())


class Motions(unittest.TestCase):
    def test_an_earlier_scan_of_the_surroundings(self):
        places = [0.1 * i - 9.8 for i in range(197)]
        around = ex.Cloud([(x, y, 0.0) for x in places for y in places])
        strip = ex.Cloud([(x, y, 0.0) for x in places for y in places if abs(y) < 1.5])
        plan = ex.plan_dig(MACHINE, LOAM, 40)
        present, earlier = (ex.swing_terrain_from_scan(cloud, MACHINE).terrain
                            for cloud in (strip, around))
        unseen = ex.plan_motion(MACHINE, plan, present, whole_cycle=True)
        self.assertEqual([each.code for each in unseen.warnings], ["unseen_way"])
        both = ex.with_surroundings(present, earlier)
        self.assertEqual(both.warnings, [])
        self.assertEqual(ex.plan_motion(MACHINE, plan, both.terrain, whole_cycle=True).warnings, [])

    def test_the_attitude_is_that_of_the_tool(self):
        told = result_of("plan-path", "--density", 40, "--attitude=0.06,-0.03")
        plan = ex.plan_dig(MACHINE, LOAM, 40, attitude=(0.06, -0.03))
        self.assertEqual(plan.dig.energy / 1e3, told["energy_kj"])
        self.assertEqual(list(plan.attitude), [0.06, -0.03])
        self.assertNotEqual(plan.dig.energy, ex.plan_dig(MACHINE, LOAM, 40).dig.energy)
        self.assertEqual(plan.trustworthy, told["trustworthy"])
        with self.assertRaises(ex.Error):
            ex.plan_dig(MACHINE, LOAM, 40, attitude=(3.0, 0.0))

    def test_the_ground_that_the_machine_stands_on(self):
        places = [0.1 * i - 9.8 for i in range(197)]
        for height, code in ((0.0, None), (-0.5, "ground_below_tracks")):
            around = ex.Cloud([(x, y, height) for x in places for y in places])
            standing = ex.standing_ground_from_scan(around, MACHINE)
            plan = ex.plan_dig(MACHINE, LOAM, 40, standing_on=standing)
            self.assertEqual(plan.trustworthy, code is None)
            self.assertEqual([each.code for each in plan.warnings], [code] if code else [])

    def test_a_motion_is_that_of_the_tool(self):
        joints = "-0.6,1.6,0.5,0.7"
        with tempfile.TemporaryDirectory() as folder:
            told = result_of("plan-path", "--density", 40, "--joints=" + joints, "--whole-cycle",
                             "--rate", 50, "--trajectory", os.path.join(folder, "dig.yaml"))
        plan = ex.plan_dig(MACHINE, LOAM, 40)
        start = [float(joint) for joint in joints.split(",")]
        motion = ex.plan_motion(MACHINE, plan, start=start, whole_cycle=True, rate=50)
        self.assertEqual(motion.duration, told["trajectory"]["duration_s"])
        self.assertEqual(len(motion), told["trajectory"]["points"])
        self.assertEqual(motion.phase[-1], "back")
        self.assertEqual(motion.swing.shape, (len(motion), 3))
        sent = ex.joint_motion(motion)
        self.assertEqual(", ".join(sent.names), told["trajectory"]["joint_names"])
        self.assertEqual(sent.accelerations.shape, (len(motion), 4))
        for one, other in zip(sent.positions.tolist()[0], start):
            self.assertAlmostEqual(one, other, 12)
        self.assertIn("time_from_start: {sec: 0, nanosec: 20000000}", motion.to_joint_trajectory())
        self.assertEqual(motion.to_joint_commands().count("control_type: 0"), len(motion))

    def test_the_ground_in_the_way_is_told(self):
        plan = ex.plan_dig(MACHINE, LOAM, 40)
        low = (0.4, 0.6, 0.2, 0.0)  # the tip below the ground
        blocked = ex.plan_motion(MACHINE, plan, start=low)
        self.assertFalse(blocked)
        self.assertEqual(blocked.phase, "approach")
        self.assertLess(blocked.clearance, 0.0)
        self.assertIn("approach", repr(blocked))

    def test_a_joint_beyond_its_limits_is_refused(self):
        plan = ex.plan_dig(MACHINE, LOAM, 40)
        with self.assertRaisesRegex(ex.Error, "boom"):
            ex.plan_motion(MACHINE, plan, start=(3.0, 1.6, 0.5, 0.0))


class Digs(unittest.TestCase):
    def test_simulate_dig_is_that_of_the_tool(self):
        told = result_of("simulate-dig", "--density", 40)
        scene = ex.simulate_dig(MACHINE, LOAM, 40)
        is_part_of(self, scene.to_json(MACHINE), told)
        dig = scene.dig
        self.assertEqual(dig.payload_mass, told["payload_mass_kg"])
        self.assertEqual(dig.energy.total / 1000.0, told["energy_kj"])
        self.assertEqual(scene.duration, told["duration_s"])
        self.assertEqual(scene.volumes.bulking_factor, told["bulking_factor"])
        self.assertEqual(scene.bulking_factor_true, told["bulking_factor_true"])
        self.assertEqual(dig.soil.solids_after, told["solids_after_kg"])
        self.assertEqual(dig.peak_force / 1000.0, told["peak_force_kn"])
        self.assertEqual(scene.path.start_x, told["path"]["start_x_m"])

    def test_the_history_has_a_row_for_each_step(self):
        history = ex.simulate_dig(MACHINE, LOAM, 40).dig.history
        self.assertEqual(history.torque.shape, (len(history), 3))
        self.assertEqual(history.soil.shape, (len(history), 2))
        self.assertEqual(len(history.phase), len(history))
        self.assertEqual(len(history.bucket_fill.tolist()), len(history))

    def test_the_ground_after_a_dig(self):
        ground = ex.Terrain(ex.level_planning_ground(MACHINE).surface())
        path = ex.make_dig_path(MACHINE, ex.paper_fixed_path())
        simulator = ex.HeightMapSimulator(MACHINE, LOAM, 40)
        result = simulator.dig(ground, path)
        self.assertEqual(len(result.history), 0)
        after = result.after(ground).surface()
        self.assertLess(min(map(min, after.z.tolist())), -0.1)
        self.assertEqual(len(simulator.dig(ground, path, ex.DigOptions(history=True)).history) > 10,
                         True)


class Plans(unittest.TestCase):
    def compare(self, plan, told):
        dig = plan.dig
        self.assertEqual(dig.payload_mass, told["payload_mass_kg"])
        self.assertEqual(dig.energy / 1000.0, told["energy_kj"])
        self.assertEqual(dig.parameters.drag_length, told["path"]["drag_length_m"])
        self.assertEqual(dig.start_x, told["path"]["start_x_m"])
        self.assertEqual(dig.cycle_time, told["cycle"]["time_s"])
        self.assertEqual(plan.trustworthy, told["trustworthy"])
        self.assertEqual([each.code for each in plan.warnings],
                         [each["code"] for each in told["warnings"]])

    def test_look_up(self):
        told = result_of("plan-path", "--density", 43)
        plan = ex.plan_dig(MACHINE, LOAM, 43)
        self.compare(plan, told)
        is_part_of(self, plan.to_json(43), told)
        self.assertEqual(plan.look_up.error.loss, told["look_up_loss"])
        self.assertGreater(len(plan.trajectory), 10)

    def test_search_with_an_uncertain_density(self):
        told = result_of("plan-path", "--density", 40, "--density-sd", 8, "--search",
                         "--evaluations", 40, "--goal", "energy", "--seed", 3)
        plan = ex.plan_dig(MACHINE, LOAM, ex.GroundDensity(40, 8), method="search",
                           search=ex.DigSearchOptions(evaluations=40, seed=3,
                                                      objective=ex.DigObjective("energy")))
        self.compare(plan, told)
        is_part_of(self, plan.to_json(ex.GroundDensity(40, 8), ex.DigObjective("energy")), told)
        self.assertEqual(100.0 * plan.search.value_of_knowing, told["value_of_knowing_percent"])
        self.assertEqual(plan.spread.energy / 1000.0, told["energy_sd_kj"])
        self.assertEqual(plan.evaluations, told["evaluations"])

    def test_search_on_scanned_ground(self):
        scan = ex.data_file("quickstart/before.pcd")
        told = result_of("plan-path", "--density", 40, "--search", "--terrain", scan,
                         "--evaluations", 60)
        ground = ex.terrain_from_scan(scan, ex.planning_extent(MACHINE))
        plan = ex.plan_dig(MACHINE, LOAM, 40, ground.terrain, method="search",
                           search=ex.DigSearchOptions(evaluations=60))
        warnings = [each.code for each in ground.warnings] + [each.code for each in plan.warnings]
        # The tool looks at all that the scan shows at the tracks, plan_dig() at the terrain to dig on.
        of_tool = [each["code"] for each in told["warnings"]]
        self.assertEqual(warnings, [code for code in of_tool if code != "ground_at_tracks_unseen"])
        self.assertEqual(plan.dig.payload_mass, told["payload_mass_kg"])
        self.assertEqual(plan.dig.energy / 1000.0, told["energy_kj"])

    def test_progress_stops_a_search(self):
        seen = []
        plan = ex.plan_dig(MACHINE, LOAM, 40, method="search", search=ex.DigSearchOptions(
            progress=lambda state: seen.append(state.evaluations) or len(seen) < 5))
        self.assertTrue(plan.stopped)
        self.assertEqual(len(seen), 5)

    def test_search_and_evaluation_of_one_soil(self):
        simulator = ex.HeightMapSimulator(MACHINE, LOAM, 40)
        ground = ex.level_planning_ground(MACHINE)
        found = ex.search_dig(MACHINE, simulator, ground, ex.DigSearchOptions(
            evaluations=40, objective=ex.DigObjective("energy")))
        again = ex.evaluate_dig(MACHINE, simulator, ground, found.dig.parameters, found.dig.start_x)
        self.assertEqual(again.payload_mass, found.dig.payload_mass)
        self.assertEqual(found.worth, again.efficiency)
        self.assertEqual(len(found.ranks.tolist()), found.evaluations)
        self.assertFalse(ex.evaluate_dig(MACHINE, simulator, ground, ex.DigParameters(3.0, 1, 1)))

    def test_possible_densities(self):
        nodes = ex.possible_densities(40, 8)
        self.assertAlmostEqual(sum(each.probability for each in nodes), 1.0, 12)
        self.assertAlmostEqual(sum(each.probability * each.percent for each in nodes), 40.0, 3)


class Libraries(unittest.TestCase):
    def test_look_up(self):
        library = ex.shipped_library(MACHINE, LOAM)
        same = ex.load_path_library("zx120-loam-cycle")
        self.assertEqual(library.to_json(), same.to_json())
        dig = library.look_up(43)
        self.assertEqual(dig.payload_mass, ex.plan_dig(MACHINE, LOAM, 43, library=same)
                         .dig.payload_mass)
        self.assertGreaterEqual(library.look_up_error(43).loss, 0.0)

    def test_a_build_that_is_stopped_gives_none(self):
        self.assertIsNone(ex.build_path_library(MACHINE, LOAM, [40, 60],
                                                progress=lambda state: False))


class Laws(unittest.TestCase):
    def test_calibration_is_that_of_the_tool(self):
        told = result_of("calibrate-density", "--densities", "0:25:100", "--draws", 4,
                         "--cell", 0.1)
        law = ex.calibrate_density(MACHINE, LOAM, densities_percent=[0, 25, 50, 75, 100], draws=4,
                                   cell_size=0.1)
        mine = json.loads(law.to_json())
        self.assertEqual(mine["closed_form_as_measured"], told["closed_form_as_measured"])
        self.assertEqual(law.density_percent.tolist(), [0, 25, 50, 75, 100])

    def test_a_law_and_its_inverse(self):
        law = ex.load_density_law("zx120-loam")
        density = law.relative_density(1.2, 0.01)
        self.assertAlmostEqual(law.bulking_of_density(density.percent), 1.2, 9)
        self.assertGreater(density.sd_percent, density.sd_given_law_percent)

    def test_a_law_of_samples(self):
        true = ex.density_law_of(LOAM)
        densities = [0, 20, 40, 60, 80, 100]
        fitted = ex.fit_density_law([true.bulking_of_density(d) for d in densities], densities).law
        self.assertTrue(math.isclose(fitted.density_of_bulking(1.2), true.density_of_bulking(1.2),
                                     abs_tol=0.01))

    def test_a_soil_can_be_changed(self):
        wet = LOAM.copy()
        wet.water_content = 1.1 * LOAM.water_content
        self.assertNotEqual(wet.fingerprint(), LOAM.fingerprint())
        self.assertGreater(wet.bank_state(50).bulk_density, LOAM.bank_state(50).bulk_density)


if __name__ == "__main__":
    unittest.main()
