#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes section.dxf: the section of a two-start feed screw with deep channels whose sides lean over them.

A start is crest, side that leans over its channel, round channel floor, steep back. Drawing x, y are the part's y, z; the rotary axis is
at 0, 0.
"""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
from outline import dxf, fillet, polar  # noqa: E402

STARTS, TIP, ROOT, FLOOR = 2, 16.0, 7.5, 3.0
CREST_DEG, LEAN_DEG, BACK_DEG = 40.0, 10.0, 62.0


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


if __name__ == "__main__":
    pathlib.Path(__file__).with_name("section.dxf").write_text(dxf(section()))
