# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Every public class shows itself: values with units in its repr(), a table and a picture in a notebook,
numbers for NumPy, JSON and a page where it is a result."""

import inspect
import json
import pathlib
import tempfile
import unittest

import excavplan as ex

try:
    import numpy
except ImportError:
    numpy = None

LAW = ex.fit_density_law([1.1, 1.15, 1.2, 1.3], [10, 25, 40, 60])

CLASSES = [kind for kind in (getattr(ex, name) for name in ex.__all__)
           if inspect.isclass(kind) and not issubclass(kind, Exception)]


def reached(thing, found):
    """All objects of the package that an object leads to by its properties, by their class."""
    kind = type(thing)
    if kind in found or kind not in CLASSES:
        return found
    found[kind] = thing
    for name, member in inspect.getmembers(kind):
        if isinstance(member, property):
            value = getattr(thing, name)
            for each in value if isinstance(value, (list, tuple)) else [value]:
                reached(each, found)
    return found


class Shown(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.machine, cls.loam = ex.load_machine("zx120"), ex.load_soil("loam")
        cls.estimate = ex.estimate_density(ex.data_file("quickstart/before.pcd"),
                                           ex.data_file("quickstart/after.pcd"), soil=cls.loam)
        cls.plan = ex.plan_dig(cls.machine, cls.loam, cls.estimate.ground_density())
        cls.scene = ex.simulate_dig(cls.machine, cls.loam, 40.0)
        cls.job = ex.estimate_job(cls.machine, cls.loam, "15x1x0.5", fuel_price=1.6)

    def test_no_class_prints_where_it_lies_in_memory(self):
        self.assertGreater(len(CLASSES), 90)
        for kind in CLASSES:
            self.assertIsNot(kind.__repr__, object.__repr__, kind.__name__)
            self.assertTrue(hasattr(kind, "_repr_html_") or hasattr(kind, "_repr_svg_"), kind)

    def test_objects_say_their_values(self):
        ground = ex.flat_ground(ex.Rectangle(-8, -7, 10, 7))
        options = ex.DigSearchOptions(evaluations=12)
        found = {}
        for thing in (self.estimate, self.plan, self.scene, self.job, ex.Terrain(ground), options,
                      ex.GroundState(ex.Terrain(ground)), LAW,
                      ex.design_trench("4x1x0.4", ground, start=(2, 0)), ex.Stall("drag", 0.4),
                      ex.read_cloud(ex.data_file("quickstart/after.pcd")), ex.DigOptions(),
                      ex.load_path_library("zx120-loam-cycle"), ex.JobDesign(ex.BasePose(0, 0), heaps=[[(0, 3), (2, 3), (2, 5)]]),
                      ex.HeightMapSimulator(self.machine, self.loam, 40.0), ex.SoilSimulator()):
            reached(thing, found)
        self.assertGreater(len(found), 45)
        for kind, thing in found.items():
            text = repr(thing)
            self.assertNotIn(" at 0x", text, kind)
            self.assertLess(len(text), 1200, kind)
            page = thing._repr_html_()
            self.assertNotIn(" at 0x", page, kind)
            self.assertGreater(len(page), 20, kind)
        self.assertIn("evaluations 12", repr(options))

    def test_values_have_units(self):
        self.assertRegex(repr(self.plan.dig), r"payload_mass [\d.]+ kg, energy [\d.]+ kJ")
        self.assertRegex(repr(self.plan.spread), r"payload_mass [\d.]+ kg, energy [\d.]+ kJ")
        self.assertRegex(repr(self.scene.dig.energy), r"total [\d.]+ kJ")
        self.assertRegex(repr(self.estimate.change), r"excavated 0.2681 \+- 0.0020 m\^3")
        self.assertRegex(repr(self.job), r"fuel [\d.]+ L \([\d.]+ \.\. [\d.]+\)")

    def test_a_class_of_its_own_shows_itself_too(self):
        class Own(ex.SoilSimulator):
            pass

        self.assertEqual(repr(Own()), "<Own>")

    def test_texts_are_no_markup(self):
        soil = self.loam.copy()
        soil.name = "<script>alert(1)</script>"
        self.assertNotIn("<script>", soil._repr_html_())

    def test_what_has_a_picture_draws_it(self):
        heights = ex.flat_ground(ex.Rectangle(0, 0, 30, 2), 0.05)
        for thing in (self.estimate, self.plan, self.scene, self.job, self.machine, heights,
                      ex.Terrain(heights), ex.GroundState(ex.Terrain(heights)), LAW):
            picture = thing.plot()
            self.assertIn("<svg", picture.svg, type(thing))
            self.assertEqual(picture._repr_svg_(), picture.svg)
            self.assertIn('src="data:image/svg+xml;base64,', thing._repr_html_())
        drawn = {self.scene.plot(what).svg for what in ("section", "forces", "torques", "power")}
        self.assertEqual(len(drawn), 4)
        with self.assertRaisesRegex(ex.Error, "the plot: 'sectoin' is none of section"):
            self.scene.plot("sectoin")

    def test_pictures_and_pages_are_files_too(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            picture = self.estimate.plot("density", folder / "density.svg")
            self.assertEqual((folder / "density.svg").read_text(encoding="utf-8"), picture.svg)
            picture.save(folder / "again.svg")
            self.assertEqual((folder / "again.svg").read_bytes(),
                             (folder / "density.svg").read_bytes())
            with self.assertRaisesRegex(ex.Error, "none of .svg, .png, .pdf"):
                self.estimate.plot(file=folder / "density.bmp")
            with self.assertRaises(FileNotFoundError):
                self.estimate.plot(file=folder / "nowhere" / "density.svg")
            for thing in (self.estimate, self.plan, self.scene, self.job):
                thing.report(folder / "page.html")
                page = (folder / "page.html").read_text(encoding="utf-8")
                self.assertEqual(page[:15], "<!doctype html>", type(thing))
                self.assertLess(page.find('<section id="settings">'), 0, "it had no options")

    def test_results_are_json(self):
        for thing in (self.estimate, self.estimate.change, self.estimate.density, self.plan,
                      self.scene, self.job, self.plan.trajectory):
            self.assertGreater(len(json.loads(thing.to_json())), 2, type(thing))
        self.assertEqual(json.loads(self.plan.to_json())["density_percent"],
                         self.estimate.density.percent)

    @unittest.skipIf(numpy is None, "NumPy is not installed")
    def test_maps_and_paths_are_arrays(self):
        heights = ex.HeightMap([[1.0, 2.0], [3.0, float("nan")]])
        self.assertEqual(numpy.asarray(heights)[1, 0], 3.0)
        self.assertEqual(heights.to_numpy().shape, (2, 2))
        self.assertEqual(numpy.array(heights, dtype=numpy.float32).dtype, numpy.float32)
        self.assertEqual(numpy.asarray(ex.Terrain(heights)).shape, (2, 2))
        self.assertEqual(numpy.asarray(self.plan.path).shape, (len(self.plan.path), 3))
        self.assertEqual(numpy.asarray(self.plan.trajectory).shape, (len(self.plan.trajectory), 5))
        self.assertEqual(numpy.asarray(ex.Cloud([[1, 2, 3]])).shape, (1, 3))
        self.assertEqual(ex.joint_motion(self.plan.trajectory).to_numpy().shape[0],
                         len(self.plan.trajectory))


if __name__ == "__main__":
    unittest.main()
