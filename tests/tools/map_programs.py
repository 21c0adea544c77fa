#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Opens the maps of --map in GDAL, CloudCompare and QGIS: map_programs.py BIN DATA

What a program shows is compared with the JSON of the run and with the other formats. Tests of a
program that is not installed are skipped; exit code 77 where none is.
"""

import json
import math
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

BIN, DATA = sys.argv[1:3]
FOLDER = tempfile.TemporaryDirectory(prefix="excavplan-maps-")
ENVIRONMENT = {**os.environ, "QT_QPA_PLATFORM": "offscreen", "XDG_RUNTIME_DIR": FOLDER.name}
GDAL = shutil.which("gdal_translate") and shutil.which("gdalinfo") and shutil.which("ogrinfo")
CLOUDCOMPARE = shutil.which("CloudCompare") or shutil.which("cloudcompare.CloudCompare")


def command(words):
    done = subprocess.run(words, capture_output=True, text=True, env=ENVIRONMENT, timeout=300)
    if done.returncode != 0:
        raise RuntimeError(f"{words}: {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


def has_qgis():
    try:
        command(["/usr/bin/python3", "-c", "import qgis.core"])
        return True
    except (RuntimeError, OSError):
        return False


QGIS = has_qgis()
if not (GDAL or CLOUDCOMPARE or QGIS):
    print("skipped: none of gdal-bin, cloudcompare and python3-qgis is installed")
    sys.exit(77)


def file(name):
    return f"{FOLDER.name}/{name}"


def run(tool, words, maps):
    """The JSON of a tool that writes maps, each "NAME=FILE"."""
    options = []
    for name, _, target in (each.partition("=") for each in maps):
        options += ["--map", f"{name}={file(target)}"]
    return json.loads(command([f"{BIN}/{tool}", *words, *options, "--json"]))


SURVEY = run(
    "estimate-density",
    [f"{DATA}/quickstart/before.pcd", f"{DATA}/quickstart/after.pcd"],
    ["all=scans.tif", "all=scans.ply", *(f"{each}={each}.asc" for each in ("before", "after", "change", "sd", "zones"))],
)
SCENE = run("simulate-dig", ["--density", "40", "--dump-at", "4.9,3.6"], ["change=dug.asc"])
PLAN = run("plan-path", ["--density", "40"], ["path=plan.dxf", "path=plan.ply", "footprint=footprint.asc"])
KINDS = {1: "dig", 2: "spill", 3: "dump", 4: "other"}


def ascii_grid(name):
    """Values by (x, y) of the centre, in mm, and the size of a cell. NODATA is left out."""
    with open(file(name), encoding="ascii") as lines:
        head = {key: float(value) for key, value in (next(lines).split() for _ in range(6))}
        rows = [[float(word) for word in line.split()] for line in lines]
    cell = head["cellsize"]
    assert len(rows) == head["nrows"] and {len(row) for row in rows} == {int(head["ncols"])}
    values = {}
    for i, row in enumerate(rows):
        for j, value in enumerate(row):
            if value != head["NODATA_value"]:
                values[place(head["xllcorner"] + cell * (j + 0.5),
                             head["yllcorner"] + cell * (len(rows) - i - 0.5))] = value
    return values, cell


def place(x, y):
    return round(1000.0 * x), round(1000.0 * y)


def ply_points(name):
    """Rows of numbers, and the names of their columns."""
    with open(file(name), "rb") as stream:
        data = stream.read()
    end = data.index(b"end_header\n") + 11
    columns = [line.split()[2].decode() for line in data[:end].splitlines() if line.startswith(b"property double")]
    count = int(data[:end].split(b"element vertex ")[1].split()[0])
    row = struct.Struct(f"<{len(columns)}d")
    return [row.unpack_from(data, end + i * row.size) for i in range(count)], columns


def within(at, extent):
    return extent[0] <= at[0] / 1000.0 <= extent[2] and extent[1] <= at[1] / 1000.0 <= extent[3]


class Content(unittest.TestCase):
    """The files as they are."""

    def test_zones_lie_where_the_result_says(self):
        zones, _ = ascii_grid("zones.asc")
        for number, kind in KINDS.items():
            extents = [zone["extent_m"] for zone in SURVEY["zones"] if zone["kind"] == kind]
            cells = [at for at, value in zones.items() if value == number]
            self.assertEqual(bool(extents), bool(cells), kind)
            for at in cells:
                self.assertTrue(any(within(at, extent) for extent in extents), (kind, at))

    def test_change_in_its_zones_is_the_volume(self):
        change, cell = ascii_grid("change.asc")
        zones, _ = ascii_grid("zones.asc")
        for number, key, sign in ((1, "excavated", -1.0), (2, "spilled", 1.0), (3, "dumped", 1.0)):
            volume = sum(z for at, z in change.items() if zones[at] == number) * cell * cell * sign
            told, sd = SURVEY["volume"][f"{key}_m3"], SURVEY["volume"][f"{key}_sd_m3"]
            self.assertLess(abs(volume - told), 2.0 * sd + 0.02 * told, key)

    def test_change_is_after_less_before(self):
        before, _ = ascii_grid("before.asc")
        after, _ = ascii_grid("after.asc")
        change, _ = ascii_grid("change.asc")
        self.assertEqual(set(change), set(after))
        for at, value in change.items():
            self.assertAlmostEqual(after[at] - before[at], value, places=12)

    def test_deviation_is_known_where_the_change_is(self):
        change, _ = ascii_grid("change.asc")
        deviation, _ = ascii_grid("sd.asc")
        self.assertEqual(set(change), set(deviation))
        zones, _ = ascii_grid("zones.asc")
        stable = [value / deviation[at] for at, value in change.items() if zones[at] == 0]
        rms = math.sqrt(sum(each * each for each in stable) / len(stable))
        self.assertTrue(0.7 < rms < 1.4, rms)

    def test_simulated_change_is_the_volume(self):
        change, cell = ascii_grid("dug.asc")
        fallen = -sum(z for z in change.values() if z < 0.0) * cell * cell
        risen = sum(z for z in change.values() if z > 0.0) * cell * cell
        volume = SCENE["volume"]
        self.assertAlmostEqual(fallen, volume["excavated_m3"], places=9)
        self.assertAlmostEqual(risen, volume["spilled_m3"] + volume["dumped_m3"], places=9)
        highest = max(change, key=change.get)
        self.assertLess(abs(highest[0] - 4900) + abs(highest[1] - 3600), 400, "heap at y 3.6 m, not -3.6 m")

    def test_points_are_the_cells(self):
        points, columns = ply_points("scans.ply")
        layers = {"scalar_height_before_m": "before", "scalar_height_after_m": "after",
                  "scalar_change_m": "change", "scalar_change_sd_m": "sd", "scalar_zone": "zones"}
        self.assertEqual(columns, ["x", "y", "z", *layers])
        for column, layer in layers.items():
            values, _ = ascii_grid(f"{layer}.asc")
            for point in points:
                self.assertEqual(point[columns.index(column)], values[place(*point[:2])], column)

    def test_footprint_lies_around_the_path(self):
        footprint, _ = ascii_grid("footprint.asc")
        cut = [at for at, value in footprint.items() if value == 1.0]
        points, _ = ply_points("plan.ply")
        deepest = min(points, key=lambda point: point[2])
        self.assertLess(deepest[2], -0.1)
        self.assertEqual({footprint[at] for at in footprint if abs(at[1]) < 200 and abs(at[0] - 1000 * deepest[0]) < 50},
                         {1.0})
        self.assertTrue(0 < len(cut) < len(footprint) / 2)


@unittest.skipUnless(GDAL, "gdal-bin is not installed")
class Gdal(unittest.TestCase):
    def values(self, name, band=1):
        """As GDAL reads them, by way of raw numbers: most of its text formats round to float32."""
        options = ["--config", "AAIGRID_DATATYPE", "Float64"]
        info = json.loads(command(["gdalinfo", "-json", *options, file(name)]))
        command(["gdal_translate", "-q", "-of", "ENVI", "-ot", "Float64", "-b", str(band), *options, file(name),
                 file("raw")])
        width, height = info["size"]
        x, cell_x, _, y, _, cell_y = info["geoTransform"]
        nodata = info["bands"][band - 1]["noDataValue"]
        with open(file("raw"), "rb") as stream:
            numbers = struct.unpack(f"<{width * height}d", stream.read())
        return {place(x + cell_x * (i % width + 0.5), y + cell_y * (i // width + 0.5)): value
                for i, value in enumerate(numbers) if not math.isnan(value) and value != nodata}

    def same(self, one, other):
        self.assertGreater(len(one), 1000)
        self.assertEqual(set(one), set(other))
        for at, value in one.items():
            self.assertEqual(value, other[at], at)

    def test_reads_ascii_grids(self):
        for name in ("change.asc", "zones.asc", "dug.asc"):
            self.same(self.values(name), ascii_grid(name)[0])

    def test_reads_geotiff(self):
        info = json.loads(command(["gdalinfo", "-json", file("scans.tif")]))
        names = ["height_before_m", "height_after_m", "change_m", "change_sd_m", "zone"]
        self.assertEqual([band["description"] for band in info["bands"]], names)
        self.assertEqual({band["type"] for band in info["bands"]}, {"Float64"})
        self.assertEqual({str(band["noDataValue"]).lower() for band in info["bands"]}, {"nan"})
        self.assertEqual(info["metadata"][""]["AREA_OR_POINT"], "Area")
        self.assertRegex(info["coordinateSystem"]["wkt"],
                         '^(ENGCRS|LOCAL_CS).*excavplan site frame(.|\n)*"metre",1')
        with open(file("change.asc"), encoding="ascii") as lines:
            head = {key: float(value) for key, value in (next(lines).split() for _ in range(6))}
        cell = head["cellsize"]
        self.assertEqual(info["size"], [head["ncols"], head["nrows"]])
        for told, expected in zip(info["geoTransform"],
                                  (head["xllcorner"], cell, 0.0, head["yllcorner"] + cell * head["nrows"], 0.0, -cell)):
            self.assertAlmostEqual(told, expected, places=12)
        for band, name in enumerate(("before", "after", "change", "sd", "zones"), 1):
            self.same(self.values("scans.tif", band), ascii_grid(f"{name}.asc")[0])

    def test_reads_lines(self):
        text = command(["ogrinfo", "-ro", "-al", file("plan.dxf")])
        self.assertIn("Feature Count: 2", text)
        self.assertIn("Layer (String) = tip_path", text)
        self.assertIn("Layer (String) = footprint", text)
        points, _ = ply_points("plan.ply")
        line = text.split("LINESTRING Z (")[1].split(")")[0].split(",")
        for words, point in zip(line, points):
            for word, number in zip(words.split(), point):
                self.assertAlmostEqual(float(word), number, places=9)


@unittest.skipUnless(CLOUDCOMPARE, "cloudcompare is not installed")
class CloudCompare(unittest.TestCase):
    def opened(self, name):
        out = file(name + ".asc")
        command([CLOUDCOMPARE, "-SILENT", "-AUTO_SAVE", "OFF", "-O", file(name), "-C_EXPORT_FMT", "ASC",
                 "-PREC", "9", "-ADD_HEADER", "-SAVE_CLOUDS", "FILE", out])
        with open(out, encoding="ascii") as lines:
            return next(lines).split(), [[float(word) for word in line.split()] for line in lines]

    def test_shows_the_layers_of_a_map(self):
        head, rows = self.opened("scans.ply")
        self.assertEqual(head[3:], ["height_before_m", "height_after_m", "change_m", "change_sd_m", "zone"])
        points, _ = ply_points("scans.ply")
        self.assertEqual(len(rows), len(points))
        for row, point in zip(rows, points):
            for one, other in zip(row, point):
                self.assertLess(abs(one - other), 2e-6)  # its float32

    def test_opens_lines(self):
        _, rows = self.opened("plan.ply")
        self.assertEqual(len(rows), len(ply_points("plan.ply")[0]))


QGIS_SCRIPT = """
import json, sys
from qgis.core import QgsApplication, QgsPointXY, QgsRasterLayer, QgsVectorLayer
QgsApplication.setPrefixPath("/usr", True)
app = QgsApplication([], False)
app.initQgis()
folder, places = sys.argv[1], json.loads(sys.argv[2])
told = {}
def layer(name):
    map = QgsRasterLayer(folder + "/" + name, name, "gdal")
    assert map.isValid(), name
    return map
def values(map, band):
    at = [map.dataProvider().sample(QgsPointXY(x / 1000.0, y / 1000.0), band) for x, y in places]
    return [value if known else None for value, known in at]
grid = layer("change.asc")
told["asc"] = values(grid, 1)
map = layer("scans.tif")
told["tif"] = values(map, 3)
told["names"] = [map.bandName(band) for band in range(1, map.bandCount() + 1)]
told["crs"] = map.crs().isValid(), map.crs().isGeographic()
told["same_extent"] = map.extent().toString(6) == grid.extent().toString(6)
lines = QgsVectorLayer(folder + "/plan.dxf", "plan", "ogr")
assert lines.isValid()
told["lines"] = sorted(each["Layer"] for each in lines.getFeatures())
print(json.dumps(told), flush=True)
del map, grid, lines  # before what they belong to
app.exitQgis()
"""


@unittest.skipUnless(QGIS, "python3-qgis is not installed")
class Qgis(unittest.TestCase):
    def test_opens_maps_and_lines(self):
        change, _ = ascii_grid("change.asc")
        places = sorted(change)[::97] + [(10**7, 10**7)]
        text = command(["/usr/bin/python3", "-c", QGIS_SCRIPT, FOLDER.name, json.dumps(places)])
        told = json.loads(text.splitlines()[-1])
        for values in (told["asc"], told["tif"]):
            self.assertIsNone(values.pop())
            for at, value in zip(places, values):
                self.assertLess(abs(value - change[at]), 1e-6)
        self.assertEqual(told["lines"], ["footprint", "tip_path"])
        self.assertTrue(told["same_extent"])
        self.assertIn("change_m", told["names"][2])
        self.assertFalse(told["crs"][1], "the frame has no longitudes")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
