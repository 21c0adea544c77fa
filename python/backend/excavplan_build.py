# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""The build backend of `pip install .` (PEP 517 and 660).

Calls CMake, which links the module against the static libraries, and packs a wheel. It needs no
network and no other Python package; the compiler and the libraries are those of the system
(docs/python.md). The same sources give the same bytes, with the time of SOURCE_DATE_EPOCH.
"""

import base64
import gzip
import hashlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import time
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAME = "excavplan"
EARLIEST = 315532800  # of a ZIP file: 1980-01-01


def version():
    """The version, which CMakeLists.txt alone states."""
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(excavplan VERSION ([0-9.]+)", text).group(1)


def metadata():
    """Text of METADATA and of PKG-INFO."""
    return "\n".join([
        "Metadata-Version: 2.1",
        f"Name: {NAME}",
        f"Version: {version()}",
        "Summary: Soil-adaptive planning of autonomous excavation",
        "License: Apache-2.0",
        "Requires-Python: >=3.9",
        "Provides-Extra: arrays",
        'Requires-Dist: numpy; extra == "arrays"',
        ""])


def tag():
    """Interpreter, ABI and platform of the module: cp311-cp311-linux_x86_64."""
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-" + re.sub(r"[-. ]", "_", sysconfig.get_platform())


# ---- CMake --------------------------------------------------------------------------------------


def run(*command):
    subprocess.run([str(part) for part in command], check=True)


def cmake_arguments(settings):
    """Of --config-settings=cmake-args="-D ...", for one or several of them."""
    given = (settings or {}).get("cmake-args", [])
    return [word for text in ([given] if isinstance(given, str) else given)
            for word in text.split()]


def precompiled():
    """ON without a compiler cache, which takes no files with precompiled headers."""
    return "OFF" if "CMAKE_CXX_COMPILER_LAUNCHER" in os.environ else "ON"


def staged(settings):
    """Builds the package and installs it. Gives the folder that holds it."""
    build = ROOT / f"build-python-{tag()}"
    generator = ["-G", "Ninja"] if shutil.which("ninja") else []
    run("cmake", "-S", ROOT, "-B", build, *generator,
        "-D", "CMAKE_BUILD_TYPE=Release", "-D", "BUILD_SHARED_LIBS=OFF",
        "-D", "EXCAVPLAN_PYTHON=ON", "-D", "EXCAVPLAN_TOOLS=OFF", "-D", "EXCAVPLAN_TESTS=OFF",
        "-D", f"EXCAVPLAN_PRECOMPILED={precompiled()}",
        # Where the library finds its data: share/excavplan beside the module.
        "-D", f"CMAKE_INSTALL_LIBDIR={NAME}", "-D", f"CMAKE_INSTALL_DATADIR={NAME}/share",
        "-D", f"Python_EXECUTABLE={sys.executable}", *cmake_arguments(settings))
    jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
    run("cmake", "--build", build, "--target", "excavplan_python", "--parallel", jobs)
    stage = build / "stage"
    shutil.rmtree(stage, ignore_errors=True)
    for component in ("Python", "PythonData"):
        run("cmake", "--install", build, "--component", component, "--prefix", stage, "--strip")
    return stage


# ---- archives -----------------------------------------------------------------------------------


def epoch():
    return max(EARLIEST, int(os.environ.get("SOURCE_DATE_EPOCH", EARLIEST)))


def files_below(folder):
    """(name in the archive, content, whether it may be executed), in a fixed order."""
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            yield path.relative_to(folder).as_posix(), path.read_bytes(), path.suffix == ".so"


def record_line(name, content):
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"


def write_wheel(folder, files):
    """Writes the wheel of these files. Gives its name."""
    info = f"{NAME}-{version()}.dist-info"
    wheel = f"Wheel-Version: 1.0\nGenerator: excavplan_build\nRoot-Is-Purelib: false\nTag: {tag()}\n"
    files = [*files,
             (f"{info}/LICENSE", (ROOT / "LICENSE").read_bytes(), False),
             (f"{info}/METADATA", metadata().encode(), False),
             (f"{info}/WHEEL", wheel.encode(), False)]
    record = "".join(record_line(name, content) for name, content, _ in files)
    files.append((f"{info}/RECORD", f"{record}{info}/RECORD,,\n".encode(), False))
    name = f"{NAME}-{version()}-{tag()}.whl"
    with zipfile.ZipFile(pathlib.Path(folder) / name, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content, executable in files:
            entry = zipfile.ZipInfo(path, time.gmtime(epoch())[:6])
            entry.external_attr = (0o100755 if executable else 0o100644) << 16
            archive.writestr(entry, content, zipfile.ZIP_DEFLATED)
    return name


# ---- what pip calls -----------------------------------------------------------------------------


def get_requires_for_build_wheel(config_settings=None):
    return []


get_requires_for_build_sdist = get_requires_for_build_wheel
get_requires_for_build_editable = get_requires_for_build_wheel


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    return write_wheel(wheel_directory, list(files_below(staged(config_settings))))


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    """A wheel that points to the build folder; `pip install -e .` again rebuilds what changed."""
    path = f"{staged(config_settings)}\n".encode()
    return write_wheel(wheel_directory, [(f"__editable__{NAME}.pth", path, False)])


def sources():
    """All files under version control, or of an unpacked sdist."""
    listed = subprocess.run(["git", "-C", str(ROOT), "ls-files", "-z"], stdout=subprocess.PIPE,
                            stderr=subprocess.DEVNULL, check=False)
    if listed.returncode == 0 and listed.stdout:
        return sorted(name for name in listed.stdout.decode().split("\0")
                      if name and (ROOT / name).is_file())
    return sorted(path.relative_to(ROOT).as_posix() for path in ROOT.rglob("*")
                  if path.is_file() and not path.relative_to(ROOT).parts[0].startswith("build")
                  and "__pycache__" not in path.parts)


def build_sdist(sdist_directory, config_settings=None):
    base = f"{NAME}-{version()}"
    path = pathlib.Path(sdist_directory) / f"{base}.tar.gz"
    listed = [(name, (ROOT / name).read_bytes()) for name in sources() if name != "PKG-INFO"]
    with open(path, "wb") as file, gzip.GzipFile("", "wb", 6, file, epoch()) as packed, \
            tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive:
        for name, content in [*listed, ("PKG-INFO", metadata().encode())]:
            entry = tarfile.TarInfo(f"{base}/{name}")
            entry.size, entry.mtime = len(content), epoch()
            entry.mode = 0o755 if os.access(ROOT / name, os.X_OK) else 0o644
            archive.addfile(entry, io.BytesIO(content))
    return path.name
