# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""What a job takes, as plan-site estimates it."""

import json
import math
import unittest

import excavplan as ex
from tools import is_part_of, result_of


class JobEstimates(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.machine, cls.loam = ex.load_machine("zx120"), ex.load_soil("loam")
        cls.plain = ex.estimate_job(cls.machine, cls.loam, "15x1x0.5")

    def estimate(self, design="15x1x0.5", ground=None, **options):
        return ex.estimate_job(self.machine, self.loam, design, ground, **options)

    def test_it_is_that_of_the_tool(self):
        told = result_of("plan-site", "estimate", "--trench", "15x1x0.5", "--density", 40,
                         "--fuel-price", 1.6, "--hour-price", 90, "--truckload-price", 75)
        own = self.estimate(density=ex.GroundDensity(40, 10), fuel_price=1.6, hour_price=90,
                            truckload_price=75)
        is_part_of(self, own.to_json(), told)

    def test_a_cost_is_the_sum_of_its_parts(self):
        self.assertIsNone(self.plain.cost)
        of = self.estimate(fuel_price=2.0, hour_price=60.0, truckload_price=100.0)
        parts = json.loads(of.to_json())["cost_parts"]
        self.assertAlmostEqual(parts["fuel"], 2.0 * of.fuel.value)
        self.assertAlmostEqual(parts["machine"], of.time.value / 60.0)
        self.assertAlmostEqual(parts["truckloads"], 100.0 * math.ceil(of.truckloads.value))
        self.assertAlmostEqual(of.cost.value, sum(parts.values()))

    def test_a_cost_is_as_uncertain_as_what_it_is_of(self):
        fuel = self.estimate(fuel_price=3.0)
        self.assertAlmostEqual(fuel.cost.interval[1] / fuel.cost.value,
                               fuel.fuel.interval[1] / fuel.fuel.value)
        both = self.estimate(fuel_price=3.0, truckload_price=50.0)
        self.assertLess(both.cost.interval[1] / both.cost.value,
                        fuel.cost.interval[1] / fuel.cost.value)

    def test_a_design_is_cut_into_the_ground(self):
        level = ex.flat_ground(ex.Rectangle(-2, -5, 22, 5))
        trench = ex.design_trench("15x1x0.5", level, start=(2, 0))
        cut = self.estimate(trench, level)
        self.assertAlmostEqual(cut.swollen.value, self.plain.swollen.value, delta=0.1)
        with self.assertRaisesRegex(ex.Error, "ground is missing"):
            self.estimate(trench)

    def test_what_is_wrong_is_named(self):
        for options, text in (({"fuel_price": -1.0}, "price of fuel"),
                              ({"design": "15x1"}, "size of a trench"),
                              ({"truck_mass": 0.0}, "truck_mass")):
            with self.assertRaisesRegex(ex.Error, text):
                self.estimate(**options)


if __name__ == "__main__":
    unittest.main()
