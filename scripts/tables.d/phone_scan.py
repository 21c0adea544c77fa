# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Scans of a phone, simulated from the true ground: a mesh of triangles, smoothed as its app fuses depth
images, with noise, an error of its scale, a bend, and a place and direction of its own; y up, in centimetres or
metres.

Numbers of our own choice: noise 3 mm a vertex; the mesh is smooth over the edge of its triangles; as the
scale drifts, so does the height, by as much of the way at 4 m from the middle; a phone that is started from
a mark stands there to 3 cm and 1 degree.
"""
import math
from dataclasses import dataclass

import numpy

NOISE, PLACE, TURN = 0.003, 0.03, math.radians(1.0)  # [m], [m], [rad], standard deviations
BEND = 4.0  # [m]


def read_grid(path):
    """(x of the columns, y of the rows, heights with rows from low to high y) of an ESRI ASCII grid [m]."""
    lines = path.read_text().splitlines()
    head = dict(line.lower().split() for line in lines[:6])
    cell = float(head["cellsize"])
    heights = numpy.array([line.split() for line in lines[6:]], dtype=float)[::-1]
    x = float(head["xllcorner"]) + cell * (numpy.arange(heights.shape[1]) + 0.5)
    y = float(head["yllcorner"]) + cell * (numpy.arange(heights.shape[0]) + 0.5)
    return x, y, heights


def smoothed(heights, cells):
    """By a Gaussian of so many cells."""
    reach = max(1, math.ceil(3 * cells))
    kernel = numpy.exp(-0.5 * (numpy.arange(-reach, reach + 1) / cells) ** 2)
    kernel /= kernel.sum()
    for axis in (0, 1):
        wide = numpy.pad(heights, [(reach, reach) if each == axis else (0, 0) for each in (0, 1)], "edge")
        heights = numpy.apply_along_axis(lambda line: numpy.convolve(line, kernel, "valid"), axis, wide)
    return heights


def heights_at(x, y, heights, at_x, at_y):
    """Bilinear."""
    column = numpy.clip((at_x - x[0]) / (x[1] - x[0]), 0, len(x) - 1.001)
    row = numpy.clip((at_y - y[0]) / (y[1] - y[0]), 0, len(y) - 1.001)
    i, j = row.astype(int), column.astype(int)
    u, v = row - i, column - j
    return ((1 - u) * ((1 - v) * heights[i, j] + v * heights[i, j + 1]) +
            u * ((1 - v) * heights[i + 1, j] + v * heights[i + 1, j + 1]))


@dataclass
class Mesh:
    vertices: numpy.ndarray  # shape (N, 3), y up [m]
    faces: numpy.ndarray  # shape (M, 3), from 0


def scanned(grid, edge, scale_sd, random):
    """The mesh of one scan. edge: of its triangles [m]; scale_sd: of its scale [-]."""
    x, y, heights = grid
    heights = smoothed(heights, edge / (x[1] - x[0]))
    columns = numpy.arange(x[0], x[-1], edge)
    rows = numpy.arange(y[0], y[-1], edge)
    at_x, at_y = numpy.meshgrid(columns, rows)
    at_x = at_x + random.uniform(-0.3, 0.3, at_x.shape) * edge
    at_y = at_y + random.uniform(-0.3, 0.3, at_y.shape) * edge
    at_z = heights_at(x, y, heights, at_x, at_y) + random.normal(0, NOISE, at_x.shape)
    points = numpy.stack([at_x, at_y, at_z], -1)
    points = points.reshape(-1, 3) * (1.0 + random.normal(0, scale_sd))
    across = ((points[:, :2] - points[:, :2].mean(0)) ** 2).sum(1)
    points[:, 2] += random.normal(0, scale_sd) * across / BEND
    turn = random.normal(0, TURN)
    turned = points @ numpy.array([[math.cos(turn), math.sin(turn), 0],
                                   [-math.sin(turn), math.cos(turn), 0], [0, 0, 1]])
    turned += random.normal(0, PLACE, 3) - [0, 0, 1.4]  # the origin is where the phone was held
    corner = numpy.arange(at_x.size).reshape(at_x.shape)
    low, right, left, high = (part.ravel() for part in (corner[:-1, :-1], corner[:-1, 1:], corner[1:, :-1],
                                                        corner[1:, 1:]))
    faces = numpy.concatenate([numpy.stack([low, right, high], -1), numpy.stack([low, high, left], -1)])
    return Mesh(numpy.stack([turned[:, 0], turned[:, 2], -turned[:, 1]], -1), faces)


def write_obj(mesh, path):
    """With texture coordinates, normals and a material, in centimetres."""
    lines = ["# Exported by a scanning app", "mtllib textured.mtl", "o Scan"]
    lines += [f"v {x:.4f} {y:.4f} {z:.4f}" for x, y, z in 100.0 * mesh.vertices]
    lines += ["vt 0.0 0.0", "vt 1.0 0.0", "vt 1.0 1.0", "vn 0.0 1.0 0.0", "usemtl material0", "s off"]
    lines += [f"f {a}/1/1 {b}/2/1 {c}/3/1" for a, b, c in mesh.faces + 1]
    path.write_text("\n".join(lines) + "\n")


def write_ply(mesh, path):
    """Binary, with colours and texture coordinates, in metres."""
    count = len(mesh.vertices)
    head = ("ply\nformat binary_little_endian 1.0\ncomment TextureFile scan.png\n"
            f"element vertex {count}\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
            "property float s\nproperty float t\n"
            f"element face {len(mesh.faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    vertices = numpy.zeros(count, dtype=[("at", "<f4", 3), ("colour", "u1", 4), ("texture", "<f4", 2)])
    vertices["at"], vertices["colour"] = mesh.vertices, (120, 90, 60, 255)
    faces = numpy.zeros(len(mesh.faces), dtype=[("corners", "u1"), ("index", "<i4", 3)])
    faces["corners"], faces["index"] = 3, mesh.faces
    path.write_bytes(head.encode() + vertices.tobytes() + faces.tobytes())
