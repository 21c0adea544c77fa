#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Tables of the documents against their sources: check_tables.py SOURCE

* docs/guide/warnings.md has no warning code twice;
* each warning code of the sources is in docs/guide/warnings.md, or, of the nodes of ROS, in docs/ros.md, and
  each of docs/guide/warnings.md is in the sources;
* every test that docs/ecosystem.md names is in the tree, and every wish that is met names one.
"""

import re
import sys
from pathlib import Path

SOURCE = Path(sys.argv[1])
failures = []


def rows(text):
    """The cells of each row of the tables, without heads and rules."""
    for block in re.findall(r"(?:^\|.*\n)+", text, re.M):
        for line in block.splitlines()[2:]:
            yield [cell.strip() for cell in line.strip("|").split(" |")]


def words(cell):
    return re.findall(r"`([^`]+)`", cell)


def check_codes():
    stated = [code for row in rows((SOURCE / "docs/guide/warnings.md").read_text()) for code in words(row[0])]
    if len(stated) < 50:
        failures.append(f"docs/guide/warnings.md: only {len(stated)} warning codes were found")
    twice = sorted({code for code in stated if stated.count(code) > 1})
    failures.extend(f"docs/guide/warnings.md: {code} is there twice" for code in twice)


def codes_of_the_sources():
    """Each code with what it does to trust: kept, depends or ended."""
    table = (SOURCE / "include/excavplan/base/warning_codes.def").read_text()
    return dict(re.findall(r"^EXCAVPLAN_WARNING\((\w+), (\w+)\)$", table, re.MULTILINE))


def check_codes_of_the_sources():
    stated = {}
    for name in ("guide/warnings", "ros"):
        for row in rows((SOURCE / f"docs/{name}.md").read_text()):
            stated.update({code: " ".join(row[1:]) for code in words(row[0])})
    made = codes_of_the_sources()
    if len(made) < 100:
        failures.append(f"only {len(made)} warning codes were found in the sources")
    failures.extend(f"docs/guide/warnings.md: lacks the warning code {code}" for code in sorted(made.keys() - stated.keys()))
    guide = {code for row in rows((SOURCE / "docs/guide/warnings.md").read_text()) for code in words(row[0])}
    failures.extend(f"docs/guide/warnings.md: {code} is no warning code" for code in sorted(guide - made.keys()))
    for row in rows((SOURCE / "docs/guide/warnings.md").read_text()):
        for code, mark in re.findall(r"`(\w+)`(?: (†|\(†\)))?", row[0]):
            meant = {"": "kept", "†": "ended", "(†)": "depends"}[mark]
            if made.get(code, meant) != meant:
                failures.append(f"docs/guide/warnings.md: {code}: trust is {meant} there, {made[code]} in the sources")


def tests_of_the_tree():
    sources = "\n".join(file.read_text() for file in (SOURCE / "tests").rglob("*.cpp"))
    names = {".".join(match) for match in re.findall(r"\bTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)", sources)}
    lists = [SOURCE / "CMakeLists.txt", *(SOURCE / "tests").rglob("CMakeLists.txt"), *(SOURCE / "examples").rglob("CMakeLists.txt")]
    for file in lists:
        names.update(re.findall(r"add_test\(NAME (\w+)", file.read_text()))
    python = (SOURCE / "tests/python").glob("*_test.py")
    return names | {"python_" + file.name[: -len("_test.py")] for file in python}


def check_ecosystem():
    tests = tests_of_the_tree()
    wishes = list(rows((SOURCE / "docs/ecosystem.md").read_text()))
    if len(wishes) < 24:
        failures.append(f"docs/ecosystem.md: only {len(wishes)} wishes were found")
    for number, _, threads, answer, shown in wishes:
        named = words(shown)
        if not named and not answer.startswith("No"):
            failures.append(f"docs/ecosystem.md: wish {number} names no test")
        for name in named:
            if name not in tests and not (SOURCE / name).is_file():
                failures.append(f"docs/ecosystem.md: wish {number}: no test {name}")
        if not re.search(r"[\w-]+/[\w.-]+#\d+", threads):
            failures.append(f"docs/ecosystem.md: wish {number} cites no thread")


check_codes()
check_codes_of_the_sources()
check_ecosystem()
print(*failures, sep="\n")
sys.exit(1 if failures else 0)
