# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Lines, arcs and texts in metres, x to the right and z up, as SVG."""
import math

INK, SOIL, RED, BLUE, GREY = "#1a202c", "#8a6d3b", "#b83232", "#1f5fa8", "#6b7280"


class Sketch:
    def __init__(self, left, right, bottom, top, scale):
        self.left, self.top, self.scale = left, top, scale
        self.width, self.height = (right - left) * scale, (top - bottom) * scale
        self.parts = []

    def at(self, x, z):
        return (x - self.left) * self.scale, (self.top - z) * self.scale

    def line(self, points, colour=INK, width=1.5, fill="none", dash=None, arrow=False):
        places = " ".join("%.1f,%.1f" % self.at(*point) for point in points)
        more = f' stroke-dasharray="{dash}"' if dash else ""
        more += f' marker-end="url(#{colour[1:]})"' if arrow else ""
        self.parts.append(
            f'<polyline points="{places}" fill="{fill}" stroke="{colour}" stroke-width="{width}"{more}/>')

    def arc(self, centre, radius, start, end, colour):
        """From one angle to another [rad], counter-clockwise of x, with an arrow."""
        steps = [start + (end - start) * i / 24 for i in range(25)]
        points = [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in steps]
        self.line(points, colour, 1.3, arrow=True)

    def dot(self, point, colour=INK):
        x, y = self.at(*point)
        self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="#fff" stroke="{colour}"/>')

    def text(self, x, z, text, colour=INK, anchor="start", size=13):
        x, y = self.at(x, z)
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}" '
                          f'font-size="{size}">{text}</text>')

    def svg(self, title):
        markers = "".join(
            f'<marker id="{colour[1:]}" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" '
            f'markerHeight="7" orient="auto"><path d="M0,0 L8,4 L0,8 z" fill="{colour}"/></marker>'
            for colour in (INK, SOIL, RED, BLUE, GREY))
        return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{self.width:.0f}" '
                f'height="{self.height:.0f}" viewBox="0 0 {self.width:.0f} {self.height:.0f}" '
                f'font-family="sans-serif"><title>{title}</title><defs>{markers}</defs>'
                f'<rect width="100%" height="100%" fill="#fff"/>\n' + "\n".join(self.parts) + "\n</svg>")
