#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes section.dxf: the section of a side milling cutter, eight teeth with undercut rake faces.

A tooth is land, rake face leaning over its gullet by 12 degrees, gullet of 3.2 mm radius, straight back. Drawing x, y
are the part's y, z; the rotary axis is at 0, 0.
"""
import math
import pathlib

TEETH, TIP, ROOT, GULLET = 8, 20.0, 12.5, 3.2
LAND_DEG, RAKE_DEG = 7.0, 12.0


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
    start = corner[0] + cut * u[0], corner[1] + cut * u[1]
    end = corner[0] + cut * v[0], corner[1] + cut * v[1]
    turn = math.pi - angle
    side = (corner[0] - before[0]) * (after[1] - corner[1]) - (corner[1] - before[1]) * (after[0] - corner[0])
    return start, end, math.copysign(math.tan(turn / 4), side)


def section():
    """Vertices (x, y, bulge), counter-clockwise: tip of the rake face, gullet, back, land."""
    vertices = []
    pitch = 360.0 / TEETH
    for tooth in range(TEETH):
        at = tooth * pitch
        tip = polar(TIP, at)
        # The rake face runs inwards and under its own tooth, which lies clockwise of it.
        root = polar(ROOT, at - RAKE_DEG)
        heel = polar(TIP, at + pitch - LAND_DEG)
        start, end, bulge = fillet(tip, root, heel, GULLET)
        vertices += [(*tip, 0.0), (*start, bulge), (*end, 0.0), (*heel, 0.0)]
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
