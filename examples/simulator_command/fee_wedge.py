#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""A soil simulator as a program of its own, in the standard library of Python:

    simulate-dig --density 40 --simulator-command "python3 fee_wedge.py"

Ground above the line of the tip goes into the bucket until that is struck full; the rest is laid
beside the cut. The soil resists by the fundamental equation of earthmoving for the wedge ahead of
the lip (Reece 1964; terms as in McKyes 1985) with the failure angle of least weight term. Left out:
teeth, edge, sides, the soil's way into the bucket, slides.
"""
import math

import simulator_protocol

GRAVITY = 9.80665
TANGENT = [math.radians(b) for b in range(5, 61)]  # failure angles that are tried


def cot(angle):
    return 1.0 / math.tan(angle)


def wedge_force(soil, depth, width, rake, surcharge):
    """Force P of the wedge on the blade [N], at the friction angle to its normal."""
    phi, delta = soil["friction_angle_rad"], soil["tool_friction_angle_rad"]

    def terms(beta):
        below = math.cos(rake + delta) + math.sin(rake + delta) * cot(beta + phi)
        return (cot(rake) + cot(beta)) / below, below

    pushed = [b for b in TANGENT if b + phi < math.pi and terms(b)[1] > 0.01]
    if not pushed or depth <= 0.0:
        return 0.0
    beta = min(pushed, key=lambda b: terms(b)[0])
    weight, below = terms(beta)
    gamma = soil["bulk_density_kg_m3"] * GRAVITY
    cohesion = (1.0 + cot(beta) * cot(beta + phi)) / below
    adhesion = (1.0 - cot(rake) * cot(beta + phi)) / below
    force = (0.5 * gamma * depth * weight + soil["cohesion_pa"] * cohesion
             + soil["adhesion_pa"] * adhesion + surcharge * weight)
    return max(0.0, force) * depth * width


class Bucket:
    def __init__(self, machine):
        bucket, joints = machine["bucket"], machine["joints"]
        self.width, self.rake = bucket["width_outside_m"], bucket["edge_angle_rad"]
        self.length = joints["bucket"]["length_m"]
        area, centre = 0.0, [0.0, 0.0]
        corners = bucket["profile_m"]
        for (a, b), (c, d) in zip(corners, corners[1:] + corners[:1]):
            part = 0.5 * (a * d - c * b)
            area += part
            centre = [centre[0] + part * (a + c) / 3.0, centre[1] + part * (b + d) / 3.0]
        self.centre = [each / area for each in centre]
        self.capacity = area * bucket["width_inside_m"]

    def arm_of_content(self, joints):
        """From the tip to the centre of the cavity, along x [m]."""
        direction = -sum(joints)
        along, across = self.centre[0] - self.length, self.centre[1]
        return along * math.cos(direction) - across * math.sin(direction)


class Dig:
    def __init__(self, bucket, soil, ground, poses):
        self.bucket, self.soil, self.ground, self.poses = bucket, soil, ground, poses
        self.bank, self.loose = soil["bank"], soil["loose"]
        half = 0.5 * bucket.width
        self.strip = [r for r in range(ground.rows) if abs(ground.y(r)) < half]
        self.width = len(self.strip) * ground.cell
        self.cut = 0.0  # dry mass [kg]
        self.full = bucket.capacity * self.loose["dry_density_kg_m3"]

    def dry(self, state, thickness):
        return thickness * self.ground.cell ** 2 * self.soil[state]["dry_density_kg_m3"]

    def take(self, start, end):
        """Takes what lies above the line of the tip."""
        g = self.ground
        if end["x_m"] >= start["x_m"]:
            return
        for col in range(g.col(end["x_m"]), g.col(start["x_m"]) + 1):
            if not end["x_m"] <= g.x(col) < start["x_m"]:
                continue
            share = (start["x_m"] - g.x(col)) / (start["x_m"] - end["x_m"])
            level = start["z_m"] + share * (end["z_m"] - start["z_m"])
            for row in self.strip:
                i = g.at(row, col)
                loose = min(g.loose[i], max(0.0, g.bank[i] + g.loose[i] - level))
                bank = max(0.0, g.bank[i] - level)
                g.loose[i] -= loose
                g.bank[i] -= bank
                self.cut += self.dry("loose", loose) + self.dry("bank", bank)

    def depth(self, pose):
        """Of the tip below the ground just ahead of it [m]."""
        g = self.ground
        col = g.col(pose["x_m"] - g.cell)
        heights = [g.bank[g.at(r, col)] + g.loose[g.at(r, col)] for r in self.strip]
        return sum(heights) / len(heights) - pose["z_m"]

    def load(self, pose):
        bucket, moist = self.bucket, 1.0 + self.soil["water_content"]
        carried = min(self.cut, self.full) * moist
        ahead = max(0.0, self.cut - self.full) * moist * GRAVITY
        depth, rake = self.depth(pose), max(bucket.rake, bucket.rake + pose["floor_angle_rad"])
        rake = min(rake, math.radians(90))
        surcharge = ahead / (self.width * max(depth, 0.1) * 2.0)
        force = wedge_force(self.bank, depth, bucket.width, rake, surcharge)
        angle = rake + self.bank["tool_friction_angle_rad"]
        x, z = force * math.sin(angle), -force * math.cos(angle)
        if pose["phase"] == "lift":
            x = z = 0.0
        above = depth / 3.0  # where the force acts
        moment = above * cot(rake) * z - above * x if depth > 0.0 else 0.0
        weight = carried * GRAVITY
        return (x, z - weight, moment - bucket.arm_of_content(pose["joints_rad"]) * weight, carried)

    def lay_beside(self, dry):
        """What did not fit lies in two windrows along the cut."""
        g = self.ground
        dug = [p["x_m"] for p in self.poses if p["phase"] != "lift"]
        rows = range(max(0, self.strip[0] - 6), self.strip[0])
        rows = [*rows, *range(self.strip[-1] + 1, min(g.rows, self.strip[-1] + 7))]
        cells = [g.at(r, c) for r in rows for c in range(g.col(min(dug)), g.col(max(dug)) + 1)]
        cells = [i for i in cells if not math.isnan(g.bank[i])]
        for i in cells:
            g.loose[i] += dry / self.dry("loose", 1.0) / len(cells)

    def run(self):
        loads = []
        for start, end in zip(self.poses, self.poses[1:]):
            if end["phase"] != "lift":
                self.take(start, end)
            loads.append(self.load(end))
        payload = min(self.cut, self.full)
        if self.cut > payload:
            self.lay_beside(self.cut - payload)
        return payload * (1.0 + self.soil["water_content"]), loads


def prepare(machine, soil):
    bucket = Bucket(machine)
    return lambda ground, poses: Dig(bucket, soil, ground, poses).run()


if __name__ == "__main__":
    simulator_protocol.serve("fee wedge 1", prepare)
