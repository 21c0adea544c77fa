# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C and callbacks that raise end a search."""

import signal
import subprocess
import sys
import time
import unittest

import excavplan as ex

PROGRAM = """
import signal
import excavplan as ex
signal.signal(signal.SIGINT, signal.default_int_handler)  # also where a shell ignores it
machine, loam = ex.load_machine("zx120"), ex.load_soil("loam")
print("begins", flush=True)
try:
    ex.build_path_library(machine, loam, range(1, 100), [0.01 * i for i in range(21)])  # 2079 searches
except KeyboardInterrupt:
    print("interrupted")
"""


class Interrupts(unittest.TestCase):
    def test_ctrl_c_ends_searches(self):
        with subprocess.Popen([sys.executable, "-c", PROGRAM], stdout=subprocess.PIPE,
                              text=True) as running:
            self.assertEqual(running.stdout.readline(), "begins\n")
            time.sleep(0.5)
            running.send_signal(signal.SIGINT)
            start = time.monotonic()
            answer, _ = running.communicate(timeout=60)
            self.assertEqual(answer, "interrupted\n")
            self.assertLess(time.monotonic() - start, 30.0)

    def test_a_callback_that_raises(self):
        def raising(state):
            raise LookupError(state.evaluations)

        machine, loam = ex.load_machine("zx120"), ex.load_soil("loam")
        with self.assertRaises(LookupError) as raised:
            ex.plan_dig(machine, loam, 40, method="search",
                        search=ex.DigSearchOptions(progress=raising))
        self.assertEqual(raised.exception.args, (1,))
        with self.assertRaises(LookupError):
            ex.build_path_library(machine, loam, [40, 60],
                                  progress=lambda state: {}[state.entries])


if __name__ == "__main__":
    unittest.main()
