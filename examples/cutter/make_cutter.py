#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes section.dxf: the section of a side milling cutter, eight teeth with undercut rake faces.

A tooth is land, rake face leaning over its gullet by 12 degrees, gullet of 3.2 mm radius, straight back. Drawing x, y
are the part's y, z; the rotary axis is at 0, 0.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
from outline import dxf, fillet, polar  # noqa: E402

TEETH, TIP, ROOT, GULLET = 8, 20.0, 12.5, 3.2
LAND_DEG, RAKE_DEG = 7.0, 12.0


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


if __name__ == "__main__":
    pathlib.Path(__file__).with_name("section.dxf").write_text(dxf(section()))
