# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Machine, bucket mesh and motion of a dig, from excavplan's files and programs.

Frames and signs are those of docs/formats.md: x forward, z up, joint angles positive down and in.
A pose is (pin, angle): bucket pin as complex x + iz [m], direction from pin to tip, turned
clockwise from +x [rad].
"""
import cmath
import csv
import io
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
JOINTS = ("boom", "arm", "bucket")


def program(name):
    path = Path(os.environ.get("EXCAVPLAN_BIN", ROOT / "build/bin")) / name
    if not path.exists():
        sys.exit(f"judge: {path} is missing; build it first, or name its folder in EXCAVPLAN_BIN")
    return str(path)


# ---- Machine ----------------------------------------------------------------------------------


class Machine:
    """A machine file whose bucket is bare: no teeth, all plates as thin as the format allows."""

    def __init__(self, name="zx120"):
        self.data = json.loads((ROOT / f"data/machines/{name}.json").read_text())
        geometry, bucket = self.data["geometry"], self.data["bucket"]
        bucket.pop("teeth", None)
        bucket.update(edge_thickness_m=0.001, width_inside_m=bucket["width_outside_m"])
        self.boom_pin = complex(*geometry["boom_pin_m"])
        self.lengths = [geometry[joint + "_length_m"] for joint in JOINTS]
        self.profile = [complex(p["along_m"], p["across_m"]) for p in bucket["profile"]]
        self.half_width = bucket["width_outside_m"] / 2

    def pins(self, joints):
        """Pins of boom, arm and bucket, and the directions of the three links."""
        pins, directions, angle = [self.boom_pin], [], 0.0
        for q, length in zip(joints, self.lengths):
            angle += q
            directions.append(angle)
            pins.append(pins[-1] + length * cmath.exp(-1j * angle))
        return pins[:3], directions

    def pose(self, joints):
        pins, directions = self.pins(joints)
        return pins[2], directions[2]

    def links_energy(self, joints):
        """Potential energy of the links [J]."""
        pins, directions = self.pins(joints)
        total = 0.0
        for joint, pin, angle in zip(JOINTS, pins, directions):
            link = self.data["links"][joint]
            center = complex(link["center_along_m"], link["center_across_m"])
            total += link["mass_kg"] * 9.81 * (pin + center * cmath.exp(-1j * angle)).imag
        return total

    def works(self, one, two, force, torque):
        """Work of the joints from joint angles one to two, against the links' weight and against a
        force (x + iz) and a torque about y at the bucket's pin: of each joint [J]."""
        middle = [(a + b) / 2 for a, b in zip(one, two)]
        pins, _ = self.pins(middle)
        found = []
        for i, pin in enumerate(pins):
            arm, turn = pins[2] - pin, two[i] - one[i]
            moment = torque + arm.imag * force.real - arm.real * force.imag
            ends = [middle[:i] + [middle[i] + turn * half] + middle[i + 1:] for half in (-0.5, 0.5)]
            found.append(self.links_energy(ends[1]) - self.links_energy(ends[0]) - moment * turn)
        return found


def place(point, pose):
    """A point of the bucket (along + i across) in the site frame."""
    pin, angle = pose
    return pin + point * cmath.exp(-1j * angle)


def into_bucket(point, pose):
    pin, angle = pose
    return (point - pin) * cmath.exp(1j * angle)


# ---- Bucket as a mesh -------------------------------------------------------------------------


def split(a, b, size):
    count = max(1, math.ceil(abs(b - a) / size))
    return [a + (b - a) * i / count for i in range(count)]


def band(line, near, far):
    """Triangles between a polygon line at y = near and the same at y = far."""
    triangles = []
    for a, b in zip(line, line[1:]):
        corners = [(a, near), (b, near), (b, far), (a, far)]
        triangles += [(corners[0], corners[1], corners[2]), (corners[0], corners[2], corners[3])]
    return triangles


def fan(line, y):
    center = sum(line) / len(line)
    return [((center, y), (a, y), (b, y)) for a, b in zip(line, line[1:] + line[:1])]


def plates(machine, size=0.12):
    """Half of the bucket by its plane of symmetry y = 0, its plates without thickness: triangles of
    (point, y)."""
    profile, half = machine.profile, machine.half_width
    floor = split(profile[0], profile[1], size) + [profile[1]]
    back = []
    for a, b in zip(profile[1:], profile[2:]):
        back += split(a, b, size)
    back.append(profile[-1])
    outline = floor[:-1] + back[:-1] + split(profile[-1], profile[0], size)
    strips = [i * half / 3 for i in range(4)]
    across = lambda line: [t for a, b in zip(strips, strips[1:]) for t in band(line, a, b)]
    return {"floor": across(floor), "back": across(back), "side": fan(outline, half)}


def stl(triangles, pose):
    lines = ["solid plate"]
    for triangle in triangles:
        lines += ["facet normal 0 0 0", "outer loop"]
        for point, y in triangle:
            at = place(point, pose)
            lines.append(f"vertex {at.real:.6f} {y:.6f} {at.imag:.6f}")
        lines += ["endloop", "endfacet"]
    return "\n".join(lines + ["endsolid plate", ""])


def in_cavity(point, profile):
    """Whether a point of the bucket is in the convex polygon of the profile, mouth closed."""
    inside = True
    for a, b in zip(profile, profile[1:] + profile[:1]):
        inside = inside and ((b - a).conjugate() * (point - a)).imag >= 0
    return inside


# ---- Motion -----------------------------------------------------------------------------------


def simulate(path, start, machine, soil, density):
    """Result and force history of simulate-dig, and points of the ground it leaves; soil: a soil
    file's content."""
    with tempfile.TemporaryDirectory() as folder:
        history, after, machine_file, soil_file = (
            Path(folder) / name
            for name in ("history.csv", "after.xyz", "machine.json", "soil.json"))
        machine_file.write_text(json.dumps(machine.data))
        soil_file.write_text(json.dumps(soil))
        words = [program("simulate-dig"), "--density", str(density), "--start", str(start)]
        words += ["--path", ",".join(f"{value:.6f}" for value in path), "--json", "--quiet"]
        words += ["--machine", str(machine_file), "--soil", str(soil_file)]
        words += ["--history", str(history), "--after", str(after), "--noise", "0"]
        done = subprocess.run(words, capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"judge: {' '.join(words)}: {done.stderr}")
        rows = list(csv.DictReader(io.StringIO(history.read_text())))
        points = [tuple(map(float, line.split())) for line in after.read_text().splitlines()[1:]]
    rows = [{k: v if k == "phase" else float(v) for k, v in row.items()} for row in rows]
    return json.loads(done.stdout), rows, points


def region(path, start, half_width, x, y):
    """Where a point of the ground is from the cut."""
    angle, penetration, drag = path
    if x < start - penetration * math.cos(angle) - drag:
        return "ahead"
    return "behind" if x > start else "beside" if abs(y) > half_width else "in_the_cut"


REGIONS = ("ahead", "beside", "behind", "in_the_cut")


def bounds(rows):
    """Joint angles at both ends of every step of a history, whose rows are midpoints."""
    joints = [[row[joint + "_rad"] for joint in JOINTS] for row in rows]
    mean = lambda a, b: [(p + q) / 2 for p, q in zip(a, b)]
    beyond = lambda a, b: [p + (p - q) / 2 for p, q in zip(a, b)]
    ends = []
    for i, row in enumerate(rows):
        first = i == 0 or rows[i - 1]["phase"] != row["phase"]
        last = i + 1 == len(rows) or rows[i + 1]["phase"] != row["phase"]
        one = beyond(joints[i], joints[i + 1]) if first else mean(joints[i - 1], joints[i])
        two = beyond(joints[i], joints[i - 1]) if last else mean(joints[i], joints[i + 1])
        ends.append((one, two))
    return ends


class Step:
    """A rigid motion from one pose to another at constant speed of the tip, in whole blocks of
    time steps: a turn about a fixed pole, or a translation."""

    def __init__(self, machine, one, two, block, speed):
        self.one, self.two = one, two
        tips = [place(complex(machine.lengths[2], 0), pose) for pose in (one, two)]
        self.blocks = max(1, round(abs(tips[1] - tips[0]) / speed / block))
        self.time = self.blocks * block
        turn = two[1] - one[1]
        self.rate = turn / self.time if abs(turn) > 1e-7 else 0.0
        self.velocity = (two[0] - one[0]) / self.time if not self.rate else 0.0
        if self.rate:
            rotation = cmath.exp(-1j * turn)
            self.pole = (two[0] - rotation * one[0]) / (1 - rotation)

    def pose(self, time):
        if not self.rate:
            return self.one[0] + self.velocity * time, self.one[1]
        turned = self.pole + (self.one[0] - self.pole) * cmath.exp(-1j * self.rate * time)
        return turned, self.one[1] + self.rate * time

    def command(self):
        if not self.rate:
            return f"linear {self.velocity.real:.9g} 0 {self.velocity.imag:.9g}"
        return (f"rotate origin {self.pole.real:.9g} 0 {self.pole.imag:.9g} axis 0 "
                f"{math.copysign(1, self.rate):.0f} 0 period {2 * math.pi / abs(self.rate):.9g}")


def motion(machine, rows, block, speed):
    """Approach, one step for each row of the history, lift, and rest, as (phase, Step)."""
    poses = [(machine.pose(a), machine.pose(b)) for a, b in bounds(rows)]
    steps = [(row["phase"], *pose) for row, pose in zip(rows, poses)]
    into = steps[0][2][0] - steps[0][1][0]
    back = steps[0][1][0] - 0.15 * into / abs(into), steps[0][1][1]
    last = steps[-1][2]
    lowest = min(place(corner, last).imag for corner in machine.profile)
    up = last[0] + 1j * (max(LIFTED, lowest + 0.1) - lowest), last[1]
    steps = [("approach", back, steps[0][1])] + steps + [("lift", last, up)]
    return [(phase, Step(machine, a, b, block, speed)) for phase, a, b in steps]


LIFTED = 0.55  # lowest point of the bucket above the ground after the lift [m]
