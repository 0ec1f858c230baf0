# SPDX-License-Identifier: Apache-2.0
"""What the make_*.py of the rotary examples share: closed outlines of lines and arcs, and their DXF file.

An outline is a list of vertices (x, y, bulge), counter-clockwise; the bulge of DXF, tan(sweep / 4), belongs to the piece that begins
at the vertex. Drawing x, y are the part's y, z; the rotary axis is at 0, 0.
"""
import math


def polar(radius, degrees):
    return radius * math.cos(math.radians(degrees)), radius * math.sin(math.radians(degrees))


def turned(points, degrees):
    """About the axis; what a point has beyond x and y stays."""
    a = math.radians(degrees)
    return [(x * math.cos(a) - y * math.sin(a), x * math.sin(a) + y * math.cos(a), *rest) for x, y, *rest in points]


def arc(center, radius, start, end):
    """A vertex at `start` (degrees) with the bulge of the counter-clockwise arc to `end`."""
    sweep = math.radians((end - start) % 360)
    a = math.radians(start)
    return center[0] + radius * math.cos(a), center[1] + radius * math.sin(a), math.tan(sweep / 4)


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


def dxf(vertices):
    pairs = [(0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1015"), (9, "$INSUNITS"), (70, 4), (0, "ENDSEC"),
             (0, "SECTION"), (2, "ENTITIES"), (0, "LWPOLYLINE"), (5, "1F"), (100, "AcDbEntity"), (8, "0"),
             (100, "AcDbPolyline"), (90, len(vertices)), (70, 1)]
    for x, y, bulge in vertices:
        pairs += [(10, f"{x:.9f}"), (20, f"{y:.9f}"), (42, f"{bulge:.12f}")]
    pairs += [(0, "ENDSEC"), (0, "EOF")]
    return "".join(f"{code}\n{value}\n" for code, value in pairs)
