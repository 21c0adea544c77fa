#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Draws lines of code for new entries of mutations.tsv: draw.py SEED ROOM COUNT.

A line qualifies where it compares, calculates or holds a number. Loop heads, initial zeros and
lines that make text are left out. The draw is even over the lines of a room, which is a folder of
src and include/excavplan, or "tools".
"""
import random
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
QUALIFIES = re.compile(r" [<>]=? | [=!]= |(?<![\w.\"])\d+(\.\d+)?(e-?\d+)?(?![\w\"])| [-+*/] | [-+*/]= ")
IGNORED = re.compile(r"^\s*(//|#|using |template|\"|static_assert|for \(|\w[\w:<>]* \w+ = 0(\.0)?;)"
                     r"|operator|\w+_text\(|to_string|readable|quoted|\" \+|\+ \"|\+= \(|fail\(|usage_error|\.empty\(\)")


def places(room):
    folders = ["tools"] if room == "tools" else [f"src/{room}", f"include/excavplan/{room}"]
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*.[ch]pp")):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                code = line.split("//")[0]
                if QUALIFIES.search(code) and not IGNORED.search(code):
                    yield path.relative_to(ROOT), number, line


def main(seed, room, count):
    drawn = random.Random(f"{seed} {room}").sample(sorted(places(room)), int(count))
    for path, number, line in sorted(drawn):
        print(f"{path}:{number}: {line.strip()}")


if __name__ == "__main__":
    main(*sys.argv[1:])
