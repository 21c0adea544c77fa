#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Lays out the pages of the site for Sphinx: stage.py SITE (a folder with api.tag in it).

The documents are written for the repository. Here their links are made those of the site: to
another page, to a header in the API reference, or to a copy of a source file. The headings and
lists of docs/index.md become the navigation.
"""
import html
import os
import re
import shutil
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SITE = Path(sys.argv[1])
PAGES, EXTRA = SITE / "pages", SITE / "extra"
MOVED = {"README.md": "readme.md", "data/README.md": "data.md"}  # the other pages keep their names

FENCE = re.compile(r"(^ *```.*?^ *```[ \t]*$)", re.M | re.S)
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^()\s]+)\)")
HEADER = re.compile(r"(?<![\[\"/>])`([a-z]+/[a-z_]+\.hp?p?)`(?!\])")


def pages():
    """Name in the repository and name in the site of each page."""
    found = [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), ROOT / "data/README.md"]
    names = sorted(file.relative_to(ROOT).as_posix() for file in found)
    return {name: MOVED.get(name, name.removeprefix("docs/").lower()) for name in names}


def api_pages():
    """Header as it is included, without its first folder, and its page in the reference."""
    headers = {}
    for file in xml.parse(SITE / "api.tag").iterfind("compound[@kind='file']"):
        path = file.find("path").text + file.find("name").text
        headers[path.split("excavplan/", 1)[-1]] = file.find("filename").text
    html_names = {name: page if page.endswith(".html") else page + ".html" for name, page in headers.items()}
    listed = {}
    for header in (ROOT / "include/excavplan").glob("*/*.h*"):
        name = header.relative_to(ROOT / "include/excavplan").as_posix()
        escaped = header.name.replace("_", "__").replace(".", "_8") + "_source.html"
        page = html_names.get(name, escaped)
        for candidate in (page, escaped):
            if (EXTRA / "api" / candidate).exists():
                listed[name] = "api/" + candidate
                break
    return listed


SITE_NAMES, API = pages(), api_pages()


def relative(page, target):
    return os.path.relpath(target, os.path.dirname(page) or ".")


def source_copy(path):
    """Copy of a file of the repository, or a list of those of a folder, as a file of the site."""
    if (ROOT / path).is_dir():
        target = EXTRA / "source" / path / "index.html"
        files = sorted(file for file in (ROOT / path).iterdir() if file.is_file())
        rows = [f'<li><a href="{file.name}.txt">{html.escape(file.name)}</a></li>' for file in files]
        for file in files:
            source_copy(file.relative_to(ROOT).as_posix())
        target.parent.mkdir(parents=True, exist_ok=True)
        head = f'<!DOCTYPE html><meta charset="utf-8"><title>{path}</title><h1>{path}</h1>'
        target.write_text(head + f'<ul>{"".join(rows)}</ul>\n')
        return f"source/{path}/index.html"
    target = EXTRA / "source" / (path + ".txt")
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(ROOT / path, target)
    return f"source/{path}.txt"


def raw_link(text, url):
    text = re.sub(r"`([^`]*)`", lambda code: f"<code>{html.escape(code[1])}</code>", text)
    return f'<a href="{url}">{text}</a>'


def site_link(name, page, match):
    """A link of the page with this name in the repository as a link of the site."""
    picture, text, link = match.groups()
    if re.match(r"[a-z]+:", link) or link.startswith("#"):
        return match[0]
    path, _, anchor = link.partition("#")
    target = os.path.normpath(os.path.join(os.path.dirname(name), path))
    if not (ROOT / target).exists():
        sys.exit(f"docs: {name}: no such file: {link}")
    if target in SITE_NAMES:
        return f"[{text}]({relative(page, SITE_NAMES[target])}{'#' if anchor else ''}{anchor})"
    if picture:
        copy = PAGES / target.removeprefix("docs/")
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / target, copy)
        return f"![{text}]({relative(page, copy.relative_to(PAGES).as_posix())})"
    api = API.get(target.removeprefix("include/excavplan/"))
    return raw_link(text, relative(page, api or source_copy(target)))


def header_link(page, match):
    api = API.get(match[1])
    return raw_link(match[0], relative(page, api)) if api else match[0]


def site_text(name, page):
    parts = FENCE.split((ROOT / name).read_text())
    for number in range(0, len(parts), 2):
        text = LINK.sub(lambda match: site_link(name, page, match), parts[number])
        parts[number] = HEADER.sub(lambda match: header_link(page, match), text)
    return "".join(parts)


def navigation(text):
    """A table of contents for each heading of the first page, of the pages that its list links to."""
    blocks = []
    for section in re.split(r"^## ", text, flags=re.M)[1:]:
        caption = section.splitlines()[0]
        linked = [match[3].partition("#")[0] for match in LINK.finditer(section) if not match[1]]
        entries = [link for link in dict.fromkeys(linked) if link.endswith(".md")]
        if entries:
            rows = "\n".join(entries)
            blocks.append(f"```{{toctree}}\n:hidden:\n:caption: {caption}\n\n{rows}\n```\n")
    return "\n" + "\n".join(blocks)


def mend_summary(file):
    """Doxygen heads a class by links to its sections, also to those that are empty as all is private."""
    text = file.read_text(encoding="utf-8")
    summary = re.compile(r'<a href="#([a-z-]+)">[^<]*</a>(?: &#124;\s*)?')
    mended = summary.sub(lambda link: link[0] if f'name="{link[1]}"' in text else "", text)
    if mended != text:
        file.write_text(mended, encoding="utf-8")


def main():
    for file in (EXTRA / "api").glob("class*.html"):
        mend_summary(file)
    for name, page in SITE_NAMES.items():
        text = site_text(name, page)
        target = PAGES / page
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text + (navigation(text) if page == "index.md" else ""))


main()
