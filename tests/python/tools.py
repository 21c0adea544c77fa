# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""The tools of the build tree, with whose results those of the module are compared."""

import json
import os
import pathlib
import subprocess
import unittest

BIN = pathlib.Path(os.environ.get("EXCAVPLAN_BIN", "build/bin"))


def result_of(tool, *arguments):
    """The JSON of a tool."""
    program = BIN / tool
    if not program.exists():
        raise unittest.SkipTest(f"{tool} is not built")
    done = subprocess.run([program, *map(str, arguments), "--json"], stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, check=False)
    return json.loads(done.stdout)


def is_part_of(test, text, told):
    """The JSON of a result has keys of the tool's, with their values."""
    own = json.loads(text)
    test.assertGreater(len(own), 5)
    for key, value in own.items():
        test.assertEqual(value, told[key], key)
