#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes bracket.dxf: an angle bracket 120 x 90 mm with holes (a block, inserted and arrayed), slots and marks.

The outline is drawn as single lines and arcs in no particular order, as drawings come; the slots are polylines with
bulges; centre lines and the marks to be engraved are on layers of their own."""
import math
import os

out = []
handle = 0x100


def tag(code, value):
    out.append(f"{code}\n{value}")


def entity(kind, layer, *tags):
    global handle
    tag(0, kind)
    tag(5, f"{handle:X}")
    handle += 1
    tag(8, layer)
    for code, value in tags:
        tag(code, round(value, 9) if isinstance(value, float) else value)


def line(layer, x0, y0, x1, y1):
    entity("LINE", layer, (10, float(x0)), (20, float(y0)), (11, float(x1)), (21, float(y1)))


def arc(layer, cx, cy, r, a0, a1):
    entity("ARC", layer, (10, float(cx)), (20, float(cy)), (40, float(r)), (50, float(a0)), (51, float(a1)))


def slot(layer, cx, cy, length, width, angle):
    """Round-ended slot about (cx, cy); length between the centres of its ends."""
    c, s, h, r = math.cos(math.radians(angle)), math.sin(math.radians(angle)), length / 2, width / 2
    corners = [(-h, -r, 0.0), (h, -r, 1.0), (h, r, 0.0), (-h, r, 1.0)]
    tags = [(90, 4), (70, 1)]
    for x, y, bulge in corners:
        tags += [(10, cx + c * x - s * y), (20, cy + s * x + c * y), (42, bulge)]
    entity("LWPOLYLINE", layer, *tags)


tag(0, "SECTION"), tag(2, "HEADER")
tag(9, "$ACADVER"), tag(1, "AC1015")
tag(9, "$INSUNITS"), tag(70, 4)
tag(0, "ENDSEC")
tag(0, "SECTION"), tag(2, "TABLES"), tag(0, "TABLE"), tag(2, "LAYER"), tag(70, 3)
for name, color in (("CUT", 7), ("CENTER", 1), ("MARK", 5)):
    tag(0, "LAYER"), tag(2, name), tag(70, 0), tag(62, color), tag(6, "CONTINUOUS")
tag(0, "ENDTAB"), tag(0, "ENDSEC")

tag(0, "SECTION"), tag(2, "BLOCKS")
tag(0, "BLOCK"), tag(8, "0"), tag(2, "M6"), tag(70, 0), tag(10, 0.0), tag(20, 0.0), tag(30, 0.0)
entity("CIRCLE", "0", (10, 0.0), (20, 0.0), (40, 3.3))
entity("LINE", "CENTER", (10, -5.0), (20, 0.0), (11, 5.0), (21, 0.0))
entity("LINE", "CENTER", (10, 0.0), (20, -5.0), (11, 0.0), (21, 5.0))
tag(0, "ENDBLK"), tag(8, "0"), tag(0, "ENDSEC")

tag(0, "SECTION"), tag(2, "ENTITIES")
# Outline: an L with rounded corners and a fillet in the inner corner, its pieces out of order.
line("CUT", 8, 0, 112, 0)
line("CUT", 120, 32, 120, 8)
arc("CUT", 112, 8, 8, 270, 0)
line("CUT", 60, 40, 112, 40)
arc("CUT", 112, 32, 8, 0, 90)
line("CUT", 40, 82, 40, 60)
arc("CUT", 60, 60, 20, 180, 270)
line("CUT", 0, 82, 0, 8)
line("CUT", 32, 90, 8, 90)
arc("CUT", 32, 82, 8, 0, 90)
arc("CUT", 8, 82, 8, 90, 180)
arc("CUT", 8, 8, 8, 180, 270)
# Holes: one block, arrayed 2 x 1 along the foot and single at the top.
entity("INSERT", "CUT", (2, "M6"), (10, 12.0), (20, 12.0), (70, 2), (71, 1), (44, 96.0), (45, 0.0))
entity("INSERT", "CUT", (2, "M6"), (10, 12.0), (20, 78.0))
entity("CIRCLE", "CUT", (10, 30.0), (20, 30.0), (40, 10.0))
slot("CUT", 78, 20, 24, 7, 0)
slot("CUT", 20, 58, 14, 6, 90)
slot("CUT", 52, 20, 6, 5, 45)
# A small arrow, engraved: which side is up.
line("MARK", 98, 22, 98, 34)
line("MARK", 98, 34, 95, 30)
line("MARK", 98, 34, 101, 30)
tag(0, "ENDSEC"), tag(0, "EOF")

with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "bracket.dxf"), "w") as f:
    f.write("\n".join(out) + "\n")
