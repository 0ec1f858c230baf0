#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes section.dxf: a shaft with a T-slot, whose wings no tool from outside reaches whole, and a keyway narrower than the ball.

Drawing x, y are the part's y, z; the rotary axis is at 0, 0.
"""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
from outline import dxf, turned  # noqa: E402

RADIUS = 16.0
NECK, WING, NECK_DEPTH, WING_DEPTH = 7.0, 15.0, 4.0, 9.0  # T-slot: widths, depths below the shaft's surface
KEY, KEY_DEPTH = 3.4, 3.0


def slot(width, depth):
    """Corners of a slot towards +y of the drawing, from its left wall to its right one (going down, across, up)."""
    top = math.sqrt(RADIUS ** 2 - (width / 2) ** 2)
    return [(-width / 2, top), (-width / 2, RADIUS - depth), (width / 2, RADIUS - depth), (width / 2, top)]


def t_slot():
    top = math.sqrt(RADIUS ** 2 - (NECK / 2) ** 2)
    n, w, shelf, floor = NECK / 2, WING / 2, RADIUS - NECK_DEPTH, RADIUS - WING_DEPTH
    return [(-n, top), (-n, shelf), (-w, shelf), (-w, floor), (w, floor), (w, shelf), (n, shelf), (n, top)]


def section():
    """Counter-clockwise: the T-slot at the top, the keyway at the bottom, arcs of the shaft between them."""
    vertices = []
    cuts = [turned(reversed_(t_slot()), 0), turned(reversed_(slot(KEY, KEY_DEPTH)), 180)]
    for i, cut in enumerate(cuts):
        last, first = cut[-1], cuts[(i + 1) % 2][0]
        sweep = (math.atan2(first[1], first[0]) - math.atan2(last[1], last[0])) % (2 * math.pi)
        vertices += [(*p, 0.0) for p in cut[:-1]] + [(*last, math.tan(sweep / 4))]
    return vertices


def reversed_(points):
    """Counter-clockwise about the axis the right wall comes first."""
    return points[::-1]


if __name__ == "__main__":
    pathlib.Path(__file__).with_name("section.dxf").write_text(dxf(section()))
