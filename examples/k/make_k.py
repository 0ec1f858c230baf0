#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The letter K of the laser example: 13 cubic B-splines in a box of 41 x 42 mm, counter-clockwise.

Eight sharp corners (the tips of the serifs), three inner corners, two smooth joints. Writes the drawing k.dxf beside
this file and the same control points as a C++ header for the tests and the benchmark of the arc fit:

    python3 examples/k/make_k.py
"""
from pathlib import Path

CURVES = [
    ("stem, left edge, upper half", [(0, 42), (3.6, 39.6), (5.3, 37.2), (5.0, 33.0), (5.7, 28.5), (5.3, 25.0), (5.3, 21.0)]),
    ("stem, left edge, lower half", [(5.3, 21.0), (5.3, 17.0), (5.8, 12.5), (4.9, 8.0), (5.4, 4.6), (3.6, 2.4), (0, 0)]),
    ("stem, foot", [(0, 0), (4.2, 0.5), (8, 1.1), (12, 0.4), (16, 0)]),
    ("stem, right edge below", [(16, 0), (12.6, 2.2), (10.7, 4.4), (11.3, 8.0), (10.8, 11.5), (11, 14.5), (11, 17.5)]),
    ("leg, left edge", [(11, 17.5), (13.2, 16.4), (16.5, 13.2), (19.0, 9.0), (22.6, 5.6), (25.2, 3.4), (25.0, 1.2), (22.5, 0)]),
    ("leg, foot", [(22.5, 0), (27, 0.6), (32, 1.2), (37, 0.3), (41, 0)]),
    ("leg, right edge, lower half", [(41, 0), (37.8, 1.6), (35.6, 3.8), (33.2, 7.4), (30.6, 11.2), (28.2, 14.2)]),
    ("leg, right edge, upper half", [(28.2, 14.2), (25.8, 17.2), (22.6, 19.6), (21.6, 21.8), (19.6, 22.6), (18.2, 24.4)]),
    ("arm, lower edge", [(18.2, 24.4), (21.6, 27.4), (25.8, 31.6), (29.6, 34.4), (33.2, 38.4), (36.9, 39.6), (40, 42)]),
    ("arm, head", [(40, 42), (36, 41.5), (32.5, 40.9), (29, 41.6), (25.5, 42)]),
    ("arm, upper edge", [(25.5, 42), (28.2, 40.4), (28.8, 38.2), (26.4, 35.6), (22.4, 31.6), (17.2, 27.0), (13.6, 23.6), (11, 21.6)]),
    ("stem, right edge above", [(11, 21.6), (11.2, 25), (10.6, 29), (11.3, 33.4), (10.8, 37.4), (12.8, 40.2), (16, 42)]),
    ("stem, head", [(16, 42), (12, 41.6), (8, 40.9), (4, 41.5), (0, 42)]),
]
DEGREE = 3


def knots(count):
    """Clamped, uniform."""
    spans = count - DEGREE
    return [0] * DEGREE + list(range(spans + 1)) + [spans] * DEGREE


def dxf():
    out = []

    def tag(code, value):
        out.append(f"{code:>3}\n{value}\n")

    tag(0, "SECTION"), tag(2, "HEADER")
    tag(9, "$ACADVER"), tag(1, "AC1015")
    tag(9, "$INSUNITS"), tag(70, 4)
    tag(9, "$MEASUREMENT"), tag(70, 1)
    tag(9, "$EXTMIN"), tag(10, 0), tag(20, 0), tag(30, 0)
    tag(9, "$EXTMAX"), tag(10, 41), tag(20, 42), tag(30, 0)
    tag(0, "ENDSEC")
    tag(0, "SECTION"), tag(2, "TABLES")
    tag(0, "TABLE"), tag(2, "LAYER"), tag(5, "2"), tag(100, "AcDbSymbolTable"), tag(70, 1)
    tag(0, "LAYER"), tag(5, "10"), tag(100, "AcDbSymbolTableRecord"), tag(100, "AcDbLayerTableRecord")
    tag(2, "0"), tag(70, 0), tag(62, 7), tag(6, "CONTINUOUS")
    tag(0, "ENDTAB")
    tag(0, "ENDSEC")
    tag(0, "SECTION"), tag(2, "ENTITIES")
    for number, (_, points) in enumerate(CURVES):
        u = knots(len(points))
        tag(0, "SPLINE"), tag(5, f"{0x100 + number:X}"), tag(100, "AcDbEntity"), tag(8, "0"), tag(100, "AcDbSpline")
        tag(210, 0), tag(220, 0), tag(230, 1)
        tag(70, 8), tag(71, DEGREE), tag(72, len(u)), tag(73, len(points)), tag(74, 0)
        tag(42, 1e-7), tag(43, 1e-7)
        for knot in u:
            tag(40, knot)
        for x, y in points:
            tag(10, x), tag(20, y), tag(30, 0)
    tag(0, "ENDSEC")
    tag(0, "EOF")
    return "".join(out)


def header():
    lines = [
        "// SPDX-License-Identifier: Apache-2.0",
        "// Written by examples/k/make_k.py, which also writes examples/k/k.dxf; a test compares the two.",
        "// The letter K for tests and benchmarks: 13 cubic B-splines in a box of 41 x 42 mm, counter-clockwise.",
        "#pragma once",
        "",
        "#include <vector>",
        "",
        '#include "burin/geom/curve/curve.h"',
        "",
        "namespace burin::geom {",
        "",
        "/// Clamped, uniform knots; one curve starts where the one before ends.",
        "inline std::vector<Nurbs2> letter_k() {",
        "  const std::vector<std::vector<Point2>> control_points{",
    ]
    for name, points in CURVES:
        lines.append(f"      // {name}")
        text = ", ".join(f"{{{x}, {y}}}" for x, y in points)
        lines.append(f"      {{{text}}},")
    lines += [
        "  };",
        "  std::vector<Nurbs2> curves;",
        "  for (const std::vector<Point2>& points : control_points) {",
        "    Nurbs2 curve{3, {0, 0, 0}, points, std::vector<double>(points.size(), 1.0)};",
        "    const auto spans = static_cast<int>(points.size()) - 3;",
        "    for (int i = 0; i <= spans; ++i) curve.knots.push_back(i);",
        "    curve.knots.insert(curve.knots.end(), 3, spans);",
        "    curves.push_back(curve);",
        "  }",
        "  return curves;",
        "}",
        "",
        "}  // namespace burin::geom",
        "",
    ]
    return "\n".join(lines)


if __name__ == "__main__":
    here = Path(__file__).resolve().parent
    (here / "k.dxf").write_text(dxf())
    (here.parent.parent / "src/burin/geom/curve/letter_k.h").write_text(header())
