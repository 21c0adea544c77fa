# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""The notebooks run from top to bottom, without Jupyter, and hold no outputs; so do all examples of
docs/python.md, whose tables name what there is."""

import ast
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
NOTEBOOKS = ROOT / "python" / "examples"
GUIDE = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")


class Notebook(unittest.TestCase):
    def run_notebook(self, name):
        """Its names, and what it prints. What a cell ends with shows itself."""
        notebook = json.loads((NOTEBOOKS / name).read_text(encoding="utf-8"))
        names, printed = {}, io.StringIO()
        with contextlib.redirect_stdout(printed):
            for cell in notebook["cells"]:
                if cell["cell_type"] != "code":
                    continue
                self.assertEqual(cell["outputs"], [])
                lines = ast.parse("".join(cell["source"]))
                last = lines.body.pop() if isinstance(lines.body[-1], ast.Expr) else None
                exec(compile(lines, name, "exec"), names)  # noqa: S102: our own
                if last is not None:
                    shown = eval(compile(ast.Expression(last.value), name, "eval"), names)
                    self.assert_shows_itself(shown)
        self.assertNotIn(" at 0x", printed.getvalue())
        return names, printed.getvalue()

    def assert_shows_itself(self, thing):
        if thing is None:  # print()
            return
        shows = getattr(thing, "_repr_html_", None) or thing._repr_svg_
        self.assertGreater(len(shows()), 200)

    def test_the_first_dig(self):
        names, printed = self.run_notebook("first_dig.ipynb")
        self.assertIn("density 41.6 +- 3.2 %", printed)
        self.assertGreater(names["plan"].dig.payload_mass, 400.0)

    def test_the_trench(self):
        names, printed = self.run_notebook("trench.ipynb")
        self.assertIn("<JobStep 1: ", printed)
        self.assertGreater(names["progress"].digs, 1)
        self.assertLess(names["deepest"], -0.1)

    def test_no_notebook_is_left_out(self):
        self.assertEqual(sorted(file.name for file in NOTEBOOKS.glob("*.ipynb")),
                         ["first_dig.ipynb", "trench.ipynb"])

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
