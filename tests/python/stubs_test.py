# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""The stub says what the module has; mypy, where it is installed, agrees with an example."""

import importlib.util
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import excavplan as ex

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "python" / "excavplan"

EXAMPLE = """
from pathlib import Path
from typing import Optional
import excavplan as ex

class Own(ex.SoilSimulator):
    def __init__(self, machine: ex.Machine, soil: ex.SoilKind, density: float) -> None:
        super().__init__()

    def dig(self, terrain: ex.Terrain, path: ex.DigPath,
            options: Optional[ex.DigOptions] = None) -> ex.DigResult:
        return ex.DigResult(payload_mass=1.0)

plan: ex.DigPlan = ex.plan_dig(ex.load_machine("zx120"), ex.load_soil("loam"), 40.0, simulator=Own)
if plan.dig is not None:
    mass: float = plan.dig.payload_mass
estimate = ex.estimate_density("before.pcd", ex.Cloud([[1.0, 2.0, 3.0]]), soil="loam")
motion = ex.plan_motion(ex.load_machine(Path("zx120.json")), plan, start=[-0.6, 1.6, 0.5, 0.7])
patches = [ex.TerrainPatch(), ex.TerrainPatch(0, 0, [[1.0]], [[0.0]])]
scan = ex.Scan(("before.pcd", Path("more.pcd")))
options = ex.DigSearchOptions(checkpoint=Path("digs.json"), start_rule=6.5)
name: str = ex.load_path_library(b"library.json").file
"""

REFUSED = ("plan.payload", "class Derived(ex.HeightMapSimulator): ...", "ex.TerrainPatch(0)",
           "ex.read_cloud(3)")


def written():
    spec = importlib.util.spec_from_file_location("write_stub",
                                                  ROOT / "python" / "stub" / "write_stub.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.stub()


class Stubs(unittest.TestCase):
    def test_the_stub_is_that_of_the_module(self):
        self.assertEqual((PACKAGE / "__init__.pyi").read_text(encoding="utf-8"), written())

    def test_every_public_name_has_a_text(self):
        for name in ex.__all__:
            member = getattr(ex, name)
            self.assertGreater(len((member.__doc__ or "").strip().splitlines()[-1]), 10, name)

    def mypy(self, text):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(PACKAGE, pathlib.Path(folder) / "excavplan")
            file = pathlib.Path(folder) / "example.py"
            file.write_text(text, encoding="utf-8")
            return subprocess.run(["mypy", "--strict", "--no-incremental", "example.py"],
                                  cwd=folder, stdout=subprocess.PIPE, text=True, check=False)

    @unittest.skipUnless(shutil.which("mypy"), "mypy is not installed")
    def test_mypy(self):
        checked = self.mypy(EXAMPLE)
        self.assertEqual(checked.returncode, 0, checked.stdout)
        wrong = self.mypy(EXAMPLE + "\n".join(REFUSED) + "\n").stdout
        self.assertEqual(wrong.count("error:"), len(REFUSED), wrong)


if __name__ == "__main__":
    unittest.main()
