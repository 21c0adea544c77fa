# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Copies the tree and weaves all mutations of mutations.tsv into the copy, so that one build has all
of them and an environment variable chooses one (mutant.hpp).

A line of mutations.tsv, by tabs: file, code with the part that changes in ⟦ ⟧, what that part
becomes, and for a mutation that survives the reason. Code that is not found once is an error. A part
that ends in a semicolon is a statement, any other an expression. Constants lose their constexpr.

Run by itself, it looks whether the code of every line is found once.
"""
import re
import shutil
import subprocess
from collections import defaultdict
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
ENTRIES = ROOT / "tests/mutation/mutations.tsv"


class Mutation(NamedTuple):
    number: int  # line of mutations.tsv
    file: str
    code: str
    becomes: str
    reason: str

    @property
    def room(self):
        parts = Path(self.file).parts
        return {"src": parts[1], "tools": "tools"}.get(parts[0]) or parts[2]


def read_mutations():
    mutations = []
    for number, line in enumerate(ENTRIES.read_text().splitlines(), 1):
        if line and not line.startswith("#"):
            mutations.append(Mutation(number, *(line.split("\t") + [""])[:4]))
    return mutations


def place(mutation, text):
    """Begin and end of the part that changes."""
    before, part, after = re.split("[⟦⟧]", mutation.code)
    if text.count(before + part + after) != 1:
        raise SystemExit(f"{ENTRIES.name}:{mutation.number}: stale, {mutation.file} holds "
                         f"{text.count(before + part + after)} times: {before + part + after}")
    begin = text.index(before + part + after) + len(before)
    return begin, begin + len(part)


def choice(mutation, part):
    test = f"::excavplan_mutant({mutation.number})"
    if part.endswith(";"):
        return f"if ({test}) {{ {mutation.becomes} }} else {{ {part} }}"
    return f"({test} ? ({mutation.becomes}) : ({part}))"


def without_constexpr(text, at):
    """The declaration that ends at `at` as one of a constant that is set at run time."""
    begin = max(text.rfind(mark, 0, at) for mark in ";{}") + 1
    head = text[begin:at]
    if "=" not in head:  # in a table, or in a body
        table = text.rfind("\nconstexpr ", 0, at)
        if table >= 0 and ";\n" not in text[table:at]:
            return text[:table] + text[table:].replace("constexpr", "static const", 1)
        return text
    in_class = re.search(r"\n  static constexpr", head)
    head = head.replace("inline constexpr", "inline const")
    head = head.replace("static constexpr", "static inline const" if in_class else "static const")
    return text[:begin] + re.sub(r"\bconstexpr\b", "static const", head) + text[at:]


def woven(text, mutations):
    places = sorted(((place(m, text), m) for m in mutations), reverse=True)
    last = len(text)
    for (begin, end), mutation in places:
        if end > last:
            raise SystemExit(f"{ENTRIES.name}:{mutation.number}: overlaps another mutation")
        text = text[:begin] + choice(mutation, text[begin:end]) + text[end:]
        last = begin
    for mutation in mutations:
        text = without_constexpr(text, text.index(f"::excavplan_mutant({mutation.number})"))
    up = "../" * mutations[0].file.count("/")
    return f'#include "{up}tests/mutation/mutant.hpp"\n{text}'


def weave(mutations, into):
    """The tree with the mutations; what has not changed keeps its time."""
    by_file = defaultdict(list)
    for mutation in mutations:
        by_file[mutation.file].append(mutation)
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, check=True,
                            capture_output=True, text=True).stdout.split("\n")
    files = {name for name in listed if name and (ROOT / name).is_file()}
    for name in sorted(files):
        content = (ROOT / name).read_bytes()
        if name in by_file:
            content = woven(content.decode(), by_file[name]).encode()
        copy = into / name
        if copy.is_file() and copy.read_bytes() == content:
            continue
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_bytes(content)
        shutil.copymode(ROOT / name, copy)
    for path in [p for p in into.rglob("*") if p.is_file()]:
        if str(path.relative_to(into)) not in files:
            path.unlink()


if __name__ == "__main__":
    for each in read_mutations():
        place(each, (ROOT / each.file).read_text())
