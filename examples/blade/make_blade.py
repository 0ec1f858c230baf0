#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes root.dxf, middle.dxf, upper.dxf and tip.dxf: four sections of a blade, each a lens of two sides with round edges, smaller
and more turned the farther out. Drawing x, y are the part's y, z; the rotary axis is at 0, 0.
"""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
from outline import arc, dxf, turned  # noqa: E402

# name, half chord, radius of the edges, radius of the sides, degrees
SECTIONS = [("root", 18.0, 1.6, 40.0, 0.0), ("middle", 16.0, 1.4, 38.0, 14.0), ("upper", 14.0, 1.2, 37.0, 27.0),
            ("tip", 12.0, 1.0, 36.0, 38.0)]


def section(half, edge, side, turn):
    """Edge circles centred at -+(half - edge) on the chord; a side of radius F is centred on the other side of the chord, F - edge from both."""
    c = half - edge
    away = math.sqrt((side - edge) ** 2 - c * c)
    upper = math.degrees(math.atan2(away, c))  # direction from the centre of the upper side to the right edge
    vertices = [arc((c, 0.0), edge, -upper, upper), arc((0.0, -away), side, upper, 180 - upper),
                arc((-c, 0.0), edge, 180 - upper, 180 + upper), arc((0.0, away), side, 180 + upper, -upper)]
    return turned(vertices, turn)


if __name__ == "__main__":
    for name, *shape in SECTIONS:
        pathlib.Path(__file__).with_name(name + ".dxf").write_text(dxf(section(*shape)))
