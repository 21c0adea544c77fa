# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""The notebook runs from top to bottom, without Jupyter, and holds no outputs; so do all examples of
docs/python.md, whose tables name what there is."""

import contextlib
import io
import json
import os
import pathlib
import re
import shutil
import tempfile
import unittest

import excavplan
from plain_site import write_plain_site

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOTEBOOK = ROOT / "python" / "examples" / "first_dig.ipynb"
GUIDE = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")


class Notebook(unittest.TestCase):
    def test_it_runs(self):
        cells = [cell for cell in json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]
                 if cell["cell_type"] == "code"]
        names = {}
        shown = io.StringIO()
        with contextlib.redirect_stdout(shown):
            for cell in cells:
                self.assertEqual(cell["outputs"], [])
                exec("".join(cell["source"]), names)  # noqa: S102: our own
        self.assertIn("density 41.6 +- 3.2 %", shown.getvalue())
        self.assertGreater(names["plan"].dig.payload_mass, 400.0)

    def test_the_examples_of_the_guide_run(self):
        examples = re.findall(r"```python\n(.*?)```", GUIDE, re.DOTALL)
        self.assertEqual(len(examples), GUIDE.count("```python"))
        after = excavplan.read_cloud(excavplan.data_file("quickstart/after.pcd"))
        names = {"points": after.points}  # what a reader has: points, and the files below
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            self.addCleanup(os.chdir, os.getcwd())
            os.chdir(folder)
            shutil.copy(excavplan.data_file("quickstart/after.pcd"), "after.pcd")
            pathlib.Path("frame.txt").write_text("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n",
                                                 encoding="ascii")
            write_plain_site("T01", length=1.5, depth=0.25)
            for example in examples:
                exec(example, names)  # noqa: S102: our own
        self.assertIsInstance(names["scan"], excavplan.Scan)
        self.assertGreater(names["sent"].positions.shape[0], 10)
        self.assertGreater(names["plan"].dig.efficiency, 0.02)
        self.assertLess(names["truth"].score().left_percent, 40.0)

    def test_the_tables_of_the_guide_name_what_there_is(self):
        table = GUIDE[GUIDE.index("| room |"):GUIDE.index("| in C++ |")]
        for name in re.findall(r"`(\w+)`", table):
            self.assertIn(name, excavplan.__all__)


if __name__ == "__main__":
    unittest.main()
