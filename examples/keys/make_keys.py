#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes keys.nc: the top of a keyboard's key, one surface of 6 x 6 control points, machined six times by G106.1 (two
rows of three, 19.05 mm apart); and keys_copied.nc: the same six surfaces written out one by one. The paper's first case
(Koo & Jee 2007, figures 7 and 8)."""
import os

SIZE, PITCH = 14.0, 19.05
COLUMNS, ROWS = 3, 2


def height(i, j):
    """A cap with a dish for the finger across x, lower towards the front, rounded down at the rim."""
    dish = [-0.9, 0.15, -0.55, -0.55, 0.15, -0.9][i]
    rim = [-1.2, 0.0, 0.25, 0.35, 0.3, -0.9][j]
    return 8.0 + dish + rim


def number(value):
    text = f"{value:.4f}".rstrip("0")
    return "0." if text in ("-0.", "") else text


def points(dx=0.0, dy=0.0):
    """u along x; words that stay as they were are left out."""
    lines, last = [], {}
    for j in range(6):
        for i in range(6):
            words = {"X": SIZE * i / 5 + dx, "Y": SIZE * j / 5 + dy, "Z": height(i, j), "W": 1.0}
            words = {letter: number(value) for letter, value in words.items()}
            lines.append(" ".join(letter + value for letter, value in words.items() if last.get(letter) != value))
            last = words
    return lines


CUT = "D6. L0. F1200. S0.01"
head = ["%", "(KEYS: SIX CAPS, 19.05 MM APART)", "G21 G90 G17", "G05 P10000", "G00 X0. Y0. Z40."]
tail = ["G05 P0", "M30", "%"]

once = head + ["G106.1 I1 W40.", f"N10 G06.23 U6 V6 {CUT}"] + points()
once += [f"G91 X{number(PITCH)} L2", f"X{number(-PITCH * (COLUMNS - 1))} Y{number(PITCH)}", f"X{number(PITCH)} L2"]
once += ["G80", "G90"] + tail

copied = head + ["G106.1 I1 W40."]
order = [(c, r) for r in range(ROWS) for c in range(COLUMNS)]
for n, (c, r) in enumerate(order):
    copied += [f"N{10 * (n + 1)} G06.23 U6 V6 {CUT}"] + points(PITCH * c, PITCH * r)
copied += ["G80"] + tail

here = os.path.dirname(os.path.abspath(__file__))
for name, lines in (("keys.nc", once), ("keys_copied.nc", copied)):
    with open(os.path.join(here, name), "w", newline="\n") as f:
        f.write("\n".join(lines) + "\n")
