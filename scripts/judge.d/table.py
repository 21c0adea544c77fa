# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""The digs of the judge beside those of excavplan: CSV, picture, and the tables of the page."""
import csv
import json
import math
import re
import statistics
from pathlib import Path

import deck
import runs
import scene

DOCS = scene.ROOT / "docs"
PAGE, CSV, PICTURE = DOCS / "generated/judge.md", DOCS / "judge.csv", DOCS / "images/judge.svg"
FIGURES = {  # name of the column: heading in the page, its unit there, and how many decimals
    "drag_start_n": ("force, first fifth", 1e3, "kN", 2),
    "drag_middle_n": ("middle", 1e3, "kN", 2),
    "drag_end_n": ("last fifth", 1e3, "kN", 2),
    "end_over_start": ("last over first", 1, "", 2),
    "drag_work_j": ("work of the drag", 1e3, "kJ", 2),
    "tool_work_j": ("work of the tool", 1e3, "kJ", 2),
    "machine_work_j": ("energy of the joints", 1e3, "kJ", 2),
    "cavity_kg": ("in the bucket at the end of the drag", 1, "kg", 0),
    "payload_kg": ("payload", 1, "kg", 0),
}


# ---- The soil of a run, measured, as a soil file ----------------------------------------------


def mark_of(run):
    return "-sticky" if run.cohesion else "-smooth" if run.friction != 0.6 else ""


def cohesion_of(press, plain):
    """From the vertical pressure at failure that a soil bears beyond what it would without cohesion
    at the same friction: s1 = s3 k + 2 c sqrt(k)."""
    friction = math.radians(plain["peak_friction_deg"])
    k = (1 + math.sin(friction)) / (1 - math.sin(friction))
    return max((v - k * h) / (2 * math.sqrt(k)) for _, v, h, _ in press["stresses"][1:])


def soil_of(run, found, critical):
    """Soil file of a run's soil at its own density, at its peak or its critical friction."""
    mark = mark_of(run)
    press, loose, drain = (runs.result(kind + mark) for kind in ("press", "loose", "drain"))
    plain = runs.result("press" if run.cohesion else "press" + mark)
    peak, first = plain["peak_friction_deg"], loose["peak_friction_deg"]
    if run.cohesion:
        first = runs.result("loose")["peak_friction_deg"]
    if critical:
        peak = first = plain["last_friction_deg"]
    void_ratio = lambda result: deck.DENSITY / result["bulk_density_kg_per_m3"] - 1
    soil = json.loads((scene.ROOT / "data/soils/sand.json").read_text())
    soil.pop("sources")
    steel = math.degrees(math.atan(min(deck.WALL, run.friction)))
    soil.update(
        name="judge" + mark, specific_gravity=deck.DENSITY / 1000, water_content=0,
        void_ratio_min=void_ratio(found), void_ratio_max=void_ratio(loose),
        void_ratio_loose=void_ratio(loose),
        cohesion_loosest_pa=cohesion_of(press, plain) if run.cohesion else 0, cohesion_growth=0,
        friction_loosest_rad=math.radians(first), friction_gain_rad=math.radians(peak - first),
        tool_friction_ratio=min(1, steel / peak), adhesion_ratio=0,
        angle_of_repose_rad=math.radians(drain["repose_deg"]))
    return soil


# ---- Figures of a dig -------------------------------------------------------------------------


def figures(rows, payload, cavity):
    """rows: (phase, travelled, force, work of the tool, of the joints) of each step."""
    drag = [row for row in rows if row[0] == "drag"]
    begin = drag[0][1] - (drag[1][1] - drag[0][1]) / 2
    length = drag[-1][1] + (drag[1][1] - drag[0][1]) / 2 - begin
    part = lambda a, b: statistics.fmean(
        row[2] for row in drag if a <= (row[1] - begin) / length <= b)
    start, end = part(0, 0.2), part(0.8, 1)
    return {
        "drag_start_n": start, "drag_middle_n": part(0.4, 0.6), "drag_end_n": end,
        "end_over_start": end / start,
        "drag_work_j": sum(row[3] for row in drag),
        "tool_work_j": sum(row[3] for row in rows),
        "machine_work_j": sum(row[4] for row in rows),
        "cavity_kg": cavity, "payload_kg": payload,
    }


def judged(found):
    at = {name: i for i, name in enumerate(found["columns"])}
    keys = ("phase", "travelled_m", "x_n", "tool_work_j", "machine_work_j")
    rows = [[row[at[key]] for key in keys] for row in found["forces"]]
    angle, penetration, drag = found["path"]
    end = found["start_x_m"] - penetration * math.cos(angle) - drag
    _, last = min((abs(x - end), kg) for _, x, kg in found["cavity"])
    return rows, figures(rows, found["payload_kg"], last)


def ours(run, found, critical):
    """The same dig in excavplan: rows, figures, and the mass in the bucket along the dig."""
    machine, soil = scene.Machine(), soil_of(run, found, critical)
    result, history, points = scene.simulate(run.path, run.start, machine, soil, 100)
    loose = deck.DENSITY / (1 + soil["void_ratio_loose"])
    rows, fill = [], []
    for row, (one, two) in zip(history, scene.bounds(history)):
        joints = [row[name + "_torque_n_m"] * (b - a) for name, a, b in
                  zip(scene.JOINTS, one, two)]
        tool = sum(joints) - machine.links_energy(two) + machine.links_energy(one)
        rows.append([row["phase"], row["travelled_m"], row["soil_x_n"], tool,
                     sum(max(0, work) for work in joints)])
        fill.append((row["phase"], row["travelled_m"], row["bucket_fill_m3"] * loose))
    last = [kg for phase, _, kg in fill if phase == "drag"][-1]
    left = left_by_us(run, machine, points, loose)
    return rows, figures(rows, result["payload_mass_kg"], last), fill, left


def left_by_us(run, machine, points, density, cell=0.05):
    """Soil above the level of the ground, as the judge counts it [kg]; the dump is further away."""
    cells = {}
    for x, y, z in points:
        if abs(y) < 1.6:
            cells.setdefault((math.floor(x / cell), math.floor(y / cell)), []).append(z)
    left = dict.fromkeys(scene.REGIONS, 0.0)
    for (i, j), heights in cells.items():
        x, y = (i + 0.5) * cell, (j + 0.5) * cell
        name = scene.region(run.path, run.start, machine.half_width, x, y)
        left[name] += max(0, statistics.fmean(heights)) * cell**2 * density
    return left


class Dig:
    """A run that is done, with its soil's tests."""

    def __init__(self, name):
        self.name, self.run, self.found = name, runs.RUNS[name], runs.result(name)
        self.rows, self.judge = judged(self.found)
        self.left = self.found["above_ground_kg"]
        self.our_rows, self.ours, self.our_fill, self.our_left = ours(self.run, self.found, False)
        self.critical_rows, self.critical, _, _ = ours(self.run, self.found, True)


def digs():
    tests = lambda run: [runs.result(kind + mark_of(run)) for kind in ("press", "loose", "drain")]
    return {name: Dig(name) for name, run in runs.RUNS.items()
            if run.kind == "dig" and runs.result(name) and all(tests(run))}


# ---- Statistics -------------------------------------------------------------------------------


def ranks(values):
    order = sorted(range(len(values)), key=values.__getitem__)
    return [order.index(i) for i in range(len(values))]


def spearman(one, two):
    n = len(one)
    return 1 - 6 * sum((a - b) ** 2 for a, b in zip(ranks(one), ranks(two))) / (n * (n * n - 1))


def at_zero(points):
    """Line through (radius, value) at radius 0, and its standard error by the residuals."""
    n, mean = len(points), statistics.fmean(r for r, _ in points)
    spread = sum((r - mean) ** 2 for r, _ in points)
    middle = statistics.fmean(v for _, v in points)
    slope = sum((r - mean) * v for r, v in points) / spread
    left = [v - middle - slope * (r - mean) for r, v in points]
    if n < 3:
        return middle - slope * mean, math.nan
    error = math.sqrt(sum(e * e for e in left) / (n - 2) * (1 / n + mean**2 / spread))
    return middle - slope * mean, error


# ---- Output -----------------------------------------------------------------------------------


def write():
    done = digs()
    write_csv(done)
    PICTURE.write_text(picture(done))
    page = PAGE.read_text()
    for name, text in tables(done).items():
        pattern = rf"(<!-- {name}: [^>]*-->\n).*?(<!-- end of {name} -->)"
        page = re.sub(pattern, lambda m: m[1] + "\n" + text + "\n\n" + m[2], page, flags=re.S)
    PAGE.write_text(page)


def write_csv(done):
    settings = ("run", "angle_deg", "penetration_m", "drag_m", "start_x_m", "radius_mm",
                "grain_friction", "cohesion_j_per_m3", "packing", "grains",
                "bulk_density_kg_per_m3")
    with open(CSV, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        kinds = ("judge", "ours", "ours_critical")
        out.writerow([*settings, *(f"{kind}_{name}" for kind in kinds for name in FIGURES),
                      *(f"{kind}_left_{name}_kg" for kind in kinds[:2] for name in scene.REGIONS)])
        for dig in done.values():
            run, found = dig.run, dig.found
            row = [dig.name, round(math.degrees(run.path[0]), 2), *run.path[1:], run.start,
                   round(run.radius * 1000, 1), run.friction, run.cohesion, run.seed,
                   found["grains"], found["bulk_density_kg_per_m3"]]
            for values in (dig.judge, dig.ours, dig.critical):
                row += [f"{values[name]:.5g}" for name in FIGURES]
            left = [values[name] for values in (dig.left, dig.our_left) for name in scene.REGIONS]
            out.writerow(row + [f"{value:.1f}" for value in left])


def cell(name, value):
    _, scale, _, decimals = FIGURES[name]
    return f"{value / scale:.{decimals}f}"


def heading(first, names):
    words = [f"{FIGURES[n][0]} [{FIGURES[n][2]}]" if FIGURES[n][2] else FIGURES[n][0]
             for n in names]
    return ["| " + " | ".join([first] + words) + " |", "|" + "---|" * (len(words) + 1)]


def path_text(run):
    return f"{math.degrees(run.path[0]):.0f}°, {run.path[1]:.2f} m, {run.path[2]:.2f} m"


def lines_of(first, values):
    return "| " + " | ".join([first] + [cell(name, values[name]) for name in FIGURES]) + " |"


def tables(done):
    return {"soils": soils_table(), "sizes": sizes_table(done), "soils-dug": others_table(done),
            "plates": plates_table(done), "left": left_table(done), "ten": ten_table(done)}


def soils_table():
    lines = ["| grains | dense [kg/m³] | peak friction | critical | loose [kg/m³] | peak friction | "
             "critical | repose, loose | cohesion |", "|" + "---|" * 9]
    names = {"": "friction 0.6", "-smooth": "friction 0.3", "-sticky": "cohesive"}
    for mark, name in names.items():
        press, loose, drain = (runs.result(kind + mark) for kind in ("press", "loose", "drain"))
        if not (press and loose and drain):
            continue
        words = [name]
        for found in (press, loose):
            words += [f"{found['bulk_density_kg_per_m3']:.0f}", f"{found['peak_friction_deg']:.1f}°",
                      f"{found['last_friction_deg']:.1f}°"]
        words.append(f"{drain['repose_deg']:.0f}°")
        sticky = mark == "-sticky"
        words.append(f"{cohesion_of(press, runs.result('press')):.0f} Pa" if sticky else "0")
        lines.append("| " + " | ".join(words) + " |")
    return "\n".join(lines)


def scatter(group):
    values = {name: [dig.judge[name] for dig in group] for name in FIGURES}
    mean = {name: statistics.fmean(v) for name, v in values.items()}
    return mean, {name: statistics.stdev(v) for name, v in values.items()}


def named(done, start):
    """Digs by name, coarse grains first."""
    found = [(name, dig) for name, dig in done.items() if name.startswith(start)]
    return dict(sorted(found, key=lambda pair: -pair[1].run.radius))


def sizes_table(done):
    lines = heading("45°, 0.35 m, 1.5 m", FIGURES)
    fixed = named(done, "fixed-")
    for dig in fixed.values():
        run = dig.run
        lines.append(lines_of(f"judge, {run.radius * 1000:.0f} mm, packing {run.seed}", dig.judge))
    for radius in sorted({dig.run.radius for dig in fixed.values()}, reverse=True):
        group = [dig for dig in fixed.values() if dig.run.radius == radius]
        if len(group) > 1:
            mean, deviation = scatter(group)
            lines.append(lines_of(f"judge, {radius * 1000:.0f} mm, mean", mean))
            lines.append(lines_of("standard deviation of packings", deviation))
    lines += size_zero(fixed.values())
    first = fixed["fixed-a"]
    lines.append(lines_of("excavplan, peak friction", first.ours))
    lines.append(lines_of("excavplan, critical friction", first.critical))
    longs = named(done, "long")
    if longs:
        lines += ["", *heading(path_text(longs["long"].run), FIGURES)]
        lines += [lines_of(f"judge, {dig.run.radius * 1000:.0f} mm", dig.judge)
                  for dig in longs.values()] + size_zero(longs.values())
        lines.append(lines_of("excavplan, peak friction", longs["long"].ours))
        lines.append(lines_of("excavplan, critical friction", longs["long"].critical))
    return "\n".join(lines)


def size_zero(group):
    """The line through sizes that leave 3.5 diameters between cut and bottom of the box."""
    group = [dig for dig in group if 7 * dig.run.radius <= dig.run.margins[3]]
    if len({dig.run.radius for dig in group}) < 3:
        return []
    found = {name: at_zero([(dig.run.radius, dig.judge[name]) for dig in group])
             for name in FIGURES}
    lines = [lines_of("judge, line to size 0", {name: v for name, (v, _) in found.items()})]
    if not math.isnan(found["payload_kg"][1]):
        lines.append(lines_of("its standard error", {name: e for name, (_, e) in found.items()}))
    return lines


def others_table(done):
    lines = heading("45°, 0.35 m, 1.5 m, 30 mm", FIGURES)
    names = {"narrow": "narrow box", "slow": "0.3 m/s", "smooth": "grain friction 0.3",
             "sticky": "cohesive"}
    for name, text in names.items():
        if name in done:
            dig = done[name]
            lines.append(lines_of(f"judge, {text}", dig.judge))
            if name in ("smooth", "sticky"):
                lines.append(lines_of(f"excavplan, {text}, peak friction", dig.ours))
                lines.append(lines_of(f"excavplan, {text}, critical friction", dig.critical))
    return "\n".join(lines)


def plates_table(done):
    """Force on each plate along the drag, means over the first and the last fifth."""
    lines = ["| dig | floor | back | sides |", "|" + "---|" * 4]
    for name in ("fixed-a", "fixed-b", "fixed-c", "fixed-25", "fixed-20", "long", "smooth", "sticky"):
        if name not in done:
            continue
        found = done[name].found
        drag = [row for row in found["forces"] if row[0] == "drag"]
        part, words = len(drag) // 5, [name]
        for plate in ("floor", "back", "side"):
            column = found["columns"].index(plate + "_x_n")
            ends = [statistics.fmean(row[column] for row in rows) / 1e3
                    for rows in (drag[:part], drag[-part:])]
            words.append(f"{ends[0]:.2f} … {ends[1]:.2f}")
        lines.append("| " + " | ".join(words) + " |")
    return "\n".join(lines)


def left_table(done):
    lines = ["| dig | side | ahead | beside | behind | in the cut |", "|" + "---|" * 6]
    for name in ("fixed-a", "long", "smooth", "sticky"):
        if name in done:
            for side, left in (("judge", done[name].left), ("excavplan", done[name].our_left)):
                words = [name, side] + [f"{left[region]:.0f}" for region in scene.REGIONS]
                lines.append("| " + " | ".join(words) + " |")
    return "\n".join(lines)


def per_work(values, energy="tool_work_j"):
    return values["payload_kg"] / values[energy] * 1000


def ten_table(done):
    group = [dig for name, dig in done.items() if name.startswith("ten-")]
    lines = ["| path | judge: force, first … last fifth [kN] | work of the tool [kJ] | payload [kg] | "
             "kg/kJ | excavplan: force | work of the tool | payload | kg/kJ |", "|" + "---|" * 9]
    for dig in group:
        words = [path_text(dig.run)]
        for values in (dig.judge, dig.ours):
            words += [f"{values['drag_start_n'] / 1e3:.1f} … {values['drag_end_n'] / 1e3:.1f}",
                      f"{values['tool_work_j'] / 1e3:.2f}", f"{values['payload_kg']:.0f}",
                      f"{per_work(values):.1f}"]
        lines.append("| " + " | ".join(words) + " |")
    if len(group) < 3:
        return "\n".join(lines)
    lines.append("")
    rank = lambda side, energy: spearman(
        [per_work(dig.judge, energy) for dig in group],
        [per_work(getattr(dig, side), energy) for dig in group])
    lines.append(f"Spearman's rank correlation of kg per kJ over {len(group)} paths, judge against "
                 f"excavplan: {rank('ours', 'tool_work_j'):.2f} by work of the tool and "
                 f"{rank('ours', 'machine_work_j'):.2f} by energy of the joints at peak friction; "
                 f"{rank('critical', 'tool_work_j'):.2f} and "
                 f"{rank('critical', 'machine_work_j'):.2f} at critical friction.")
    return "\n".join(lines)


# ---- Picture ----------------------------------------------------------------------------------

# Okabe and Ito's colours, frame, grid and texts as in src/drawing.
LIGHT, GREY, BLUE, RED = "#56b4e9", "#777777", "#0072b2", "#d55e00"
FRAME, GRID = "#444444", "#e4e4e4"


def colour_of(dig):
    size = round(dig.run.radius * 1000)
    return LIGHT if size > 30 else GREY if size == 30 else BLUE


def smooth(rows, width=5):
    """Running mean, so that single grains do not hide the course."""
    values = [row[2] for row in rows]
    return [(row[1], statistics.fmean(values[max(0, i - width // 2):i + width // 2 + 1]))
            for i, row in enumerate(rows)]


class Panel:
    """Axes at (left, top) of the picture."""

    def __init__(self, place, title, axes, limits):
        self.left, self.top, self.wide, self.high = *place, 230, 190
        self.x, self.y = limits
        self.parts = [f'<text x="{self.left}" y="{self.top - 10}" font-weight="bold">{title}'
                      '</text>']
        for i in range(6):
            x, y = (a + (b - a) * i / 5 for a, b in (self.x, self.y))
            if 0 < i < 5:
                self.line([(self.x[0], y), (self.x[1], y)], GRID, "", 0.7)
            self.tick(self.at(x, self.y[0]), (0, 4))
            self.tick(self.at(self.x[0], y), (-4, 0))
            self.text(self.at(x, self.y[0]), (0, 17), f"{x:.3g}", "middle")
            self.text(self.at(self.x[0], y), (-7, 4), f"{y:.3g}", "end")
        self.parts.append(f'<rect x="{self.left}" y="{self.top}" width="{self.wide}" '
                          f'height="{self.high}" fill="none" stroke="{FRAME}" stroke-width="0.7"/>')
        self.text((self.left + self.wide / 2, self.top + self.high), (0, 35), axes[0], "middle")
        x, y = self.left - 36, self.top + self.high / 2
        self.parts.append(f'<text transform="translate({x},{y}) rotate(-90)" '
                          f'text-anchor="middle">{axes[1]}</text>')

    def tick(self, place, shift):
        self.parts.append(f'<path d="M{place[0]:.1f} {place[1]:.1f}l{shift[0]} {shift[1]}" '
                          f'stroke="{FRAME}" stroke-width="0.7"/>')

    def at(self, x, y):
        across, up = (x - self.x[0]) / (self.x[1] - self.x[0]), (y - self.y[0]) / (
            self.y[1] - self.y[0])
        return self.left + self.wide * across, self.top + self.high * (1 - up)

    def text(self, place, shift, words, anchor):
        self.parts.append(f'<text x="{place[0] + shift[0]:.1f}" y="{place[1] + shift[1]:.1f}" '
                          f'text-anchor="{anchor}">{words}</text>')

    def line(self, points, colour, dash="", width=1.8):
        where = " ".join("{:.1f},{:.1f}".format(*self.at(*point)) for point in points)
        self.parts.append(f'<polyline points="{where}" fill="none" stroke="{colour}" '
                          f'stroke-width="{width}" stroke-dasharray="{dash}"/>')

    def dot(self, point, colour, label, to_left=False):
        x, y = self.at(*point)
        self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{colour}"/>')
        self.text((x, y), (-7 if to_left else 7, 4), label, "end" if to_left else "start")


def reference(group):
    return next(dig for dig in group if dig.run.radius == runs.Run.radius)


def forces(panel, group):
    for dig in group:
        drag = [row for row in dig.rows if row[0] == "drag"]
        panel.line([(s - drag[0][1], f / 1e3) for s, f in smooth(drag)], colour_of(dig))
    first = reference(group)
    for rows, dash in ((first.our_rows, ""), (first.critical_rows, "6 4")):
        drag = [row for row in rows if row[0] == "drag"]
        panel.line([(row[1] - drag[0][1], row[2] / 1e3) for row in drag], RED, dash, 2.4)


def fill(panel, group):
    for dig in group:
        length = dig.run.path[2]
        begin = dig.run.start - dig.run.path[1] * math.cos(dig.run.path[0])
        panel.line([(begin - x, kg) for phase, x, kg in dig.found["cavity"] if phase == "drag"
                    and begin - x <= length], colour_of(dig))
    drag = [row for row in reference(group).our_fill if row[0] == "drag"]
    panel.line([(s - drag[0][1], kg) for _, s, kg in drag], RED, "", 2.4)


def top(value, step):
    return step * math.ceil(value / step)


def equality(panel):
    """Where both say the same."""
    panel.line([(panel.x[0], panel.x[0]), (panel.x[1], panel.x[1])], GREY, "1.5 3", 1.4)


def ten_panel(place, ten):
    pairs = [(per_work(dig.judge), per_work(dig.ours)) for dig in ten]
    limit = (0, top(1.1 * max(max(pair) for pair in pairs), 10))
    panel = Panel(place, "Ten paths, payload per work",
                  ("judge [kg/kJ]", "excavplan [kg/kJ]"), (limit, limit))
    equality(panel)
    for dig, pair in zip(ten, pairs):
        crowded = any(0 < pair[1] - other[1] < 4 and abs(other[0] - pair[0]) < 3
                      for other in pairs)
        panel.dot(pair, RED, dig.name[-2:].lstrip("0"), crowded)
    return panel


def legend(y):
    key = [(LIGHT, "", "judge, 35 and 40 mm"), (GREY, "", "judge, 30 mm"),
           (BLUE, "", "judge, 20 and 25 mm"), (RED, "", "excavplan, peak friction"),
           (RED, "6 4", "excavplan, critical friction"), (GREY, "1.5 3", "equality")]
    parts = []
    for i, (colour, dash, words) in enumerate(key):
        x, line = 30 + 200 * (i % 3), y + 20 * (i // 3)
        parts.append(f'<line x1="{x}" x2="{x + 22}" y1="{line}" y2="{line}" stroke="{colour}" '
                     f'stroke-width="2" stroke-dasharray="{dash}"/>'
                     f'<text x="{x + 28}" y="{line + 4}">{words}</text>')
    return parts


def picture(done):
    fixed, longs = (list(named(done, start).values()) for start in ("fixed-", "long"))
    ten = [dig for name, dig in done.items() if name.startswith("ten-")]
    force, drag = "drag force [kN]", "drag [m]"
    panels = [Panel((56, 34), "Fixed path", (drag, force), ((0, 1.5), (0, 10))),
              Panel((366, 34), "Fixed path", (drag, "soil in the bucket [kg]"),
                    ((0, 1.5), (0, 300)))]
    forces(panels[0], fixed)
    fill(panels[1], fixed)
    if longs:
        panels.append(Panel((56, 306), "Long shallow path", (drag, force), ((0, 3), (0, 5))))
        forces(panels[-1], longs)
    if ten:
        panels.append(ten_panel((366, 306), ten))
    parts = [part for panel in panels for part in panel.parts] + legend(560)
    return ('<svg xmlns="http://www.w3.org/2000/svg" width="620" height="596" '
            'font-family="sans-serif" font-size="12" fill="#222222">'
            '<title>Digs in discrete elements and in excavplan</title>'
            '<rect width="620" height="596" fill="#ffffff"/>' + "\n".join(parts) + "</svg>\n")
