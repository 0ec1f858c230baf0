#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes section.dxf: the section of a two-start feed screw with deep channels whose sides lean over them.

A start is crest, side that leans over its channel, round channel floor, steep back. Drawing x, y are the part's y, z; the rotary axis is
at 0, 0.
"""
import math
import pathlib

STARTS, TIP, ROOT, FLOOR = 2, 16.0, 7.5, 3.0
CREST_DEG, LEAN_DEG, BACK_DEG = 40.0, 10.0, 62.0


def polar(radius, degrees):
    return radius * math.cos(math.radians(degrees)), radius * math.sin(math.radians(degrees))


def fillet(before, corner, after, radius):
    """Tangent points and bulge of a round corner."""
    def unit(a, b):
        length = math.dist(a, b)
        return (b[0] - a[0]) / length, (b[1] - a[1]) / length
    u, v = unit(corner, before), unit(corner, after)
    angle = math.acos(u[0] * v[0] + u[1] * v[1])
    cut = radius / math.tan(angle / 2)
    side = (corner[0] - before[0]) * (after[1] - corner[1]) - (corner[1] - before[1]) * (after[0] - corner[0])
    start = corner[0] + cut * u[0], corner[1] + cut * u[1]
    end = corner[0] + cut * v[0], corner[1] + cut * v[1]
    return start, end, math.copysign(math.tan((math.pi - angle) / 4), side)


def section():
    """Vertices (x, y, bulge), counter-clockwise: tip of the leaning side, two corners of the floor, tip of the back."""
    vertices = []
    pitch = 360.0 / STARTS
    for start in range(STARTS):
        at = start * pitch
        tip = polar(TIP, at)
        near, far = polar(ROOT, at - LEAN_DEG), polar(ROOT, at + pitch - CREST_DEG - BACK_DEG)
        heel = polar(TIP, at + pitch - CREST_DEG)
        a = fillet(tip, near, far, FLOOR)
        b = fillet(near, far, heel, FLOOR)
        crest = math.tan(math.radians(CREST_DEG) / 4)  # an arc about the axis to the next tip
        vertices += [(*tip, 0.0), (*a[0], a[2]), (*a[1], 0.0), (*b[0], b[2]), (*b[1], 0.0), (*heel, crest)]
    return vertices


def dxf(vertices):
    pairs = [(0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1015"), (9, "$INSUNITS"), (70, 4), (0, "ENDSEC"),
             (0, "SECTION"), (2, "ENTITIES"), (0, "LWPOLYLINE"), (5, "1F"), (100, "AcDbEntity"), (8, "0"),
             (100, "AcDbPolyline"), (90, len(vertices)), (70, 1)]
    for x, y, bulge in vertices:
        pairs += [(10, f"{x:.9f}"), (20, f"{y:.9f}"), (42, f"{bulge:.12f}")]
    pairs += [(0, "ENDSEC"), (0, "EOF")]
    return "".join(f"{code}\n{value}\n" for code, value in pairs)


if __name__ == "__main__":
    pathlib.Path(__file__).with_name("section.dxf").write_text(dxf(section()))
