#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of a page as a reader would.

    run_guide.py PAGE                      with the Debian packages, which are installed
    run_guide.py PAGE --clone BIN SOURCE   in a folder that looks like a clone with its programs built

--on-path: the page takes it that the programs of the clone are on PATH. --all: the slow blocks too, and
a block that cannot be run here is a failure.

All ```sh blocks run one after the other in one folder. A word after "sh" says what is special:

    exit=4         the exit code that the text states; otherwise 0
    needs=python   run where `import excavplan` works, needs=mpirun where there is mpirun
    slow           run only with --all
    clone          run only in a clone; packages: only with the Debian packages
    example        not run: names files that only the reader has

A ```text block right behind is what the block prints: a line "..." stands for any lines, numbers may
differ by one in the last digit shown. A block of another language with a file name, as
```python first.py, is saved under that name.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

FENCE = re.compile(r"^```(\w+)[ \t]*([^\n]*)\n(.*?)^```[ \t]*$(\n\n?```text\n(.*?)^```[ \t]*$)?", re.M | re.S)
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def blocks(text):
    """(language, words, content, expected output or None, line) of each fenced block."""
    for match in FENCE.finditer(text):
        language, words, content, _, expected = match.groups()
        yield language, words.split(), content, expected, text.count("\n", 0, match.start()) + 1


def same_number(stated, found):
    digits = len(stated.partition(".")[2])
    return abs(float(stated) - float(found)) <= 1.0001 * 10.0**-digits


def same_line(stated, found):
    stated, found = " ".join(stated.split()), " ".join(found.split())
    if NUMBER.sub("#", stated) != NUMBER.sub("#", found):
        return False
    return all(map(same_number, NUMBER.findall(stated), NUMBER.findall(found)))


def matches(stated, found):
    """Whether the lines are as stated; "..." stands for any lines."""
    if not stated:
        return not found
    if stated[0] == "...":
        return any(matches(stated[1:], found[skipped:]) for skipped in range(len(found) + 1))
    return bool(found) and same_line(stated[0], found[0]) and matches(stated[1:], found[1:])


def clone(folder, programs, source):
    """A folder that looks like a clone with its programs built."""
    (folder / "build").mkdir(parents=True)
    (folder / "build/bin").symlink_to(programs)
    for name in ("data", "docs", "examples", "include", "scripts"):
        (folder / name).symlink_to(source / name)


class Reader:
    """Runs blocks one after the other; folder and environment are kept from one to the next."""

    def __init__(self, root, path):
        self.state = root / "state"
        self.state.mkdir()
        (root / "excavplan").mkdir(exist_ok=True)
        python = self.state / "python3"  # the one that the module was built for
        python.write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
        python.chmod(0o755)
        self.environment = {**os.environ, "PATH": f"{self.state}:{path}", "LC_ALL": "C.UTF-8",
                            "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        self.run(f'cd "{root}/excavplan"')

    def run(self, script):
        """Exit code and what it printed."""
        state = self.state
        # Open MPI leaks; read by sanitized programs alone.
        script = re.sub(r"^mpirun ", "ASAN_OPTIONS=detect_leaks=0 mpirun ", script, flags=re.M)
        kept = f'if [ -e "{state}/env" ]; then . "{state}/env"; cd "$(cat "{state}/cwd")"; fi\n'
        keep = f"trap 'export -p >\"{state}/env\"; pwd >\"{state}/cwd\"' EXIT\n"
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", kept + keep + script],
                              env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, timeout=1200)
        return done.returncode, done.stdout

    def save(self, name, content):
        Path((self.state / "cwd").read_text().strip(), name).write_text(content)


def lacks(words):
    if "needs=python" in words:
        return subprocess.run([sys.executable, "-c", "import excavplan"], capture_output=True).returncode != 0
    return "needs=mpirun" in words and not shutil.which("mpirun")


def known(word):
    return (word in ("slow", "clone", "packages", "example", "needs=python", "needs=mpirun")
            or re.fullmatch(r"exit=\d+", word))


def left_out(words, options):
    """Whether the page itself says that a block with these words is not for this run."""
    return ("example" in words or ("slow" in words and not options.all)
            or ("packages" if options.clone else "clone") in words)


def run_page(reader, options):
    """Messages about blocks that do not do what the page says, how many there are, and how many ran."""
    page = options.page
    failures, found, ran = [], 0, 0
    for language, words, content, expected, line in blocks(page.read_text(encoding="utf-8")):
        place = f"{page.name}:{line}"
        if language != "sh":
            if words:
                reader.save(words[0], content)
            elif language == "text":
                failures.append(f"{place}: is right behind no block of commands")
            continue
        found += 1
        failures += [f"{place}: unknown word '{word}'" for word in words if not known(word)]
        if left_out(words, options) or lacks(words):
            print(f"not run: {place} {' '.join(words)}")
            if options.all and not left_out(words, options):
                failures.append(f"{place}: cannot be run here: {' '.join(words)}")
            continue
        code, printed = reader.run(content)
        ran += 1
        stated_code = next((int(word[5:]) for word in words if word.startswith("exit=")), 0)
        if code != stated_code:
            failures.append(f"{place}: exit code {code}, not {stated_code}\n{content}{printed}")
        elif expected is not None and not matches(expected.splitlines(), printed.splitlines()):
            failures.append(f"{place}: prints something else than the page says:\n{printed}")
    return failures, found, ran


def options_of(words):
    parser = argparse.ArgumentParser()
    parser.add_argument("page", type=Path)
    parser.add_argument("--clone", type=lambda word: Path(word).resolve(), nargs=2)
    parser.add_argument("--on-path", action="store_true")
    parser.add_argument("--all", action="store_true")
    return parser.parse_args(words)


def main():
    options = options_of(sys.argv[1:])
    path = "/usr/bin:/bin"
    with tempfile.TemporaryDirectory(prefix="excavplan-guide-") as folder:
        if options.clone:
            clone(Path(folder) / "excavplan", *options.clone)
            path = f"{options.clone[0]}:{path}" if options.on_path else path
        failures, found, ran = run_page(Reader(Path(folder), path), options)
    if found == 0 or (options.all and ran == 0):
        failures.append(f"{options.page}: no block was run")
    print(*failures, f"{ran} blocks of {options.page.name} run", sep="\n")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
