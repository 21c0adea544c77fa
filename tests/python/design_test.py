# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Designs from files and words against the ground."""

import os
import tempfile
import unittest

import excavplan as ex

SQUARE = "v 1 1 -0.5\nv 3 1 -0.5\nv 3 3 -0.5\nv 1 3 -0.5\nf 1 2 3 4\n"
GROUND = ex.flat_ground(ex.Rectangle(0.0, 0.0, 10.0, 5.0), 0.1)


def written(content, ending=".obj"):
    handle, path = tempfile.mkstemp(suffix=ending)
    with os.fdopen(handle, "w") as file:
        file.write(content)
    return path


class Designs(unittest.TestCase):
    def test_a_file_is_cut(self):
        path = written(SQUARE)
        try:
            design = ex.read_design(path)
            feet = ex.read_design(path, unit=0.3048)
        finally:
            os.remove(path)
        volumes = ex.cut_and_fill(design, GROUND, height_sd=0.01)
        self.assertAlmostEqual(volumes.cut.value, 2.0, 9)
        self.assertAlmostEqual(volumes.cut.sd, 0.04, 9)
        self.assertEqual(design.unit_told_by, "nothing: metres taken")
        self.assertAlmostEqual(feet.area, 4.0 * 0.3048**2, 12)
        self.assertAlmostEqual(ex.cut_and_fill(design, GROUND).deviation.rms, 0.5, 9)

    def test_words_are_cut(self):
        trench = ex.design_trench("6x1x0.5", GROUND, start=(1.0, 2.5))
        self.assertAlmostEqual(ex.cut_and_fill(trench, GROUND).cut.value, 3.0, 9)

    def test_errors_name_the_place(self):
        path = written(SQUARE.replace("f 1 2 3 4", "f 1 2 9"))
        try:
            with self.assertRaisesRegex(ex.Error, "line 5: found the vertex '9' of 4"):
                ex.read_design(path)
        finally:
            os.remove(path)


if __name__ == "__main__":
    unittest.main()
