# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Chromium without a screen, for tests of pages; where it, its driver or python3-selenium is not
installed, whoever imports this ends with exit code 77, skipped."""

import shutil
import sys

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.remote.remote_connection import RemoteConnection
except ImportError:
    print("skipped: python3-selenium is not installed")
    sys.exit(77)

DRIVER = shutil.which("chromedriver")
if not DRIVER or not shutil.which("chromium"):
    print("skipped: chromium or chromium-driver is not installed")
    sys.exit(77)


def browser(*arguments):
    options = Options()
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", *arguments):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    RemoteConnection.set_timeout(60)  # of a command, for a page that does not come to rest [s]
    return webdriver.Chrome(service=Service(DRIVER), options=options)
