# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Input for LIGGGHTS: grains, their packing, digs and tests of the soil."""
import math
import random

# Grains. What is not said here is in docs/judge.md.
DENSITY, YOUNG, POISSON, RESTITUTION = 2650, 5e6, 0.3, 0.3
ROLLING, WALL, FILLING = 0.12, 0.43, 0.05  # friction of rolling, on steel, while the box is filled
SIZES = (0.88, 0.94, 1.0, 1.06, 1.12)  # of the radius, equally many of each
STEP = 0.01  # time step per radius [s/m]: 0.3 ms at 30 mm
EVERY = 10  # time steps in a block; forces are means over blocks
MODEL = "hertz tangential history"
GRAIN, STEEL, MIRROR, BOX = 1, 2, 3, 4


def contact(cohesion):
    return MODEL + (" cohesion sjkr2" if cohesion else "") + " rolling_friction epsd2"


def prime(number):
    while any(number % i == 0 for i in range(2, math.isqrt(number) + 1)):
        number += 1
    return number


def materials(friction, cohesion):
    """Properties by pairs of types; repeated where friction changes."""
    types = range(1, 5)

    def pairs(value):
        return " ".join(str(value(min(i, j), max(i, j))) for i in types for j in types)

    sliding = {STEEL: min(WALL, friction), MIRROR: 0, BOX: friction, GRAIN: friction}
    lines = [
        f"fix m1 all property/global youngsModulus peratomtype {' '.join([str(YOUNG)] * 4)}",
        f"fix m2 all property/global poissonsRatio peratomtype {' '.join([str(POISSON)] * 4)}",
        "fix m3 all property/global coefficientRestitution peratomtypepair 4 "
        + pairs(lambda i, j: RESTITUTION),
        "fix m4 all property/global coefficientFriction peratomtypepair 4 "
        + pairs(lambda i, j: sliding[j]),
        "fix m5 all property/global coefficientRollingFriction peratomtypepair 4 "
        + pairs(lambda i, j: 0 if MIRROR in (i, j) else ROLLING),
    ]
    if cohesion:
        lines.append("fix m6 all property/global cohesionEnergyDensity peratomtypepair 4 "
                     + pairs(lambda i, j: cohesion if i == j == GRAIN else 0))
    return lines


def walls(cohesion, planes):
    return [f"fix w{i} all wall/gran model {contact(cohesion)} primitive type {kind} {axis}plane "
            f"{at:.6g}" for i, (axis, at, kind) in enumerate(planes)]


def start(run, domain, periodic="f f f"):
    """Everything before the grains."""
    x, y, z = domain
    return [
        "atom_style granular", "atom_modify map array", f"boundary {periodic}", "newton off",
        "communicate single vel yes", "units si",
        f"region domain block {x[0]:.6g} {x[1]:.6g} {y[0]:.6g} {y[1]:.6g} {z[0]:.6g} {z[1]:.6g} "
        "units box",
        "create_box 4 domain", f"neighbor {run.radius / 2:.6g} bin", "neigh_modify delay 0",
        *materials(FILLING if run.packed else run.friction, run.cohesion),
        f"pair_style gran model {contact(run.cohesion)}", "pair_coeff * *",
        f"timestep {STEP * run.radius:.6g}", "fix gravity all gravity 9.81 vector 0 0 -1",
    ]


def fill(run, x, y, floor, depth):
    """Grains rained into a box and settled, more than depth of them."""
    chance = random.Random(run.seed)
    seeds = [prime(chance.randrange(20000, 900000)) for _ in range(len(SIZES) + 2)]
    # A third of the volume is as dense as spheres drop at random without touching.
    top = floor + 2.1 * (depth + 2.5 * run.radius)
    lines = [f"fix t{i} all particletemplate/sphere {seeds[i]} atom_type {GRAIN} density constant "
             f"{DENSITY} radius constant {run.radius * size:.6g}" for i, size in enumerate(SIZES)]
    shares = " ".join(f"t{i} {1 / len(SIZES):.6g}" for i in range(len(SIZES)))
    lines += [
        f"fix sizes all particledistribution/discrete/numberbased {seeds[-2]} {len(SIZES)} "
        + shares,
        f"region fill block {x[0]:.6g} {x[1]:.6g} {y[0]:.6g} {y[1]:.6g} {floor:.6g} {top:.6g} "
        "units box",
        f"fix rain all insert/pack seed {seeds[-1]} distributiontemplate sizes maxattempt 300 "
        "insert_every once overlapcheck yes all_in yes vel constant 0 0 -1 region fill "
        "volumefraction_region 0.33",
        "fix move all nve/sphere", "thermo_style custom step atoms ke cpu", "thermo 1000",
        "thermo_modify lost ignore norm no", "run 1", "unfix rain",
        f"run {blocks(run, 1.3)}",
    ]
    return lines


def blocks(run, seconds):
    """Time steps of so much time, in whole blocks."""
    return EVERY * round(seconds / (EVERY * STEP * run.radius))


def level(run):
    """Takes off what is above z = 0 and gives the grains their friction."""
    return ["region above block INF INF INF INF 0 INF units box", "delete_atoms region above",
            *(materials(run.friction, run.cohesion) if run.packed else []),
            f"run {blocks(run, 0.3)}"]


def snapshot(name):
    return [f"dump {name} all custom 1 {name}.txt id x y z radius vx", "run 1", f"undump {name}"]


def deck(lines):
    return "\n".join(lines) + "\n"


# ---- A dig ------------------------------------------------------------------------------------


def dig(run, motion, box, domain, pin):
    """The dig of a bucket whose plates are in floor.stl, back.stl and side.stl.

    motion: (phase, Step) in order; box: x range, half width and depth of the ground; pin: of the
    bucket at first, to which the torques refer. Writes forces.txt and snapshots of the grains."""
    x, half, depth = box
    planes = [("x", x[0], BOX), ("x", x[1], BOX), ("y", 0, MIRROR), ("y", half, BOX),
              ("z", -depth, BOX)]
    lines = start(run, domain) + walls(run.cohesion, planes)
    lines += fill(run, x, (0, half), -depth, depth) + level(run) + snapshot("before")
    plates = ("floor", "back", "side")
    for plate in plates:
        lines.append(f"fix {plate} all mesh/surface/stress file {plate}.stl type {STEEL} "
                     f"reference_point {pin.real:.9g} 0 {pin.imag:.9g} stress on")
    lines.append(f"fix tool all wall/gran model {contact(run.cohesion)} mesh n_meshes 3 meshes "
                 + " ".join(plates))
    lines.append("reset_timestep 0")
    columns = [f"f_{plate}[{i}]" for plate in plates for i in (1, 3, 5)]
    lines.append(f"fix forces all ave/time 1 {EVERY} {EVERY} {' '.join(columns)} file forces.txt")
    lines.append(f"dump grains all custom {blocks(run, 0.1 / run.speed)} grains.txt x y z radius")
    for _, step in motion:
        lines += [f"fix move_{plate} all move/mesh mesh {plate} {step.command()}"
                  for plate in plates]
        lines.append(f"run {step.blocks * EVERY}")
        lines += [f"unfix move_{plate}" for plate in reversed(plates)]
    lines += [f"fix move_{plate} all move/mesh mesh {plate} linear 0 0 0" for plate in plates]
    return deck(lines + [f"run {blocks(run, 0.4)}", "undump grains"] + snapshot("after"))


# ---- Tests of the soil ------------------------------------------------------------------------


def quad(corners):
    """A rectangle as STL."""
    lines = ["solid plate"]
    for triangle in (corners[:3], corners[:1] + corners[2:]):
        vertices = [f"vertex {x:.6f} {y:.6f} {z:.6f}" for x, y, z in triangle]
        lines += ["facet normal 0 0 0", "outer loop", *vertices, "endloop", "endfacet"]
    return "\n".join(lines + ["endsolid plate", ""])


def press(run, size, pressure, speed, strain):
    """Plane strain between smooth plates, without gravity: the top comes down at a speed, the end
    is held at a pressure. Returns the input and the meshes by name."""
    length, width, height = size
    highest = SIZES[-1] * run.radius
    tall = height + highest
    domain = ((-0.1, 2 * length), (-0.1, width + 0.1), (-height - 0.1, 3 * height))
    planes = [("x", 0, MIRROR), ("y", 0, MIRROR), ("y", width, MIRROR), ("z", -height, MIRROR)]
    plane = f"all wall/gran model {contact(run.cohesion)}"
    lines = start(run, domain) + walls(run.cohesion, planes)
    lines.append(f"fix gate {plane} primitive type {MIRROR} xplane {length:.6g}")
    lines += fill(run, (0, length), (0, width), -height, height) + level(run)
    lines += snapshot("before") + [
        "unfix gate", "unfix gravity", "reset_timestep 0",
        f"variable target equal {pressure * width:.9g}*({tall:.9g}-"
        f"{speed * STEP * run.radius:.9g}*step)",
        f"fix top all mesh/surface/stress file top.stl type {MIRROR} stress on",
        f"fix end all mesh/surface/stress/servo file end.stl type {MIRROR} com {length:.6g} "
        f"{width / 2:.6g} {-height / 2:.6g} ctrlPV force axis -1 0 0 target_val v_target "
        "vel_max 0.3 kp 1",
        f"fix plates {plane} mesh n_meshes 2 meshes top end",
        f"fix down all move/mesh mesh top linear 0 0 {-speed:.6g}",
        f"fix forces all ave/time 1 {10 * EVERY} {10 * EVERY} f_top[3] f_end[1] f_end[7] "
        "file forces.txt",
        f"run {blocks(run, strain * tall / speed)}"]
    x, y = (-0.05, 2 * length - 0.05), (-0.05, width + 0.05)
    top = [(a, b, highest) for a, b in zip((x[0], x[1], x[1], x[0]), (y[0], y[0], y[1], y[1]))]
    end = [(length, b, c) for b, c in zip((y[0], y[1], y[1], y[0]),
                                          (-height - 0.05,) * 2 + (0.1,) * 2)]
    return deck(lines), {"top": quad(top), "end": quad(end)}


def drain(run, size, seconds):
    """A box without its end wall: what stays is a slope at the angle of repose."""
    length, width, depth = size
    domain = ((0, length + 1.0), (0, width), (-depth - 0.1, 3 * depth + 0.5))
    planes = [("x", 0, BOX), ("z", -depth, BOX)]
    lines = start(run, domain, "f p f") + walls(run.cohesion, planes)
    gate = f"fix gate all wall/gran model {contact(run.cohesion)} primitive type {BOX} xplane"
    lines += [f"{gate} {length:.6g}"]
    lines += fill(run, (0, length), (0, width), -depth, depth) + level(run) + snapshot("before")
    lines += ["unfix gate", f"region gone block {length + 0.05:.6g} INF INF INF INF INF units box"]
    for _ in range(round(seconds / 0.1)):
        lines += ["delete_atoms region gone", f"run {blocks(run, 0.1)}"]
    return deck(lines + snapshot("after"))
