#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""A dig in discrete elements as a program of its own, in the standard library of Python:

    simulate-dig --density 40 --simulator-timeout 600 --simulator-command "python3 disc_elements.py"

Discs in the plane of the boom: linear springs, dampers and Coulomb friction between them, and
against the plates of the bucket, which moves along the path at a fixed speed. It shows how such a
program is attached, and takes a few seconds per dig. It is no measure of anything: coarse discs
without rotation or cohesion, a section instead of a body, soft springs. What of it depends on the
density of the soil is its mass and the friction of the discs.
"""
import math
import random

import simulator_protocol

GRAVITY = 9.80665
RADIUS = 0.05  # mean [m]
SPEED = 1.0  # of the tip [m/s]
STIFFNESS = 2e5  # of a contact, per width [N/m^2]
STEP = 1.5e-3  # [s]
DAMPING = 0.3  # of critical
PACKING = 0.84  # area of the discs over that of the ground they stand for


class Discs:
    def __init__(self, friction, mass_per_area):
        self.friction, self.mass_per_area = friction, mass_per_area
        self.x, self.z, self.vx, self.vz, self.r, self.m, self.x0 = ([] for _ in range(7))

    def add(self, x, z, r):
        self.x.append(x)
        self.z.append(z)
        self.vx.append(0.0)
        self.vz.append(0.0)
        self.r.append(r)
        self.m.append(self.mass_per_area * math.pi * r * r / PACKING)
        self.x0.append(x)

    def contact(self, overlap, nx, nz, vx, vz, mass):
        """Force per width on the first of two bodies; n points to it, v is its velocity relative to
        the other."""
        normal_speed = vx * nx + vz * nz
        damper = 2.0 * DAMPING * math.sqrt(STIFFNESS * mass)
        push = max(0.0, STIFFNESS * overlap - damper * normal_speed)
        tx, tz = vx - normal_speed * nx, vz - normal_speed * nz
        slide = math.hypot(tx, tz)
        grip = min(self.friction * push, damper * slide) / slide if slide > 1e-9 else 0.0
        return push * nx - grip * tx, push * nz - grip * tz

    def forces(self, floor, left, right, plates, velocity):
        """Forces on the discs per width, and those on the bucket about its tip (x, z, moment)."""
        cells = {}
        size = 2.3 * RADIUS
        for i, (x, z) in enumerate(zip(self.x, self.z)):
            cells.setdefault((int(x // size), int(z // size)), []).append(i)
        fx, fz = [0.0] * len(self.x), [-m * GRAVITY for m in self.m]
        for (cx, cz), own in cells.items():
            near = own + cells.get((cx + 1, cz), []) + cells.get((cx - 1, cz + 1), [])
            near += cells.get((cx, cz + 1), []) + cells.get((cx + 1, cz + 1), [])
            for a, i in enumerate(own):
                for j in near[a + 1:]:
                    self.pair(i, j, fx, fz)
        bucket = [0.0, 0.0, 0.0]
        for i, (x, z, r) in enumerate(zip(self.x, self.z, self.r)):
            for overlap, nx, nz in ((floor + r - z, 0.0, 1.0), (left + r - x, 1.0, 0.0),
                                    (x + r - right, -1.0, 0.0)):
                if overlap > 0.0:
                    px, pz = self.contact(overlap, nx, nz, self.vx[i], self.vz[i], self.m[i])
                    fx[i] += px
                    fz[i] += pz
            self.against_bucket(i, plates, velocity, fx, fz, bucket)
        return fx, fz, bucket

    def pair(self, i, j, fx, fz):
        dx, dz = self.x[i] - self.x[j], self.z[i] - self.z[j]
        reach = self.r[i] + self.r[j]
        square = dx * dx + dz * dz
        if square >= reach * reach or square == 0.0:
            return
        distance = math.sqrt(square)
        px, pz = self.contact(reach - distance, dx / distance, dz / distance,
                              self.vx[i] - self.vx[j], self.vz[i] - self.vz[j],
                              min(self.m[i], self.m[j]))
        fx[i] += px
        fz[i] += pz
        fx[j] -= px
        fz[j] -= pz

    def against_bucket(self, i, plates, velocity, fx, fz, bucket):
        x, z, r = self.x[i], self.z[i], self.r[i]
        if not plates or math.hypot(x - plates[0][0], z - plates[0][1]) > 2.0:
            return
        for (ax, az), (bx, bz) in zip(plates, plates[1:]):
            ex, ez = bx - ax, bz - az
            share = ((x - ax) * ex + (z - az) * ez) / (ex * ex + ez * ez)
            share = min(1.0, max(0.0, share))
            px, pz = ax + share * ex, az + share * ez
            dx, dz = x - px, z - pz
            distance = math.hypot(dx, dz)
            if not 0.0 < distance < r:
                continue
            vx, vz = velocity(px, pz)
            qx, qz = self.contact(r - distance, dx / distance, dz / distance, self.vx[i] - vx,
                                  self.vz[i] - vz, self.m[i])
            fx[i] += qx
            fz[i] += qz
            bucket[0] -= qx
            bucket[1] -= qz
            bucket[2] -= (px - plates[0][0]) * qz - (pz - plates[0][1]) * qx

    def move(self, dt, fx, fz):
        most = RADIUS / (10.0 * dt)  # no disc passes a plate
        for i, m in enumerate(self.m):
            self.vx[i] = min(most, max(-most, self.vx[i] + dt * fx[i] / m))
            self.vz[i] = min(most, max(-most, self.vz[i] + dt * fz[i] / m))
            self.x[i] += dt * self.vx[i]
            self.z[i] += dt * self.vz[i]


class Bucket:
    def __init__(self, machine):
        bucket = machine["bucket"]
        self.profile, self.width = bucket["profile_m"], bucket["width_outside_m"]
        self.length = machine["joints"]["bucket"]["length_m"]

    def plates(self, tip_x, tip_z, direction):
        c, s = math.cos(direction), math.sin(direction)
        return [(tip_x + (a - self.length) * c - b * s, tip_z + (a - self.length) * s + b * c)
                for a, b in self.profile]

    @staticmethod
    def holds(plates, x, z):
        """Whether a point lies in the cavity, or above its mouth no higher than a disc."""
        inside = True
        for (ax, az), (bx, bz) in zip(plates, plates[1:]):
            inside = inside and (bx - ax) * (z - az) - (bz - az) * (x - ax) >= 0.0
        top = max(plates[0][1], plates[-1][1]) + 2.0 * RADIUS
        return inside and z < top


def section_height(ground, col, half_width):
    heights = [ground.bank[ground.at(r, col)] + ground.loose[ground.at(r, col)]
               for r in range(ground.rows) if abs(ground.y(r)) < half_width]
    known = [h for h in heights if not math.isnan(h)]
    return sum(known) / len(known) if known else float("nan")


def packed(discs, ground, half_width, left, right, floor):
    """Rows of discs up to the surface, at rest by nature: hexagonal, with some disorder."""
    chance = random.Random(1)
    row, z = 0, floor + RADIUS
    while z < 3.0 + floor:
        x = left + RADIUS * (1 + row % 2)
        while x < right - RADIUS:
            if z < section_height(ground, ground.col(x), half_width) - 0.5 * RADIUS:
                discs.add(x, z, RADIUS * chance.uniform(0.9, 1.0))
            x += 2.0 * RADIUS
        row, z = row + 1, z + math.sqrt(3.0) * RADIUS


def dig(bucket, soil, ground, poses):
    half, bank = 0.5 * bucket.width, soil["bank"]
    digging = [p for p in poses if p["phase"] != "lift"]
    left = max(ground.x(0), min(p["x_m"] for p in digging) - 0.8)
    right = min(ground.x(ground.cols - 1), max(p["x_m"] for p in digging) + 0.5)
    floor = min(p["z_m"] for p in digging) - 0.25
    discs = Discs(math.tan(bank["friction_angle_rad"]), bank["dry_density_kg_m3"])
    packed(discs, ground, half, left, right, floor)
    width, moist = bucket.width, 1.0 + soil["water_content"]
    loads = []
    for start, end in zip(poses, poses[1:]):
        one, two = -sum(start["joints_rad"]), -sum(end["joints_rad"])
        way = math.hypot(end["x_m"] - start["x_m"], end["z_m"] - start["z_m"])
        time = max(way, abs(two - one) * bucket.length) / SPEED
        steps = max(1, math.ceil(time / STEP))
        dt, turn = time / steps, (two - one) / time if time > 0.0 else 0.0
        vx, vz = ((end[k] - start[k]) / time if time > 0.0 else 0.0 for k in ("x_m", "z_m"))
        total = [0.0, 0.0, 0.0]
        for i in range(steps):
            tip_x, tip_z = start["x_m"] + vx * dt * i, start["z_m"] + vz * dt * i
            plates = bucket.plates(tip_x, tip_z, one + turn * dt * i)

            def velocity(x, z, at=(tip_x, tip_z)):
                return vx - turn * (z - at[1]), vz + turn * (x - at[0])

            fx, fz, on_bucket = discs.forces(floor, left, right, plates, velocity)
            discs.move(dt, fx, fz)
            total = [t + f for t, f in zip(total, on_bucket)]
        mean = [moist * width * t / steps for t in total]
        plates = bucket.plates(end["x_m"], end["z_m"], two)
        held = [i for i in range(len(discs.x)) if bucket.holds(plates, discs.x[i], discs.z[i])]
        loads.append((*mean, moist * width * sum(discs.m[i] for i in held)))
    return change_ground(bucket, soil, ground, discs, set(held)) * moist, loads


def change_ground(bucket, soil, ground, discs, held):
    """Takes discs that moved from where they were, and lays those that are not held where they are;
    the dry mass in the bucket [kg]."""
    rows = [r for r in range(ground.rows) if abs(ground.y(r)) < 0.5 * bucket.width]
    area = len(rows) * ground.cell ** 2
    payload = 0.0
    for i, x0 in enumerate(discs.x0):
        if i not in held and math.hypot(discs.x[i] - x0, 0.0) < discs.r[i]:
            continue
        mass = discs.m[i] * bucket.width
        col = ground.col(x0)
        for row in rows:  # loose soil first
            at, dry = ground.at(row, col), mass / area
            loose = min(ground.loose[at], dry / soil["loose"]["dry_density_kg_m3"])
            ground.loose[at] -= loose
            dry -= loose * soil["loose"]["dry_density_kg_m3"]
            ground.bank[at] -= dry / soil["bank"]["dry_density_kg_m3"]
        if i in held:
            payload += mass
            continue
        for row in rows:
            at = ground.at(row, ground.col(discs.x[i]))
            ground.loose[at] += mass / area / soil["loose"]["dry_density_kg_m3"]
    return payload


def prepare(machine, soil):
    bucket = Bucket(machine)
    return lambda ground, poses: dig(bucket, soil, ground, poses)


if __name__ == "__main__":
    simulator_protocol.serve("disc elements 1", prepare)
