#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Opens a job that plan-site serves in Chromium, and goes on with it: served_page.py BIN DATA

Exit code 77, skipped, where Chromium, its driver or python3-selenium is not installed, or plan-site
was built without what serves.
"""

import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
from chromium import browser  # noqa: E402  first, as it may skip the test
from selenium.webdriver.support.ui import WebDriverWait  # noqa: E402

BIN, DATA = sys.argv[1:3]
FOLDER = tempfile.TemporaryDirectory(prefix="excavplan-served-")
JOB = f"{FOLDER.name}/job"
ENVIRONMENT = {**os.environ, "EXCAVPLAN_DATA": DATA}


def plan_site(*words):
    done = subprocess.run([f"{BIN}/plan-site", *words, "--json"], env=ENVIRONMENT, check=True,
                          capture_output=True, text=True)
    return json.loads(done.stdout)


def write_ground(name, height):
    """An ESRI ASCII grid of 10^5 cells."""
    cols, rows, cell = 360, 280, 0.05
    with open(f"{FOLDER.name}/{name}", "w", encoding="utf-8") as file:
        file.write(f"ncols {cols}\nnrows {rows}\nxllcorner -8\nyllcorner -7\ncellsize {cell}\n")
        for row in range(rows - 1, -1, -1):
            y = -7 + cell * (row + 0.5)
            file.write(" ".join(str(height(-8 + cell * (col + 0.5), y)) for col in range(cols)))
            file.write("\n")
    return f"{FOLDER.name}/{name}"


class Served(unittest.TestCase):
    def setUp(self):
        level = write_ground("level.asc", lambda x, y: 0.0)
        plan_site("new", JOB, "--trench", "2.5x1x0.4", "--from", "2,0", "--heading", "0", "--scan",
                  level, "--windrow", "0,1.5,7,1.5,7,5.5,0,5.5", "--time", "1000")
        self.server = subprocess.Popen([f"{BIN}/plan-site", "show", JOB, "--serve", "0"],
                                       env=ENVIRONMENT, stderr=subprocess.PIPE,
                                       stdout=subprocess.DEVNULL, text=True)
        line = self.server.stderr.readline()
        if "without Boost.Beast" in line:
            print("skipped:", line)
            sys.exit(77)
        self.url = re.search(r"http://\S+", line)[0]
        self.driver = browser("--use-angle=swiftshader", "--enable-unsafe-swiftshader")

    def tearDown(self):
        self.driver.quit()
        self.server.kill()
        self.server.wait()
        self.server.stderr.close()

    def script(self, text):
        return self.driver.execute_script(text)

    def wait(self, text):
        """Until a script returns what is true."""
        return WebDriverWait(self.driver, 60).until(lambda _: self.script(text), text)

    def test_page_follows_the_job(self):
        self.driver.get(self.url)
        self.wait("return document.getElementById('live')?.textContent === 'Live'")
        self.assertEqual(self.script("return excavplanReport.heights().filter((z) => z < 0).length"), 0)

        move = plan_site("next", JOB)
        self.wait("return document.querySelector('.verdict').textContent.includes('Next: step 1, move.')")
        plan_site("done", JOB, "--step", str(move["step"]), "--base=-0.6,0,0")
        self.wait("return document.querySelectorAll('#steps tbody tr').length === 1")
        self.wait("return excavplanReport.time() === 1")

        dig = plan_site("next", JOB)
        self.assertEqual(dig["what"], "dig")
        after = write_ground("after.asc", lambda x, y: -0.3 if 3.2 < x < 4.4 and abs(y) < 0.5 else 0.0)
        done = plan_site("done", JOB, "--step", str(dig["step"]), "--payload-mass", "400",
                         "--energy-kj", "140", "--scan", after, "--time", "1200")
        self.wait("return excavplanReport.time() === 2")
        low = self.script("return Math.min(...excavplanReport.heights())")
        self.assertAlmostEqual(low, -0.3, delta=0.02)
        left = done["progress"]["left_m3"]
        shown = self.wait("return document.querySelector('[data-key=\"progress.left_m3\"]').dataset.value")
        self.assertAlmostEqual(float(shown), left, delta=0.003)
        self.wait("return document.querySelectorAll('#charts .chart').length === 5")
        result = json.loads(self.script("return document.getElementById('result').textContent"))
        self.assertEqual(result["progress"]["digs"], 1)
        self.assertLess(result["belief"]["payload_factor_sd"], 0.06)

        before = self.script("return performance.timeOrigin")
        plan_site("undo", JOB)
        self.wait(f"return performance.timeOrigin !== {before}")
        self.wait("return document.querySelectorAll('#steps tbody tr').length === 1")
        self.wait("return document.getElementById('live')?.textContent === 'Live'")
        self.assertEqual(self.driver.get_log("browser"), [])

        self.server.send_signal(signal.SIGTERM)
        self.assertEqual(self.server.wait(), 0)
        self.wait("return document.getElementById('live').textContent !== 'Live'")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
