# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Jobs step by step, and whole ones on hidden ground."""

import math
import os
import tempfile
import unittest

import excavplan as ex
from plain_site import write_plain_site

ZX120, LOAM = ex.load_machine("zx120"), ex.load_soil("loam")
WINDROW = [(-1.0, 1.5), (7.0, 1.5), (7.0, 5.5), (-1.0, 5.5)]
CELL = 0.05  # of the true ground [m]
BEGIN = 1767225600.0


def numbers(table):
    return memoryview(table).tolist()


def level_points(shift=0.0):
    return [[shift - 8.0 + 0.1 * i, 0.1 * k - 7.0, 0.0] for i in range(180) for k in range(140)]


class Jobs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = os.path.join(folder.name, "job")
        self.site = write_plain_site(os.path.join(folder.name, "T01"), length=1.5, depth=0.25)
        self.settings = ex.JobSettings.of_site(self.site / "site.json")

    def truth(self):
        return ex.TrueSite(ex.read_hidden_site(self.site, cell_size=CELL), seed=1)

    def begun(self):
        return ex.SiteJob.begin(self.path, self.settings, time=BEGIN)

    def up_to_a_dig(self, job, truth):
        step = job.next()
        while step.what != "dig":
            job.done(step.id, truth.execute(step).report)
            step = job.next()
        return step

    def test_a_dig_has_path_motion_and_forecast(self):
        job = self.begun()
        step = self.up_to_a_dig(job, self.truth())
        self.assertEqual(len(numbers(step.path.joints)[0]), 3)
        motion = job.motion(step)
        self.assertTrue(motion)
        self.assertGreater(len(numbers(motion.joints)), 100)
        low, high = step.predicted.payload_interval
        self.assertTrue(0.0 < low < step.predicted.payload_mass < high)
        low, high = step.predicted.energy_interval
        self.assertTrue(0.0 < low < step.predicted.energy < high)
        self.assertRegex(repr(step), r"^<JobStep \d+: dig [\d.]+ kg \([\d.]+ \.\. [\d.]+\), [\d.]+ kJ .* s>$")
        frame = numbers(step.site_from_line)
        self.assertAlmostEqual(math.hypot(frame[0][0], frame[1][0]), 1.0)

    def test_what_is_not_asked_for_rightly_is_told(self):
        self.assertEqual(self.begun().design_warnings, [])
        shallow = write_plain_site(os.path.join(os.path.dirname(self.path), "T02"), length=1.5, depth=0.05)
        settings = ex.JobSettings.of_site(shallow / "site.json")
        job = ex.SiteJob.begin(os.path.join(os.path.dirname(self.path), "shallow"), settings, time=BEGIN)
        self.assertEqual([warning.code for warning in job.design_warnings], ["wide_tolerance"])

    def test_done_undo_and_resume(self):
        job, truth = self.begun(), self.truth()
        self.assertEqual(job.wall_warnings, [])
        step = self.up_to_a_dig(job, truth)
        events = len(job.history)
        job.done(step.id + 7, ex.StepReport(time=truth.time))
        self.assertEqual(len(job.history), events)
        done = truth.execute(step)
        job.done(step.id, done.report)
        history = job.history
        self.assertEqual(len(history), events + 1)
        self.assertAlmostEqual(history.events[-1].payload_mass, done.report.payload_mass)
        fell = min(b - a for a, b in zip(
            (z for row in numbers(history.ground(events).z) for z in row),
            (z for row in numbers(history.ground(events + 1).z) for z in row)) if b == b)
        self.assertLess(fell, -0.05)
        self.assertEqual(job.progress.digs, 1)
        after = job.next()
        del job
        resumed = ex.SiteJob.resume(self.path, self.settings)
        self.assertEqual(repr(resumed.next()), repr(after))
        resumed.undo()
        self.assertEqual(len(resumed.history), events)
        self.assertEqual(resumed.progress.digs, 0)

    def test_a_job_in_words_begins_with_an_array(self):
        trench = ex.design_trench("2x1x0.4", ex.flat_ground(ex.Rectangle(-8, -7, 10, 7)),
                                  start=(2.0, 0.0))
        design = ex.JobDesign(ex.BasePose(-0.2), windrows=[WINDROW], name="words")
        settings = ex.JobSettings(ZX120, LOAM, design, trench, density_percent=40)
        points = level_points()
        job = ex.SiteJob.begin(self.path, settings, points, BEGIN)
        self.assertAlmostEqual(job.progress.design_volume, 0.8, 1)
        self.assertEqual(repr(settings), "<JobSettings of words: zx120 in loam of 40 %>")
        self.assertEqual(job.next().what, "move")
        job.look(level_points(shift=0.03), BEGIN + 60.0)
        self.assertEqual(job.history.events[-1].what, "scan")
        heights = numbers(job.ground.surface().z)
        self.assertLess(max(abs(z) for row in heights for z in row if z == z), 0.01)

    def test_a_whole_job_is_scored(self):
        site = ex.read_hidden_site(self.site, cell_size=CELL)
        told = []
        trial = ex.play_job(site, self.begun(), progress=told.append)
        self.assertTrue(trial.stopped)
        self.assertEqual(told[0].step.what, "move")
        self.assertGreater(sum(step.done.payload_mass for step in told), 300.0)
        self.assertLess(trial.score.left_percent, 40.0)
        self.assertAlmostEqual(trial.solids.cut, trial.solids.lying + trial.solids.hauled, 6)
        self.assertIn(" kJ/m^3, ", repr(trial))

    def test_a_trial_ends_as_its_callback_says(self):
        site = ex.read_hidden_site(self.site, cell_size=CELL)
        with self.assertRaises(ZeroDivisionError):
            ex.play_job(site, "operator", progress=lambda step: 1 / 0)
        with self.assertRaisesRegex(ex.Error, "ended by its progress"):
            ex.play_job(site, "operator", progress=lambda step: False)

    def test_errors_are_those_of_the_library(self):
        self.begun()
        with self.assertRaises(ex.Error) as told:
            self.begun()
        self.assertEqual(told.exception.kind, "bad_input")
        with self.assertRaises(ex.Error) as told:
            ex.SiteJob.resume(self.path + "-none", self.settings)
        self.assertEqual(told.exception.kind, "bad_file")
        with self.assertRaisesRegex(ex.Error, "none of operator, "):
            ex.play_job(ex.read_hidden_site(self.site, cell_size=CELL), "mole")
        with self.assertRaises(TypeError):
            ex.play_job(ex.read_hidden_site(self.site, cell_size=CELL), 7)
        with self.assertRaises(ex.Error):
            ex.JobDesign(ex.BasePose())  # soil has no place to go
        with self.assertRaises(ex.Error):
            ex.SiteJob.resume(self.path, self.settings).undo()


if __name__ == "__main__":
    unittest.main()
