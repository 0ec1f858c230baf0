#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes clock.nc: the cover of a desk clock, nine patches of 4 x 4 control points in three rows of three, joined to one
surface by G106.2 E1 and machined iso-scallop. Along x the patches meet smoothly, along y the upper and lower rows meet
the middle one in a crease. Three patches are given turned about: joining brings them into line. The paper's second case
(Koo & Jee 2007, figures 9 and 10)."""
import os

X = [-30.0, -14.0, 14.0, 30.0]
Y = [-20.0, -9.0, 9.0, 20.0]


def bezier(breaks, k, value, slope):
    """Control values of the cubic over piece k that has these values and slopes at its ends."""
    a, b = breaks[k], breaks[k + 1]
    h = (b - a) / 3
    return [value[k], value[k] + h * slope[k][1], value[k + 1] - h * slope[k + 1][0], value[k + 1]]


# Heights and slopes (to the left, to the right) at the breaks: equal slopes are smooth, different ones a crease.
FX = [-7.0, -1.2, -1.2, -7.0]
SX = [(0.0, 0.55), (0.16, 0.16), (-0.16, -0.16), (-0.55, 0.0)]
FY = [-4.5, 0.0, 0.0, -4.5]
SY = [(0.0, 0.5), (0.3, 0.06), (-0.06, -0.3), (-0.5, 0.0)]


def patch(column, row):
    """points[j][i]: i along u, here x; z is a sum of a curve over x and one over y, so the net is exact."""
    fx, fy = bezier(X, column, FX, SX), bezier(Y, row, FY, SY)
    xs = [X[column] + (X[column + 1] - X[column]) * i / 3 for i in range(4)]
    ys = [Y[row] + (Y[row + 1] - Y[row]) * j / 3 for j in range(4)]
    return [[(xs[i], ys[j], 12.0 + fx[i] + fy[j]) for i in range(4)] for j in range(4)]


def turned(net, how):
    if how == "reversed u":
        return [row[::-1] for row in net]
    if how == "swapped":
        return [list(row) for row in zip(*net)]
    if how == "reversed both":
        return [row[::-1] for row in net[::-1]]
    return net


TURNED = {2: "reversed u", 4: "swapped", 7: "reversed both"}


def number(value):
    text = f"{value:.6f}".rstrip("0")
    return "0." if text in ("-0.", "") else text


lines = ["%", "(CLOCK COVER: NINE PATCHES, ONE SURFACE)", "G21 G90 G17", "G05 P10000", "G00 X0. Y0. Z30.",
         "G106.2 I2 E1 P10 Q90 W30. D8. S0.02 F1500."]
for n in range(9):
    lines.append(f"N{10 * (n + 1)} G06.23 U4 V4 L0." + (f" (GIVEN {TURNED[n].upper()})" if n in TURNED else ""))
    last = {}
    for row in turned(patch(n % 3, n // 3), TURNED.get(n)):
        for x, y, z in row:
            words = {"X": number(x), "Y": number(y), "Z": number(z), "W": "1."}
            lines.append(" ".join(letter + value for letter, value in words.items() if last.get(letter) != value))
            last = words
lines += ["G80", "G00 Z30.", "G05 P0", "M30", "%"]
with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "clock.nc"), "w", newline="\n") as f:
    f.write("\n".join(lines) + "\n")
