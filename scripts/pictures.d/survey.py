# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""What a sensor beside a dig sees, and what walls and heap hide from it."""
from sketch import BLUE, GREY, INK, RED, SOIL, Sketch

SENSOR = (0.0, 4.0)
PIT = [(3.0, 0.0), (3.12, -0.9), (5.0, -0.9), (5.2, 0.0)]
SPILL = [(5.25, 0.0), (5.55, 0.28), (5.95, 0.0)]
HEAP = [(7.4, 0.0), (8.5, 0.85), (9.6, 0.0)]
GROUND = [(-0.8, 0.0), *PIT, *SPILL, *HEAP, (11.2, 0.0)]

sketch = Sketch(-0.9, 11.3, -1.5, 4.6, 75)


def beyond(rim, level):
    """Where the ray over a rim comes to a level."""
    share = (SENSOR[1] - level) / (SENSOR[1] - rim[1])
    return SENSOR[0] + share * (rim[0] - SENSOR[0]), level


sketch.line([*GROUND, (11.2, -1.5), (-0.8, -1.5), (-0.8, 0)], SOIL, 0, "#efe6d5")
sketch.line(GROUND, SOIL, 2)
floor = beyond(PIT[0], -0.9)
hidden = beyond(HEAP[1], 0.0)
sketch.line([PIT[0], PIT[1], floor, PIT[0]], RED, 0.5, "#f3b4b4")
sketch.line([HEAP[1], HEAP[2], hidden, HEAP[1]], RED, 0.5, "#f3b4b4")
for place in (PIT[0], floor, PIT[2], PIT[3], SPILL[1], HEAP[0], HEAP[1], hidden):
    sketch.line([SENSOR, place], BLUE, 0.8)
sketch.line([(SENSOR[0], 0), SENSOR], GREY, 3)
sketch.dot(SENSOR, BLUE)
sketch.text(0.2, 4.2, "sensor: high, in one place for both scans", BLUE)
sketch.text(3.9, -1.15, "hole", INK, "middle")
sketch.text(5.6, 0.45, "spill", INK, "middle")
sketch.text(8.5, 1.0, "heap", INK, "middle")
sketch.text(2.85, -0.55, "near wall: hidden", RED, "end")
sketch.text(9.9, 0.62, "far side: hidden", RED, "middle")
sketch.text(0.6, -0.3, "stable ground", SOIL)
sketch.text(6.6, -0.3, "stable ground", SOIL, "middle")
print(sketch.svg("What a sensor sees of a dig, and what it does not"))
