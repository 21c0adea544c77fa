#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Opens the pages of --report in Chromium without a screen: report_page.py BIN DATA

Exit code 77, skipped, where Chromium, its driver or python3-selenium is not installed.
"""

import json
import math
import os
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
from chromium import browser  # noqa: E402  first, as it may skip the test
from selenium.webdriver.common.by import By  # noqa: E402
from selenium.webdriver.common.keys import Keys  # noqa: E402

BIN, DATA = sys.argv[1:3]
FOLDER = tempfile.TemporaryDirectory(prefix="excavplan-report-")
SCANS = [f"{DATA}/quickstart/before.pcd", f"{DATA}/quickstart/after.pcd"]
PAGES = {
    "simulate-dig": ["--density", "40"],
    "plan-path": ["--density", "40", "--density-sd", "8", "--trajectory", f"{FOLDER.name}/dig.json"],
    "estimate-density": SCANS,
    "run-experiment": [],
}
DUG = ["simulate-dig", "plan-path", "run-experiment"]  # pages with a slider of time
PAGES["simulate-site"] = [f"{FOLDER.name}/site", "--planner", "operator", "--ground-after",
                          f"{FOLDER.name}/after.asc"]


def write_grid(name, cell, height):
    """An ESRI ASCII grid of level ground around a short trench along x."""
    cols, rows = round(18 / cell), round(14 / cell)
    with open(f"{FOLDER.name}/site/{name}", "w", encoding="utf-8") as file:
        file.write(f"ncols {cols}\nnrows {rows}\nxllcorner -8\nyllcorner -7\ncellsize {cell}\n")
        file.write((" ".join([str(height)] * cols) + "\n") * rows)


def write_site():
    """A plain site (docs/formats.md)."""
    os.makedirs(f"{FOLDER.name}/site/hidden")
    write_grid("scan0.asc", 0.1, 0.0)
    write_grid("hidden/ground.asc", 0.1, 0.0)
    write_grid("hidden/density.asc", 0.5, 40.0)
    square = [[-4.0, -3.0], [-3.0, -3.0], [-3.0, -2.0]]
    site = {
        "format": "plain-site", "version": 1, "id": "page",
        "design": {"kind": "trench", "length_m": 2.0, "floor_width_m": 1.0, "depth_m": 0.4,
                   "origin_m": [2.0, 0.0], "heading_rad": 0.0, "floor_z_at_middle_m": -0.4},
        "tolerance_m": 0.03, "machine": {"class": "zx120"}, "soil": {"name": "loam"},
        "start_pose": {"x": -0.2, "y": 0.0, "heading_rad": 0.0},
        "sensor": {"name": "lidar", "mount": "cab", "noise_sd_at_1m_m": 0.0, "height_m": 3.0,
                   "tilt_deg": 25, "field_of_view_deg": [360, 45]},
        "dump_areas": [{"kind": "windrow", "polygon": [[-1, 1.5], [7, 1.5], [7, 5.5], [-1, 5.5]]}],
        "keep_out": [{"kind": "cable", "polygon": square}],
        "obstacles": [{"kind": "pole", "polygon": square, "height_m": 3.0}],
        "files": {"first_scan": "scan0.asc"}}
    for name, content in (("site.json", site), ("hidden/truth.json", {"payload_noise": 0.01})):
        with open(f"{FOLDER.name}/site/{name}", "w", encoding="utf-8") as file:
            json.dump(content, file)


def read_grid(name):
    """Rows of a grid from the south, its corner and its cell."""
    with open(name, encoding="utf-8") as file:
        head = [next(file).split() for _ in range(6)]
        rows = [[float(z) for z in line.split()] for line in file]
    values = {key.lower(): float(value) for key, value in head}
    return rows[::-1], (values["xllcorner"], values["yllcorner"]), values["cellsize"]


def tip_of(machine, joints):
    """Forward kinematics as in include/excavplan/machine/machine.hpp."""
    x, z = machine["geometry"]["boom_pin_m"]
    angle = 0.0
    for length, joint in zip(("boom", "arm", "bucket"), joints):
        angle -= joint
        x += machine["geometry"][length + "_length_m"] * math.cos(angle)
        z += machine["geometry"][length + "_length_m"] * math.sin(angle)
    return x, z


def joints_at(points, at):
    """Of (time, joints), linear between them."""
    after = next(i for i, point in enumerate(points) if point[0] >= at or point is points[-1])
    if after == 0:
        return points[0][1]
    (t0, a), (t1, b) = points[after - 1], points[after]
    share = (at - t0) / (t1 - t0)
    return [p + share * (q - p) for p, q in zip(a, b)]


# Ratios of contrast (WCAG 2) of all texts on the page below what is readable.
FAINT = """
const channels = (text) => (text.match(/[\\d.]+/g) || []).map(Number);
const rgba = (text) => {
  const c = channels(text);
  const unit = text.startsWith("color(") ? 255 : 1;
  return [c[0] * unit, c[1] * unit, c[2] * unit, c.length > 3 ? c[3] : 1];
};
const over = (a, b) => [0, 1, 2].map((i) => a[3] * a[i] + (1 - a[3]) * b[i]).concat(1);
const backOf = (node) => {
  if (!node) return [255, 255, 255, 1];
  const back = rgba(getComputedStyle(node).backgroundColor);
  return back[3] >= 1 ? back : over(back, backOf(node.parentElement));
};
const light = (c) => c.slice(0, 3).map((v) => v / 255)
  .map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
  .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
const faint = [];
for (const node of document.body.querySelectorAll("*")) {
  if (node.closest("figure, script, noscript, [hidden], #marks")) continue;
  if (![...node.childNodes].some((each) => each.nodeType === 3 && each.data.trim())) continue;
  if (!node.checkVisibility()) continue;
  const style = getComputedStyle(node);
  const back = backOf(node);
  const ink = over(rgba(node.namespaceURI.endsWith("svg") ? style.fill : style.color), back);
  const [a, b] = [light(ink), light(back)].sort((p, q) => q - p);
  const ratio = (a + 0.05) / (b + 0.05);
  if (ratio < 4.5) faint.push(`${node.tagName} ${node.className} ${node.textContent.slice(0, 30)}: ${ratio.toFixed(2)}`);
}
return faint;
"""


# What holds more than it is wide, with all that is folded unfolded.
SIDEWAYS = """
for (const each of document.querySelectorAll("details")) each.open = true;
return [...document.querySelectorAll("main, main *")]
  .filter((each) => ["auto", "scroll"].includes(getComputedStyle(each).overflowX))
  .filter((each) => each.scrollWidth > each.clientWidth + 1)
  .map((each) => `${each.tagName} ${each.className}: ${each.scrollWidth} > ${each.clientWidth}`);
"""
# Parts of the page that share ground with the slider.
COVERED = """
const box = (each) => each.getBoundingClientRect();
const player = document.getElementById("player");
const a = box(player);
return [...document.querySelectorAll("#scene > *, header, footer, #figures")]
  .filter((each) => each !== player && box(each).height)
  .filter((each) => box(each).top < a.bottom - 1 && box(each).bottom > a.top + 1)
  .map((each) => each.id || each.tagName);
"""


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with open(f"{DATA}/machines/zx120.json", encoding="utf-8") as file:
            cls.machine = json.load(file)
        cls.results = {}
        write_site()
        for tool, words in PAGES.items():
            done = subprocess.run([f"{BIN}/{tool}", *words, "--json", "--report", cls.file(tool)],
                                  env={**os.environ, "EXCAVPLAN_DATA": DATA},
                                  check=True, capture_output=True, text=True)
            cls.results[tool] = done.stdout
        cls.driver = browser("--use-angle=swiftshader", "--enable-unsafe-swiftshader")

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()

    @staticmethod
    def file(tool):
        return f"{FOLDER.name}/{tool}.html"

    def open(self, tool, width=1600, scheme="light", driver=None):
        driver = driver or self.driver
        driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "features": [{"name": "prefers-color-scheme", "value": scheme}]})
        driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
        driver.get("file://" + self.file(tool))
        for _ in range(200):
            drawn = driver.execute_script("return document.documentElement.dataset.drawnAfterMs")
            if drawn:
                return int(drawn)
            time.sleep(0.1)
        self.fail(f"{tool}: nothing was drawn: {driver.get_log('browser')}")

    def script(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def picture(self):
        """Of the view, once what was asked for is drawn, which is in the next frame."""
        return self.driver.execute_async_script("""
            const done = arguments[0];
            const later = (frames) => requestAnimationFrame(() =>
              (frames ? later(frames - 1) : done(document.getElementById('canvas').toDataURL())));
            later(3)""")

    def silent(self, driver=None):
        self.assertEqual((driver or self.driver).get_log("browser"), [])

    def test_pages_open_without_a_word_and_load_nothing(self):
        for tool in PAGES:
            drawn = self.open(tool)
            size = os.path.getsize(self.file(tool))
            print(f"{tool}: {size / 1e6:.2f} MB, drawn {drawn} ms after the page began to load")
            self.assertEqual(self.script("return performance.getEntriesByType('resource').length"), 0)
            self.assertTrue(self.script("return document.body.classList.contains('drawn')"), tool)
            self.assertLess(self.script("return document.getElementById('stage').clientHeight"), 700)
            self.silent()

    def test_figures_are_those_of_the_json(self):
        for tool, printed in self.results.items():
            self.open(tool)
            result = json.loads(printed)
            text = self.script("return document.getElementById('result').textContent")
            self.assertEqual(text, printed)
            cells = self.script("""
                return [...document.querySelectorAll('[data-key]')].map((each) =>
                  [each.dataset.key, each.dataset.value, each.dataset.sd || null, each.textContent])""")
            self.assertGreater(len(cells), 10, tool)
            for key, value, sd, shown in cells:
                there = result
                for part in key.split("."):
                    there = there[int(part)] if isinstance(there, list) else there[part]
                self.assertEqual(json.loads(value), there, key)
                if isinstance(there, float):
                    number = shown.split("±")[0].split()[0]
                    digits = len(number.partition(".")[2])
                    self.assertAlmostEqual(float(number), there, delta=0.5001 * 10.0 ** -digits, msg=key)
                if sd and float(sd) > 0:
                    self.assertIn("±", shown, key)

    def test_slider_moves_the_bucket_along_the_trajectory(self):
        with open(f"{FOLDER.name}/dig.json", encoding="utf-8") as file:
            written = [(point["time_s"], point["joints_rad"]) for point in json.load(file)["points"]]
        for tool in DUG:
            self.open(tool)
            dig = json.loads(self.script("return document.getElementById('data').textContent"))["digs"][0]
            points = list(zip(dig["time_s"], zip(*dig["joints_rad"])))
            if tool == "plan-path":
                points = written
            slider = self.driver.find_element(By.ID, "time")
            slider.send_keys(Keys.HOME)
            seen = []
            for keys in ([], [Keys.ARROW_RIGHT] * 7, [Keys.PAGE_UP] * 3, [Keys.PAGE_UP] * 4, [Keys.END]):
                for key in keys:
                    slider.send_keys(key)
                now = self.script("return excavplanReport.time()")
                expected = tip_of(self.machine, joints_at(points, now))
                drawn = self.script("return excavplanReport.tip()")
                section = self.script("const t = document.getElementById('tip').dataset; return [+t.x, +t.z]")
                for place in (drawn, section):
                    self.assertAlmostEqual(place[0], expected[0], delta=1e-4, msg=f"{tool} at {now} s")
                    self.assertAlmostEqual(place[1], expected[1], delta=1e-4, msg=f"{tool} at {now} s")
                self.assertIn(f"{now:.2f} s", self.driver.find_element(By.ID, "now").text)
                seen.append(now)
            self.assertEqual(seen, sorted(set(seen)))
            self.assertAlmostEqual(seen[-1], points[-1][0], delta=0.021)
            self.silent()

    def test_job_is_played_to_the_ground_after(self):
        self.open("simulate-site")
        data = json.loads(self.script("return document.getElementById('data').textContent"))
        count = len(data["events"])
        slider = self.driver.find_element(By.ID, "time")
        shown = {}
        for key, step in ((Keys.END, count), (Keys.HOME, 0), (Keys.ARROW_RIGHT, 1), (Keys.END, count)):
            slider.send_keys(key)
            self.assertEqual(self.script("return excavplanReport.time()"), step)
            self.assertIn(f"step {step} of {count}", self.driver.find_element(By.ID, "now").text)
            heights = self.script("return excavplanReport.heights()")
            self.assertEqual(heights, shown.setdefault(step, heights), "the way there does not matter")
        self.assertEqual(set(shown[0]), {0})
        rows, (x0, y0), cell = read_grid(f"{FOLDER.name}/after.asc")
        for i, height in enumerate(shown[count]):
            row = round((data["origin_m"][1] - y0) / cell) + 2 * (i // data["cols"])
            col = round((data["origin_m"][0] - x0) / cell) + 2 * (i % data["cols"])
            mean = sum(rows[row + k][col + l] for k in (0, 1) for l in (0, 1)) / 4
            self.assertAlmostEqual(height, mean, delta=0.00051)
        row = self.script("return document.querySelector('#steps tr.now').dataset.step")
        self.assertEqual(int(row), count)
        self.script("document.querySelector('[data-step=\"2\"] td').click()")
        self.assertEqual(self.script("return excavplanReport.time()"), 2)
        self.silent()

    def test_job_shows_its_layers(self):
        self.open("simulate-site")
        pictures = [self.picture()]
        for state in ("error", "change", "step"):
            self.driver.find_element(By.CSS_SELECTOR, f"[data-state={state}]").send_keys(Keys.ENTER)
            pictures.append(self.picture())
        self.driver.find_element(By.ID, "sheet").send_keys(Keys.ENTER)
        pictures.append(self.picture())
        self.assertEqual(len(set(pictures)), len(pictures))
        plan = "return document.getElementById('map').toDataURL()"
        error = self.script(plan)
        self.driver.find_element(By.CSS_SELECTOR, "[data-layer=age]").send_keys(Keys.ENTER)
        self.assertNotEqual(self.script(plan), error)
        across = "return document.getElementById('across-section').innerHTML"
        before = self.script(across)
        self.driver.find_element(By.ID, "map-box").click()
        self.assertNotEqual(self.script(across), before, "a click moves the sections")
        self.silent()

    def test_keys_play_and_turn(self):
        self.open("simulate-dig")
        body = self.driver.find_element(By.TAG_NAME, "body")
        body.send_keys(" ")
        for _ in range(100):
            if self.script("return excavplanReport.time()") > 0.2:
                break
            time.sleep(0.1)
        body.send_keys(" ")
        stopped = self.script("return excavplanReport.time()")
        self.assertGreater(stopped, 0.2)
        time.sleep(0.3)
        self.assertEqual(self.script("return excavplanReport.time()"), stopped)

        canvas = self.driver.find_element(By.ID, "canvas")
        pictures = [self.picture()]
        for key in (Keys.ARROW_LEFT, Keys.ARROW_UP, "+", "r"):
            canvas.send_keys(key)
            pictures.append(self.picture())
        self.assertEqual(pictures[0], pictures[-1], "R resets the view")
        self.assertEqual(len(set(pictures)), 4)
        shown = self.driver.find_element(By.CSS_SELECTOR, "[data-state=change]")
        self.assertEqual(shown.get_attribute("aria-pressed"), "true", "the change is the first view")
        for state in ("before", "after"):
            self.driver.find_element(By.CSS_SELECTOR, f"[data-state={state}]").send_keys(Keys.ENTER)
            pictures.append(self.picture())
        self.assertEqual(len(set(pictures)), 6)
        self.assertEqual(shown.get_attribute("aria-pressed"), "false")
        self.silent()

    def test_readable_at_both_widths_in_light_and_dark(self):
        for tool in PAGES:
            for scheme in ("light", "dark"):
                for width in (420, 1600):
                    self.open(tool, width, scheme)
                    self.assertLessEqual(self.script("return document.documentElement.scrollWidth"), width)
                    self.assertEqual(self.script(FAINT), [], f"{tool}, {scheme}, {width} px")
                    self.silent()

    def test_nothing_scrolls_sideways_on_a_phone(self):
        for tool in PAGES:
            self.open(tool, 420)
            wide = self.script(SIDEWAYS)
            self.assertEqual(wide, [], tool)

    def test_slider_covers_nothing_on_a_desk(self):
        for tool in [*DUG, "simulate-site"]:
            self.open(tool, 1600)
            for top in (0, 400, 10000):
                self.script("window.scrollTo(0, arguments[0])", top)
                self.assertEqual(self.script(COVERED), [], f"{tool}, scrolled by {top} px")

    def test_prints(self):
        for tool in PAGES:
            self.open(tool, 1600, "dark")
            pdf = self.driver.execute_cdp_cmd("Page.printToPDF", {"printBackground": True})["data"]
            self.assertGreater(len(pdf), 20000)
            self.silent()

    def test_without_webgl_the_plot_stands_in(self):
        driver = browser("--disable-3d-apis")
        try:
            for tool in PAGES:
                self.open(tool, driver=driver)
                self.assertTrue(driver.find_element(By.ID, "no-view").is_displayed())
                stands_in = "#map" if tool == "simulate-site" else "figure svg"
                self.assertTrue(driver.find_element(By.CSS_SELECTOR, stands_in).is_displayed(), tool)
                if tool != "estimate-density":
                    driver.find_element(By.ID, "time").send_keys(Keys.END)
                    self.assertGreater(driver.execute_script("return excavplanReport.time()"), 1.0)
                self.silent(driver)
        finally:
            driver.quit()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
