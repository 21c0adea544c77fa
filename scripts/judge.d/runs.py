# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""The runs: what they are, their computation, and their results."""
import fnmatch
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import deck
import scene

ROOT = scene.ROOT
RESULTS, WORK = ROOT / "docs/judge", ROOT / "build/judge"
PIECES = 0.1  # cells of the map of what is left [m]


@dataclass(frozen=True)
class Run:
    kind: str = "dig"  # or press, drain
    path: tuple = (math.radians(45), 0.35, 1.5)  # penetration angle, penetration, drag
    start: float = 6.05  # x of the tip where it enters the ground [m]
    radius: float = 0.03  # mean of the grains [m]
    friction: float = 0.6  # between grains
    cohesion: float = 0  # energy density of contacts [J/m^3]
    seed: int = 1  # of the packing
    speed: float = 0.6  # of the tip [m/s]
    margins: tuple = (1.4, 0.3, 0.7, 0.25)  # of the ground: ahead, behind, beside and below [m]
    packed: bool = True  # filled at low friction, as dense as the soil of the digs


def path(degrees, penetration, drag, start):
    return dict(path=(math.radians(degrees), penetration, drag), start=start)


# Ten paths, chosen before any of them was computed: spread over the angles, lengths and drags that
# can be driven; start points as simulate-dig chose them in sand, rounded to 5 cm.
TEN = [
    path(35, 0.20, 0.5, 5.45), path(35, 0.35, 1.5, 5.95), path(40, 0.10, 1.5, 5.80),
    path(40, 0.50, 1.0, 5.95), path(50, 0.20, 3.0, 6.55), path(50, 0.45, 0.8, 5.95),
    path(60, 0.25, 1.0, 6.05), path(60, 0.10, 2.0, 6.35), path(60, 0.40, 2.5, 6.60),
    path(70, 0.20, 0.5, 6.30),
]
LONG = path(50, 0.1958, 2.92, 6.5)  # 0.15 m deep
STICKY = 100e3

RUNS = {f"fixed-{name}": Run(seed=seed) for seed, name in enumerate("abc", 1)}
RUNS["narrow"] = Run(margins=(1.15, 0.3, 0.4, 0.25))
RUNS["slow"] = Run(speed=0.3)
RUNS["long"] = Run(**LONG)
RUNS.update({f"ten-{i:02d}": Run(**dig) for i, dig in enumerate(TEN, 1)})
RUNS["smooth"] = Run(friction=0.3)
RUNS.update({f"fixed-{size}": Run(radius=size / 1000) for size in (40, 35, 25, 20)})
RUNS.update({f"long-{size}": Run(radius=size / 1000, **LONG) for size in (25, 20)})
RUNS["sticky"] = Run(cohesion=STICKY)
for mark, grains in (("", {}), ("-smooth", dict(friction=0.3)), ("-sticky", dict(cohesion=STICKY))):
    RUNS["press" + mark] = Run(kind="press", **grains)
    RUNS["loose" + mark] = Run(kind="press", packed=False, **grains)
    RUNS["drain" + mark] = Run(kind="drain", packed=False, **grains)


def names(patterns):
    found = []
    for pattern in patterns:
        matches = fnmatch.filter(RUNS, pattern)
        if not matches:
            sys.exit(f"judge: there is no run {pattern}; see --list")
        found += [name for name in matches if name not in found]
    return found


def result(name):
    file = RESULTS / f"{name}.json"
    return json.loads(file.read_text()) if file.exists() else None


def show():
    for name, run in RUNS.items():
        what = run.kind
        if what == "dig":
            what = f"{math.degrees(run.path[0]):.0f} deg {run.path[1]:g} m {run.path[2]:g} m"
        cohesion = f", {run.cohesion / 1000:g} kJ/m3" if run.cohesion else ""
        done = result(name)
        state = f"done, {done['grains']} grains" if done else "-"
        print(f"{name:14} {what:22} {run.radius * 1000:g} mm, friction {run.friction:g}{cohesion}, "
              f"packing {run.seed}: {state}")


# ---- Computing --------------------------------------------------------------------------------


def compute(name):
    if result(name):
        return
    if not shutil.which("liggghts"):
        with tempfile.NamedTemporaryFile("w", suffix=".txt") as packages:
            packages.write("liggghts\n")
            packages.flush()
            subprocess.run([ROOT / "scripts/install-packages", packages.name], check=True)
    run, folder = RUNS[name], WORK / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    began = time.monotonic()
    found = {"dig": dig, "press": press, "drain": drain}[run.kind](run, folder)
    found = {"format": "excavplan-judge", "run": name, **described(run), **found}
    RESULTS.mkdir(exist_ok=True)
    part = RESULTS / f"{name}.json.part0"
    part.write_text(text_of(found))
    part.rename(RESULTS / f"{name}.json")
    shutil.rmtree(folder)
    print(f"{name}: {round(time.monotonic() - began)} s", flush=True)


def described(run):
    about = {"kind": run.kind}
    if run.kind == "dig":
        about.update(path=[round(v, 6) for v in run.path], start_x_m=run.start,
                     speed_m_per_s=run.speed, margins_m=run.margins)
    return {**about, "radius_m": run.radius, "friction": run.friction,
            "cohesion_j_per_m3": run.cohesion, "packing": run.seed, "packed": run.packed}


def text_of(found):
    """JSON with one line for each key, and for each row of a table."""
    lines = []
    for key, value in found.items():
        if isinstance(value, list) and value and isinstance(value[0], list):
            rows = ",\n  ".join(json.dumps(row) for row in value)
            lines.append(f'"{key}": [\n  {rows}]')
        else:
            lines.append(f'"{key}": {json.dumps(value)}')
    return "{" + ",\n ".join(lines) + "}\n"


def liggghts(folder, text):
    (folder / "in.txt").write_text(text)
    with open(folder / "log.txt", "w") as log:
        words = ["nice", "-n", "15", "liggghts", "-in", "in.txt", "-log", "none"]
        done = subprocess.run(words, cwd=folder, stdout=log, stderr=subprocess.STDOUT,
                              env=dict(os.environ, OMP_NUM_THREADS="1",
                                       OMPI_ALLOW_RUN_AS_ROOT="1",
                                       OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1"))
    if done.returncode:
        tail = "".join(open(folder / "log.txt").readlines()[-6:])
        sys.exit(f"judge: liggghts failed in {folder}:\n{tail}")


def frames(file):
    """Time step and rows of numbers of each frame of a dump."""
    with open(file) as lines:
        for line in lines:
            if line.startswith("ITEM: TIMESTEP"):
                step = int(next(lines))
            elif line.startswith("ITEM: NUMBER"):
                count = int(next(lines))
            elif line.startswith("ITEM: ATOMS"):
                yield step, [tuple(map(float, next(lines).split())) for _ in range(count)]


def mass(radius):
    return deck.DENSITY * 4 / 3 * math.pi * radius**3


def bulk_density(grains, x, y, z):
    """Of the grains whose centres are in a box [kg/m^3]."""
    volume = (x[1] - x[0]) * (y[1] - y[0]) * (z[1] - z[0])
    return sum(mass(g[4]) for g in grains
               if x[0] < g[1] < x[1] and y[0] < g[2] < y[1] and z[0] < g[3] < z[1]) / volume


def last_frame(file):
    return list(frames(file))[-1][1]


# ---- Digs -------------------------------------------------------------------------------------


def box_of(run):
    """x range, half width and depth of the ground."""
    angle, penetration, drag = run.path
    deep = penetration * math.sin(angle)
    end = run.start - penetration * math.cos(angle) - drag
    ahead, behind, beside, below = run.margins
    return (end - ahead, run.start + behind), 0.35 + beside, deep + below


def dig(run, folder):
    machine = scene.Machine()
    # The path does not depend on the soil, as long as no joint stalls.
    soil = json.loads((ROOT / "data/soils/sand.json").read_text())
    _, rows, _ = scene.simulate(run.path, run.start, machine, soil, 0)
    block = deck.EVERY * deck.STEP * run.radius
    motion = scene.motion(machine, rows, block, run.speed)
    first = motion[0][1].one
    for plate, triangles in scene.plates(machine).items():
        (folder / f"{plate}.stl").write_text(scene.stl(triangles, first))
    box = box_of(run)
    corners = [scene.place(p, pose) for _, step in motion for pose in (step.one, step.two)
               for p in machine.profile]
    xs, top = [c.real for c in corners], max(c.imag for c in corners)
    domain = ((min(xs + [box[0][0]]) - 0.3, max(xs + [box[0][1]]) + 0.3), (-0.2, box[1] + 0.1),
              (-box[2] - 0.1, max(top + 0.3, 2.5)))
    liggghts(folder, deck.dig(run, motion, box, domain, first[0]))
    return digest(run, machine, rows, motion, box, folder)


def digest(run, machine, rows, motion, box, folder):
    before, after = last_frame(folder / "before.txt"), last_frame(folder / "after.txt")
    forces = read_forces(folder / "forces.txt")
    table, at, ends = [], motion[0][1].blocks, scene.bounds(rows)
    for (phase, step), row, (one, two) in zip(motion[1:-1], rows, ends):
        mean = means(forces[at:at + step.blocks])
        at += step.blocks
        force, torque = complex(*mean[:2]), mean[2]
        joints = machine.works(one, two, force, torque)
        tool = sum(joints) - machine.links_energy(two) + machine.links_energy(one)
        machine_work = sum(max(0, work) for work in joints)
        table.append([phase, round(row["travelled_m"], 4), *mean, round(tool, 2),
                      round(machine_work, 2)])
    last = motion[-1][1].two
    lowest = min(scene.place(p, last).imag for p in machine.profile)
    half = machine.half_width
    lifted = sum(mass(g[4]) for g in after if g[3] > lowest - g[4] and g[2] < half)
    (x0, x1), width, depth = box
    middle = ((x0 + 0.2, x1 - 0.2), (0.1, width - 0.1), (-depth + 0.1, -0.06))
    return {
        "grains": len(before),
        "bulk_density_kg_per_m3": round(bulk_density(before, *middle), 1),
        "payload_kg": round(2 * lifted, 2),
        "above_ground_kg": spoil(run, after, lowest, half),
        "columns": ["phase", "travelled_m", "x_n", "z_n", "torque_at_pin_n_m", "floor_x_n",
                    "back_x_n", "side_x_n", "tool_work_j", "machine_work_j"],
        "forces": table,
        "cavity": cavity(machine, motion, folder, deck.STEP * run.radius),
        "map_cell_m": PIECES,
        "map_origin_m": [round(x0, 4), 0.0],
        "map_mm": height_change(before, [g for g in after if g[3] <= lowest - g[4]], box),
    }


def read_forces(file):
    with open(file) as lines:
        return [list(map(float, line.split()[1:])) for line in lines if not line.startswith("#")]


def means(window):
    """Of both halves: force x and z, torque about y, and force x of floor, back and side."""
    mean = [2 * sum(column) / len(window) for column in zip(*window)]
    total = [sum(mean[i::3]) for i in range(3)]
    return [round(v, 1) for v in total + mean[0::3]]


def cavity(machine, motion, folder, step_time):
    """Soil inside the profile, mouth closed, along the dig: [phase, x of the tip, kg]."""
    found, begins, at = [], [], 0
    for phase, step in motion:
        begins.append((at, phase, step))
        at += step.blocks * deck.EVERY
    for count, grains in frames(folder / "grains.txt"):
        began, phase, step = [b for b in begins if b[0] <= count][-1]
        pose = step.pose(min((count - began) * step_time, step.time))
        inside = sum(mass(g[3]) for g in grains if g[1] < machine.half_width and
                     scene.in_cavity(scene.into_bucket(complex(g[0], g[2]), pose),
                                     machine.profile))
        tip = scene.place(complex(machine.lengths[2], 0), pose)
        found.append([phase, round(tip.real, 3), round(2 * inside, 1)])
    return found


def spoil(run, after, lowest, half):
    """Soil above the level of the ground that is not in the bucket [kg]."""
    left = dict.fromkeys(scene.REGIONS, 0.0)
    for g in after:
        if 0 < g[3] <= lowest - g[4]:
            left[scene.region(run.path, run.start, half, g[1], g[2])] += 2 * mass(g[4])
    return {name: round(value, 1) for name, value in left.items()}


def height_change(before, after, box):
    """Change of the highest grain's top in cells, rows from the plane of symmetry outwards [mm]."""
    (x0, x1), width, depth = box
    columns, rows = math.ceil((x1 - x0) / PIECES), math.ceil(width / PIECES)

    def tops(grains):
        heights = [[-depth] * columns for _ in range(rows)]
        for g in grains:
            i, j = int((g[1] - x0) / PIECES), int(g[2] / PIECES)
            if 0 <= i < columns and 0 <= j < rows:
                heights[j][i] = max(heights[j][i], g[3] + g[4])
        return heights

    one, two = tops(before), tops(after)
    return [[round(1000 * (b - a)) for a, b in zip(p, q)] for p, q in zip(one, two)]


# ---- Tests of the soil ------------------------------------------------------------------------


def press(run, folder):
    size = (20 * run.radius, 12 * run.radius, 30 * run.radius)
    pressure, speed, strain = 2e3, 0.03, 0.25
    text, meshes = deck.press(run, size, pressure, speed, strain)
    for name, mesh in meshes.items():
        (folder / f"{name}.stl").write_text(mesh)
    liggghts(folder, text)
    before, table = last_frame(folder / "before.txt"), []
    window, tall = 10 * deck.EVERY * deck.STEP * run.radius, size[2] + deck.SIZES[-1] * run.radius
    rows = read_forces(folder / "forces.txt")
    for i in range(0, len(rows) - 9, 10):
        down, out, length = (sum(column) / 10 for column in zip(*rows[i:i + 10]))
        height = tall - speed * (i + 5) * window
        table.append([round(1 - height / tall, 4), round(down / (length * size[1])),
                      round(out / (height * size[1])),
                      round(length * height / size[0] / tall - 1, 4)])
    angles = [math.degrees(math.asin((a - b) / (a + b))) for _, a, b, _ in table[1:]]
    late = [a for a, row in zip(angles, table[1:]) if row[0] > strain - 0.05]
    return {"grains": len(before),
            "bulk_density_kg_per_m3": round(bulk_density(
                before, (0.1, size[0] - 0.1), (0.1, size[1] - 0.1), (-size[2] + 0.1, -0.06)), 1),
            "pressure_pa": pressure,
            "peak_friction_deg": round(max(angles), 2),
            "last_friction_deg": round(sum(late) / len(late), 2),
            "columns": ["strain", "vertical_pa", "horizontal_pa", "volume_strain"],
            "stresses": table}


def drain(run, folder):
    size = (60 * run.radius, 10 * run.radius, 20 * run.radius)
    liggghts(folder, deck.drain(run, size, 8.0))
    before, after = last_frame(folder / "before.txt"), last_frame(folder / "after.txt")
    tops = {}
    for g in after:
        i = int(g[1] / run.radius / 2)
        tops[i] = max(tops.get(i, -9), g[3] + g[4])
    # The middle of the slope: neither its foot nor its crest.
    points = [((i + 0.5) * 2 * run.radius, z) for i, z in sorted(tops.items())
              if -0.85 * size[2] < z < -0.15 * size[2]]
    n, sx, sz = len(points), sum(p[0] for p in points), sum(p[1] for p in points)
    sxx, sxz = sum(p[0] ** 2 for p in points), sum(p[0] * p[1] for p in points)
    slope = (n * sxz - sx * sz) / (n * sxx - sx * sx)
    return {"grains": len(before),
            "bulk_density_kg_per_m3": round(bulk_density(
                before, (0.1, size[0] - 0.1), (0, size[1]), (-size[2] + 0.1, -0.06)), 1),
            "repose_deg": round(math.degrees(math.atan(-slope)), 2),
            "points": n}
