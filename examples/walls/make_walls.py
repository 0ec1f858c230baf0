#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes walls.stl, a floor that bends up gently between two walls that draw together, and contacts.csv, three paths over the
floor: in the middle and near either wall. A wall beside the path limits the lean to one side; where both are near the tool
does not fit and those points are unreachable.
"""
import math
import pathlib
import struct

LENGTH, HALF, TALL = 160.0, 40.0, 50.0
R = 300.0  # radius of the floor along x: a trough
COLUMNS, ROWS = 40, 12


def half_width(x):
    """The walls leave 40 mm to either side at x = 0 and 17 mm at the end."""
    return HALF - 23.0 * x / LENGTH


def height(x):
    return R - math.sqrt(R * R - (x - LENGTH / 2) ** 2)


def floor(i, j):
    x = LENGTH * i / COLUMNS
    return x, half_width(x) * (2 * j / ROWS - 1), height(x)


def triangles():
    out = []
    for i in range(COLUMNS):
        for j in range(ROWS):
            a, b, c, d = floor(i, j), floor(i + 1, j), floor(i + 1, j + 1), floor(i, j + 1)
            out += [(a, b, c), (a, c, d)]
        for j in (0, ROWS):
            a, b = floor(i, j), floor(i + 1, j)
            up = lambda p: (p[0], p[1], TALL)
            wall = [(a, b, up(b)), (a, up(b), up(a))]
            out += wall if j == ROWS else [t[::-1] for t in wall]
    return out


def stl():
    out = b"walls".ljust(80) + struct.pack("<I", len(triangles()))
    for t in triangles():
        out += struct.pack("<12fH", 0, 0, 0, *t[0], *t[1], *t[2], 0)
    return out


def contacts():
    """Points of the exact floor at the corners of its facets, where the two touch; the feed runs as the wall draws in."""
    lines = ["path,x,y,z,nx,ny,nz,fx,fy,fz"]
    for path, j in enumerate((3, 6, 9)):
        aside = -23.0 / LENGTH * (2 * j / ROWS - 1)  # dy / dx
        for i in range(2, COLUMNS - 1):
            x, y, z = floor(i, j)
            s = (x - LENGTH / 2) / R  # sine of the slope along x
            c = math.sqrt(1 - s * s)
            n = math.sqrt(1 + aside * aside + (s / c) ** 2)
            lines.append(f"{path},{x:.9f},{y:.9f},{z:.9f},{-s:.12f},0,{c:.12f},{1 / n:.12f},{aside / n:.12f},{s / c / n:.12f}")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    here = pathlib.Path(__file__)
    here.with_name("walls.stl").write_bytes(stl())
    here.with_name("contacts.csv").write_text(contacts())
