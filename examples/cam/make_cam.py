#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes section.dxf: a disc cam with a high and a low lobe, arcs only: base circle, flanks that touch both circles, noses.

Drawing x, y are the part's y, z; the rotary axis is at 0, 0.
"""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
from outline import arc, dxf  # noqa: E402

BASE = 14.0
# Direction of the lobe in degrees, distance and radius of its nose, radius of its flanks.
LOBES = [(90.0, 15.0, 6.0, 45.0), (250.0, 8.0, 9.0, 60.0)]


def lobe(at, distance, nose, flank):
    """Three arcs: flank, nose, flank. A flank of radius F has its centre F - BASE from the axis and F - nose from the nose's centre."""
    a, b = flank - BASE, flank - nose
    # Angle at the axis between the nose and the flank's centre, which lies on the far side.
    opening = math.degrees(math.acos((a * a + distance * distance - b * b) / (2 * a * distance)))
    tip = distance * math.cos(math.radians(at)), distance * math.sin(math.radians(at))
    vertices = []
    ends = []
    for side in (-1, 1):
        way = math.radians(at - side * opening)
        center = a * math.cos(way), a * math.sin(way)
        # The flank touches the base circle and the nose where its radii pass through their centres.
        on_base = math.degrees(math.atan2(-center[1], -center[0]))
        on_nose = math.degrees(math.atan2(tip[1] - center[1], tip[0] - center[0]))
        ends.append((center, on_base, on_nose))
    (first, base_in, nose_in), (second, base_out, nose_out) = ends
    vertices.append(arc(first, flank, base_in, nose_in))
    vertices.append(arc(tip, nose, nose_in, nose_out))
    vertices.append(arc(second, flank, nose_out, base_out))
    return vertices, base_in, base_out


def section():
    parts = [lobe(*one) for one in LOBES]
    vertices = []
    for i, (own, _, leaves) in enumerate(parts):
        vertices += own
        vertices.append(arc((0, 0), BASE, leaves, parts[(i + 1) % len(parts)][1]))
    return vertices


if __name__ == "__main__":
    pathlib.Path(__file__).with_name("section.dxf").write_text(dxf(section()))
