# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Digs in a row on a site that remembers ground and density."""

import json
import math
import os
import random
import tempfile
import threading
import unittest

import excavplan as ex
from tools import result_of

MACHINE = ex.load_machine("zx120")
LOAM = ex.load_soil("loam")
TRUTH = 40  # of the density [%]


def numbers(table):
    return memoryview(table).tolist()


class Machinery:
    """A machine that digs what it is told, and is scanned."""

    def __init__(self):
        self.ground = ex.Terrain(ex.flat_ground(ex.scene_extent(MACHINE), 0.05))
        self.scans = 0

    def look(self):
        return ex.SiteEvent(self.scan(), dug=False, time=self.scans)

    def dig(self, planned):
        dig = planned.plan.dig
        self.ground = ex.simulate_dig(MACHINE, LOAM, TRUTH, self.ground, path=dig.parameters,
                                      start_x=dig.start_x).after

    def scan(self):
        """Four points in each cell, with errors of 3 mm."""
        self.scans += 1
        errors = random.Random(self.scans)
        surface = self.ground.surface()
        fine = surface.resampled(surface.extent, 0.025)
        xs, ys = numbers(fine.x), numbers(fine.y)
        return [[x, y, z + errors.gauss(0, 0.003)] for y, row in zip(ys, numbers(fine.z))
                for x, z in zip(xs, row) if not math.isnan(z)]


class Sites(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = os.path.join(self.folder.name, "pit")

    def tearDown(self):
        self.folder.cleanup()

    def site(self, access="write"):
        return ex.Site(self.path, MACHINE, LOAM, access=access)

    def test_digs_in_a_row(self):
        machine = Machinery()
        with self.site() as site:
            self.assertTrue(site.is_empty)
            self.assertIsNone(site.update(machine.look()).estimate)
            for number in (1, 2):
                planned = ex.plan_on_site(site, density=ex.GroundDensity(50, 25))
                machine.dig(planned)
                event = ex.SiteEvent(machine.scan(), time=machine.scans, plan=planned)
                looked = site.look(event)
                self.assertEqual(site.digs, number - 1)
                update = site.update(event)
                self.assertTrue(update.taken and update.trustworthy, update.warnings)
                self.assertEqual(update.density.percent, looked.density.percent)
                self.assertLess(abs(update.density.percent - TRUTH), 3 * update.density.sd_percent)
                self.assertEqual((update.digs, site.updates), (number, number + 1))
            self.check_views(site)
            site.undo()
            self.assertEqual(site.digs, 1)
        with self.assertRaisesRegex(ex.Error, "closed"):
            site.undo()
        told = result_of("estimate-density", "--site", self.path)
        self.assertEqual((told["site"]["updates"], told["site"]["digs"]), (2, 1))
        planned = ex.plan_on_site(self.site("read"))
        told = result_of("plan-path", "--site", self.path)
        self.assertEqual(planned.density.percent, told["density_percent"])
        self.assertEqual(planned.plan.dig.payload_mass, told["payload_mass_kg"])

    def check_views(self, site):
        ground = site.ground
        self.assertEqual(ground.soil, "loam")
        self.assertGreater(max(map(max, numbers(ground.terrain.loose))), 0.1)
        base = ex.BasePose()
        near = site.ground_for(base, ex.planning_extent(MACHINE))
        density = site.density_at(base, ex.Rectangle(4.5, -0.4, 6.5, 0.4), 0.5)
        self.assertLess(abs(density.percent - TRUTH), 4 * density.sd_percent)
        plan = ex.plan_dig(MACHINE, LOAM, density, near.terrain_to_dig(LOAM, density.percent))
        self.assertIsNotNone(plan.dig)
        belief = site.belief
        self.assertEqual(len(belief), site.digs)
        mean, sd = belief.map(ex.flat_ground(ex.Rectangle(5, -0.5, 30, 0.5), 0.5), 0.3)
        self.assertLess(numbers(sd)[0][0], numbers(sd)[0][-1])
        at, at_sd = belief.at([[5.25, -0.25, 0.3]])
        self.assertAlmostEqual(numbers(at)[0], numbers(mean)[0][0], 9)
        self.assertAlmostEqual(numbers(at_sd)[0], numbers(sd)[0][0], 9)
        self.assertEqual(len(json.loads(belief.to_json())["digs"]), site.digs)

    def test_the_machine_moves(self):
        machine = Machinery()
        base = ex.BasePose(30, -4, heading=math.pi / 2)
        self.assertEqual(numbers(base.site_from_machine)[1][3], -4.0)
        matrix = base.site_from_machine
        with self.site() as site:
            before = ex.Scan(machine.scan(), site_from_scan=matrix)
            site.update(ex.SiteEvent(before, dug=False, time=1))
            planned = ex.plan_on_site(site, base=base, density=50)
            machine.dig(planned)
            after = ex.Scan(machine.scan(), site_from_scan=matrix)
            update = site.update(ex.SiteEvent(after, time=2, base=base, plan=planned))
            self.assertTrue(update.trustworthy, update.warnings)
            self.assertGreater(site.ground.terrain.bank.extent.x_min, 20)

    def test_what_is_refused(self):
        with self.assertRaisesRegex(ex.Error, "holds no site"):
            self.site("read")
        with self.assertRaisesRegex(ex.Error, "none of read, write"):
            self.site("append")
        machine = Machinery()
        with self.site() as site:
            look = machine.look()
            site.update(look)
            with self.assertRaisesRegex(ex.Error, "in the site already"):
                site.update(look)
            with self.assertRaisesRegex(ex.Error, "in use by process"):
                self.site()
        with self.assertRaisesRegex(ex.Error, "of soil 'loam', not 'sand'"):
            ex.Site(self.path, MACHINE, ex.load_soil("sand"))
        with self.assertRaisesRegex(ex.Error, "dug_start needs dug_path"):
            ex.SiteEvent([[0, 0, 0]], dug_start=5.0)

    def test_threads_share_a_site(self):
        machine = Machinery()
        with self.site() as site:
            site.update(machine.look())
            seen = []
            threads = [threading.Thread(target=lambda: seen.append(site.ground.soil))
                       for _ in range(4)]
            for each in threads:
                each.start()
            for each in threads:
                each.join()
            self.assertEqual(seen, ["loam"] * 4)


if __name__ == "__main__":
    unittest.main()
