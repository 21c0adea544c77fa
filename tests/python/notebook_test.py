# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""The notebook runs from top to bottom, without Jupyter, and holds no outputs."""

import contextlib
import io
import json
import pathlib
import unittest

NOTEBOOK = pathlib.Path(__file__).resolve().parents[2] / "python" / "examples" / "first_dig.ipynb"


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
        self.assertIn("density 41.5 +- 3.1 %", shown.getvalue())
        self.assertGreater(names["plan"].dig.payload_mass, 400.0)


if __name__ == "__main__":
    unittest.main()
