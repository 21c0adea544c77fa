# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Clouds, height maps and the density estimate: the same numbers as estimate-density."""

import math
import os
import pathlib
import tempfile
import unittest

import excavplan as ex
from tools import is_part_of, result_of

BEFORE = ex.data_file("quickstart/before.pcd")
AFTER = ex.data_file("quickstart/after.pcd")


def stated(value):
    """JSON has no NaN."""
    return None if math.isnan(value) else value


class Estimates(unittest.TestCase):
    def compare(self, estimate, told):
        volume = told["volume"]
        for name in ("excavated", "spilled", "dumped", "before", "after"):
            found = getattr(estimate.change, name)
            self.assertEqual(found.value, volume[f"{name}_m3"], name)
            self.assertEqual(stated(found.sd), volume[f"{name}_sd_m3"], name)
        self.assertEqual(estimate.bulking.value, told["bulking_factor"])
        self.assertEqual(stated(estimate.bulking.sd), told["bulking_factor_sd"])
        interval = estimate.change.bulking_interval()
        self.assertEqual(interval and list(interval), told["bulking_factor_interval"])
        self.assertEqual(estimate.density.percent, told["density_percent"])
        self.assertEqual(estimate.density.raw_percent, told["density_raw_percent"])
        self.assertEqual(stated(estimate.density.sd_percent), told["density_sd_percent"])
        self.assertEqual(list(estimate.density.interval_percent), told["density_interval_percent"])
        self.assertEqual(estimate.trustworthy, told["trustworthy"])
        self.assertEqual(estimate.law.name, told["law"])
        self.assertEqual([each.code for each in estimate.warnings],
                         [each["code"] for each in told["warnings"]])

    def test_files(self):
        estimate = ex.estimate_density(pathlib.Path(BEFORE), AFTER)
        told = result_of("estimate-density", BEFORE, AFTER)
        self.compare(estimate, told)
        is_part_of(self, estimate.to_json(), told)
        self.assertEqual(estimate.warnings[-1].code, "soil_assumed")
        self.assertEqual(estimate.change.areas[0].difference.z.shape,
                         estimate.change.areas[0].zone.shape)

    def test_points_and_clouds_are_as_good_as_files(self):
        before, after = ex.read_cloud(BEFORE), ex.read_cloud(AFTER)
        told = result_of("estimate-density", BEFORE, AFTER, "--soil", "loam")
        self.compare(ex.estimate_density(before, after, soil="loam"), told)
        scan = ex.Scan(before.points, sensor_origin=before.sensor_origin)
        self.compare(ex.estimate_density(scan, ex.Scan([after]), soil="loam"), told)

    def test_a_summary_is_that_of_the_tool(self):
        is_part_of(self, ex.summarise(ex.read_cloud(BEFORE)).to_json(),
                   result_of("inspect-cloud", BEFORE))

    def test_any_soil_and_payload(self):
        told = result_of("estimate-density", BEFORE, AFTER, "--soil", "unknown",
                         "--payload-mass", "480")
        estimate = ex.estimate_density(BEFORE, AFTER, soil="unknown",
                                       payload_mass=ex.Measured(480.0, 4.8))
        self.assertEqual([each.name for each in estimate.soils],
                         [each["name"] for each in told["soils"]])
        self.assertEqual(estimate.payload.mass.value, told["payload"]["mass_kg"])

    def test_the_papers_method(self):
        try:
            estimate = ex.estimate_density(BEFORE, AFTER, soil="loam", method="paper",
                                           law=ex.load_density_law("zx120-loam"))
        except ex.Error as error:
            if "libpcl-dev" in str(error):
                self.skipTest("built without PCL")
            raise
        told = result_of("estimate-density", BEFORE, AFTER, "--soil", "loam", "--law", "zx120-loam",
                         "--method", "paper")
        self.compare(estimate, told)

    def test_the_dug_path(self):
        told = result_of("estimate-density", BEFORE, AFTER, "--soil", "loam",
                         "--dug-path", "45deg,0.35m,1.5m", "--dug-start", "6.05")
        estimate = ex.estimate_density(
            BEFORE, AFTER, soil="loam", dug_start=6.05,
            dug_path=ex.DigParameters(math.radians(45), 0.35, 1.5))
        self.compare(estimate, told)
        self.assertEqual(estimate.fallback.fraction.value, told["fallback"]["fraction"])
        self.assertEqual(estimate.corrected.value, told["bulking_factor_corrected"])

    def test_the_density_goes_into_a_plan(self):
        density = ex.estimate_density(BEFORE, AFTER, soil="loam").ground_density()
        self.assertEqual(density.soil, "loam")
        plan = ex.plan_dig(ex.load_machine("zx120"), ex.load_soil("loam"), density)
        self.assertGreater(plan.dig.payload_mass, 100.0)
        self.assertGreater(plan.spread.energy, 0.0)

    def test_the_next_dig_has_a_prior(self):
        first = ex.estimate_density(BEFORE, AFTER, soil="loam")
        next_one = ex.estimate_density(BEFORE, AFTER, soil="loam",
                                       prior=ex.PriorDensity(first.density, 3.0))
        self.assertLess(next_one.density.sd_percent, first.density.sd_percent)
        self.assertEqual(next_one.successive.prior.drift_sd_percent, 3.0)

    def test_height_maps(self):
        scene = ex.simulate_dig(ex.load_machine("zx120"), ex.load_soil("loam"), 40)
        change = ex.measure_change(scene.before.surface(), scene.after.surface())
        self.assertAlmostEqual(change.bulking_factor().value, scene.volumes.bulking_factor, 2)
        self.assertEqual({zone.kind for zone in change.zones} & {"dig", "dump"}, {"dig", "dump"})


class Clouds(unittest.TestCase):
    def test_written_and_read_back(self):
        cloud = ex.Cloud([[1.5, -2.0, 0.25], [float("nan")] * 3, [3, 4, 5]], sensor_origin=(1, 2, 3))
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "a.pcd")
            ex.write_cloud(file, cloud)
            again = ex.read_cloud(file)
        self.assertEqual(again.points[2].tolist() if hasattr(again.points, "dtype")
                         else again.points.tolist()[2], [3.0, 4.0, 5.0])
        self.assertEqual(again.sensor_origin, (1.0, 2.0, 3.0))
        self.assertEqual(ex.summarise(again).finite_points, 2)

    def test_files_are_named_as_for_open(self):
        for name in (BEFORE, os.fsencode(BEFORE), pathlib.Path(BEFORE)):
            self.assertGreater(len(ex.read_cloud(name)), 1000)
            self.assertEqual(ex.Scan(name).files, [BEFORE])
        for several in ([BEFORE, AFTER], (os.fsencode(BEFORE), pathlib.Path(AFTER))):
            self.assertEqual(ex.Scan(several).files, [BEFORE, AFTER])
        soil = pathlib.Path(ex.data_file("soils/loam.json"))
        self.assertEqual(ex.load_soil(soil).fingerprint(), ex.load_soil("loam").fingerprint())
        for load, name in ((ex.load_machine, "machines/zx120.json"),
                           (ex.load_density_law, "laws/zx120-loam.json"),
                           (ex.load_path_library, "libraries/zx120-loam-cycle.json")):
            file = ex.data_file(name)
            for same in (file, os.fsencode(file), pathlib.Path(file)):
                load(same)
        self.assertEqual(ex.load_path_library(pathlib.Path(file)).file, file)
        estimate = ex.estimate_density(BEFORE, AFTER, soil=soil)
        self.assertEqual(estimate.density.percent,
                         ex.estimate_density(BEFORE, AFTER, soil="loam").density.percent)

    def test_names_that_are_no_text(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(os.fsencode(folder), b"\xff.xyz")
            ex.write_cloud(file, ex.Cloud([[1, 2, 3]]))
            self.assertEqual(len(ex.read_cloud(os.fsdecode(file))), 1)
            self.assertEqual(ex.Scan(file).files, [os.fsdecode(file)])
            os.remove(file)
            with self.assertRaisesRegex(ex.Error, r"\?.xyz"):
                ex.read_cloud(file)
            ex.write_cloud(file, ex.read_cloud(BEFORE))
            ground = ex.terrain_from_scan(file, ex.Rectangle(0, -6, 20, 6))
            self.assertIn("\\xff.xyz", ground.warnings[0].message)
            self.assertIn("\\xff.xyz", repr(ground.warnings[0]))
        with self.assertRaisesRegex(ValueError, "null byte"):
            ex.read_cloud("a\0b")

    def test_rasterised(self):
        cloud = ex.read_cloud(BEFORE)
        heights = ex.rasterise(cloud, cell_size=0.1)
        self.assertEqual(heights.cell_size, 0.1)
        extent = ex.summarise(cloud).extent
        self.assertGreaterEqual(heights.extent.x_max, extent.x_max)
        known = [z for row in heights.z.tolist() for z in row if not math.isnan(z)]
        self.assertLess(max(map(abs, known)), 0.5)

    def test_moved(self):
        up = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 2], [0, 0, 0, 1]]
        self.assertEqual(ex.Cloud([[1, 2, 3]]).transformed(up).points.tolist(), [[1, 2, 5]])


if __name__ == "__main__":
    unittest.main()
