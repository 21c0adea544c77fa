# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""The build backend without a build: archives, their bytes and what they say.

scripts/check.d/25-python installs the package with pip.
"""

import hashlib
import importlib.util
import os
import pathlib
import tarfile
import tempfile
import unittest
import unittest.mock
import zipfile

import excavplan

ROOT = pathlib.Path(__file__).resolve().parents[2]

spec = importlib.util.spec_from_file_location("backend",
                                              ROOT / "python" / "backend" / "excavplan_build.py")
backend = importlib.util.module_from_spec(spec)
spec.loader.exec_module(backend)

FILES = [("excavplan/__init__.py", b"text", False), ("excavplan/_core.so", b"module", True)]


class Packaging(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        clean = unittest.mock.patch.dict(os.environ)
        clean.start()
        self.addCleanup(clean.stop)
        os.environ.pop("SOURCE_DATE_EPOCH", None)

    def test_the_version_is_that_of_the_library(self):
        self.assertEqual(backend.version(), excavplan.__version__)

    def test_nothing_is_asked_for(self):
        for ask in (backend.get_requires_for_build_wheel, backend.get_requires_for_build_sdist,
                    backend.get_requires_for_build_editable):
            self.assertEqual(ask(), [])

    def test_a_wheel(self):
        name = backend.write_wheel(self.folder, FILES)
        first = (self.folder / name).read_bytes()
        backend.write_wheel(self.folder, FILES)
        self.assertEqual((self.folder / name).read_bytes(), first)
        with zipfile.ZipFile(self.folder / name) as wheel:
            info = f"excavplan-{backend.version()}.dist-info"
            record = wheel.read(f"{info}/RECORD").decode().splitlines()
            self.assertEqual([line.split(",")[0] for line in record], wheel.namelist())
            self.assertIn(f"Tag: {backend.tag()}", wheel.read(f"{info}/WHEEL").decode())
            self.assertEqual(wheel.getinfo("excavplan/_core.so").external_attr >> 16, 0o100755)
            self.assertEqual(wheel.getinfo("excavplan/_core.so").date_time[0], 1980)

    def test_its_time_is_that_of_the_source(self):
        os.environ["SOURCE_DATE_EPOCH"] = "1700000000"
        name = backend.write_wheel(self.folder, FILES)
        with zipfile.ZipFile(self.folder / name) as wheel:
            self.assertEqual(wheel.infolist()[0].date_time, (2023, 11, 14, 22, 13, 20))

    def test_an_sdist_holds_what_a_build_needs(self):
        name = backend.build_sdist(self.folder)
        first = hashlib.sha256((self.folder / name).read_bytes()).digest()
        with tarfile.open(self.folder / name) as archive:
            base = f"excavplan-{backend.version()}"
            names = {each[len(base) + 1:] for each in archive.getnames()}
        for needed in ("pyproject.toml", "CMakeLists.txt", "python/src/module.cpp", "PKG-INFO",
                       "data/machines/zx120.json", "src/planning/plan_dig.cpp"):
            self.assertIn(needed, names)
        self.assertFalse([each for each in names if each.startswith("build")])
        backend.build_sdist(self.folder)
        self.assertEqual(hashlib.sha256((self.folder / name).read_bytes()).digest(), first)

    def test_settings_of_cmake(self):
        self.assertEqual(backend.cmake_arguments(None), [])
        self.assertEqual(backend.cmake_arguments({"cmake-args": ["-D A=1", "-D B=2"]}),
                         ["-D", "A=1", "-D", "B=2"])


if __name__ == "__main__":
    unittest.main()
