#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes table2.nc: Table 2 of Koo & Jee 2007 as printed, with the control points in place of its dots. N20 and N40 begin
at Y0 (the print has Y50 there, an erratum: its second point is at Y0). The surfaces are narrow in y, since M0.01 asks for
a path every hundredth of a millimetre."""
import os

WIDTH = 0.1
BUMP = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0]


def points(x0):
    lines = []
    for j in range(6):
        for i in range(6):
            y, z = WIDTH * j / 5, BUMP[i] * (1 + 0.02 * j)
            lines.append(" ".join(letter + f"{value:.4f}".rstrip("0") for letter, value in
                                  (("X", x0 + 10.0 * i), ("Y", y), ("Z", z), ("W", 1.0))) + ";")
    return lines


lines = ["N01 G05 P10000;", "N02 G90 G00 Z0.;",
         "N03 G106.2 I1 E1 P10 Q20 W15. D5. M0.01 S0.001 F500.;",
         "N10 G06.23 U6 V6 D5. L0. F500. S0.001;", *points(0.0),
         "N20 G06.23 U6 V6 D5. L0. F500. S0.001;", *points(50.0),
         "N30 G106.1 W40.;",
         "N40 G06.23 U6 V6 D3. L0. F500. S0.001;", *points(50.0),
         "N50 G91 X10.;", "N60 G80 M05;", "N70 G00 Z40.;", "N80 G05 P0;"]
with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "table2.nc"), "w", newline="\n") as f:
    f.write("\n".join(lines) + "\n")
