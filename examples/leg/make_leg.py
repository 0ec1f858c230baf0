#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes leg.stl: a carved table leg, a turned outline with eight flutes that wind round the middle and a square block at the end.

Binary STL, mm, the rotary axis is X. Closed: both ends have faces.
"""
import math
import pathlib
import struct

LENGTH, ALONG, AROUND = 120.0, 90, 72


def smooth(a, b, t):
    t = min(max((t - a) / (b - a), 0.0), 1.0)
    return t * t * (3 - 2 * t)


def radius(x, phi):
    turned = 13 + 4 * math.sin(math.pi * x / 62) ** 2 - 3 * smooth(70, 115, x)
    flutes = smooth(18, 30, x) * (1 - smooth(84, 96, x))
    wound = phi + 0.9 * math.pi * x / LENGTH
    carved = 1.1 * flutes * (0.5 + 0.5 * math.cos(8 * wound))
    # A square with round corners, as the power mean of its four sides.
    square = 15.0 / (abs(math.cos(phi)) ** 8 + abs(math.sin(phi)) ** 8) ** (1 / 8)
    block = 1 - smooth(8, 16, x)
    return (1 - block) * (turned - carved) + block * square


def point(i, k):
    x, phi = LENGTH * i / ALONG, 2 * math.pi * (k % AROUND) / AROUND
    r = radius(x, phi)
    return x, r * math.cos(phi), r * math.sin(phi)


def triangles():
    for k in range(AROUND):
        yield (0.0, 0.0, 0.0), point(0, k + 1), point(0, k)
        yield (LENGTH, 0.0, 0.0), point(ALONG, k), point(ALONG, k + 1)
        for i in range(ALONG):
            a, b, c, d = point(i, k), point(i, k + 1), point(i + 1, k + 1), point(i + 1, k)
            yield a, b, c
            yield a, c, d


def normal(a, b, c):
    u, v = [b[i] - a[i] for i in range(3)], [c[i] - a[i] for i in range(3)]
    n = u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]
    length = math.sqrt(sum(x * x for x in n)) or 1.0
    return [x / length for x in n]


if __name__ == "__main__":
    faces = list(triangles())
    with open(pathlib.Path(__file__).with_name("leg.stl"), "wb") as f:
        f.write(b"carved leg, mm".ljust(80) + struct.pack("<I", len(faces)))
        for a, b, c in faces:
            f.write(struct.pack("<12fH", *normal(a, b, c), *a, *b, *c, 0))
