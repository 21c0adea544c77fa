#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Every link of a built site leads to a file in it and, after '#', to a place in that file, and no
page loads anything from elsewhere: check_links.py FOLDER."""
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

FOLDER = Path(sys.argv[1]).resolve()
LOADED = {"script": "src", "img": "src", "iframe": "src", "source": "src", "link": "href"}
FEWEST_LINKS = 5000


class Page(HTMLParser):
    """Links, what is loaded, and the places that a link may lead to."""

    def __init__(self, file):
        super().__init__()
        self.links, self.loaded, self.places = [], [], set()
        self.feed(file.read_text(encoding="utf-8", errors="replace"))

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.places.update(values[key] for key in ("id", "name") if values.get(key))
        if tag == "a" and values.get("href"):
            self.links.append(values["href"])
        if tag in LOADED and values.get(LOADED[tag]):
            self.loaded.append(values[LOADED[tag]])


PAGES = {file: Page(file) for file in FOLDER.rglob("*.html")}


def wrong(file, link):
    """Why a link leads nowhere, or nothing."""
    path, _, place = unquote(link).partition("#")
    target = (file.parent / path.partition("?")[0]).resolve() if path else file
    if not target.is_file():
        return "no such file"
    if FOLDER not in target.parents:
        return "outside the site"
    if place and target in PAGES and place not in PAGES[target].places:
        return "no such place"
    return None


def main():
    failures, links = [], 0
    for file, page in sorted(PAGES.items()):
        name = file.relative_to(FOLDER)
        local = [link for link in page.links if not re.match(r"[a-z]+:|//", link)]
        links += len(local)
        outside = [link for link in page.loaded if re.match(r"https?:|//", link)]
        inside = [link for link in page.loaded if not re.match(r"[a-z]+:|//", link)]
        failures += [f"{name}: {link}: {wrong(file, link)}" for link in local + inside if wrong(file, link)]
        failures += [f"{name}: loads {link}" for link in outside]
    for file in FOLDER.rglob("*.css"):
        loads = re.findall(r"url\(['\"]?(https?:[^)'\"]*)|@import ['\"](https?:[^'\"]*)", file.read_text())
        failures += [f"{file.relative_to(FOLDER)}: loads {first or second}" for first, second in loads]
    if links < FEWEST_LINKS:
        failures.append(f"only {links} links under {FOLDER}: nothing was checked")
    print(*failures, f"{links} links of {len(PAGES)} pages", sep="\n")
    sys.exit(1 if failures else 0)


main()
