# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""The site frame, the joint angles and the numbers of a path, by the lengths of the ZX120."""
import math

from sketch import BLUE, GREY, INK, RED, SOIL, Sketch

PIN, LENGTHS, JOINTS = (0.14, 1.424), (4.6, 2.519, 1.23), (-0.45, 1.35, 0.45)
ANGLE, PENETRATION, DRAG = math.radians(50), 0.75, 1.5

sketch = Sketch(-2.2, 10.2, -1.5, 4.6, 78)


def onwards(point, length, angle):
    return point[0] + length * math.cos(angle), point[1] + length * math.sin(angle)


def machine():
    """Pins from boom to tip, and the direction of each link."""
    points, directions, turned = [PIN], [], 0.0
    for length, joint in zip(LENGTHS, JOINTS):
        turned += joint
        directions.append(-turned)
        points.append(onwards(points[-1], length, -turned))
    return points, directions


sketch.line([(-2.2, 0), (10.2, 0), (10.2, -1.5), (-2.2, -1.5), (-2.2, 0)], SOIL, 0, "#efe6d5")
sketch.line([(-2.2, 0), (10.2, 0)], SOIL, 2)
sketch.line([(-1.8, 0), (-1.8, 0.75), (1.8, 0.75), (1.8, 0), (-1.8, 0)], GREY, 1, "#e5e7eb")
sketch.line([(-1.5, 0.85), (-1.5, 1.9), (0.5, 1.9), (0.5, 0.85), (-1.5, 0.85)], GREY, 1, "#e5e7eb")
pins, ways = machine()
sketch.line(pins, INK, 5)
base = 0.0
for pin, way, name in zip(pins, ways, ("boom", "arm", "bucket")):
    sketch.line([pin, onwards(pin, 1.35, base)], GREY, 1, dash="5 4")
    sketch.arc(pin, 1.05, base, way, RED)
    label = onwards(pin, 1.25, (base + way) / 2)
    sketch.text(label[0] + 0.08, label[1] - 0.03, name, RED)
    base = way
for pin in pins[:3]:
    sketch.dot(pin)
sketch.text(pins[0][0] - 0.1, pins[0][1] + 0.25, "boom pin", INK, "end")
sketch.text(pins[3][0] - 0.12, pins[3][1], "tip", INK, "end")
sketch.text(-2.1, 4.3, "joint angles: positive turns down and curls in; drawn boom "
            f"{JOINTS[0]}, arm {JOINTS[1]}, bucket {JOINTS[2]} rad", RED)
sketch.line([(0, 0), (2.7, 0)], BLUE, 2, arrow=True)
sketch.line([(0, 0), (0, 1.25)], BLUE, 2, arrow=True)
sketch.text(2.3, 0.12, "x", BLUE)
sketch.text(0.1, 1.05, "z", BLUE)
sketch.text(0, -0.3, "origin: swing axis at ground level; y to the left", BLUE, "middle")
start = (7.6, 0.0)
deep = onwards(start, PENETRATION, -(math.pi - ANGLE))
end = (deep[0] - DRAG, deep[1])
sketch.line([start, deep, end], INK, 2.2, arrow=True)
sketch.arc(start, 0.45, math.pi, math.pi + ANGLE, INK)
sketch.text(start[0] + 0.05, 0.12, "start x")
sketch.text(start[0] - 0.1, -0.5, "penetration angle and length")
sketch.text((deep[0] + end[0]) / 2, deep[1] - 0.25, "drag length", INK, "middle")
print(sketch.svg("Site frame, joint angles and the numbers of a path"))
