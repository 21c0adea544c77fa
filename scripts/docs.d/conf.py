# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Settings of Sphinx for scripts/docs. Everything is local: no fonts or scripts from elsewhere."""
import os

from pygments.lexers.special import TextLexer

project = "excavplan"
author = "The excavplan authors"
copyright = "2026 The excavplan authors"
release = os.environ["EXCAVPLAN_VERSION"]

extensions = ["myst_parser"]
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]
highlight_language = "none"

html_theme = "furo"
html_title = f"excavplan {release}"
html_show_sphinx = False
html_copy_source = False
html_permalinks_icon = "#"
templates_path = ["templates"]
html_static_path = ["static"]
html_css_files = ["site.css"]
html_extra_path = [os.path.join(os.path.dirname(__file__), "../../build/site/extra")]
html_sidebars = {
    "**": [
        "sidebar/brand.html",
        "sidebar/search.html",
        "sidebar/scroll-start.html",
        "sidebar/navigation.html",
        "api.html",
        "sidebar/scroll-end.html",
    ]
}


def setup(app):
    app.add_lexer("csv", TextLexer)
