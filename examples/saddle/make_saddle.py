#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes saddle.step: a sheet z = (x^2 / 160 - y^2 / 240) / 2 over 120 mm x 80 mm. Along x it is a trough, so that a flat end
must tilt; along y it is a ridge. One bi-quadratic Bezier face, exact.
"""
import pathlib

A, B = 60.0, 40.0  # half the sides
P, Q = 160.0, 240.0  # radii of curvature in the middle


class Step:
    """Entities one by one; `add` returns the reference."""

    def __init__(self):
        self.lines = []

    def add(self, text):
        self.lines.append(f"#{len(self.lines) + 1}={text};")
        return f"#{len(self.lines)}"

    def point(self, p):
        return self.add("CARTESIAN_POINT('',(%s))" % ",".join(f"{float(c)!r}" for c in p))


def step():
    # Control heights of x^2 over [-a, a]: a^2, -a^2, a^2.
    square = lambda half: (half * half, -half * half, half * half)
    net = [[(x, y, (sx / P - sy / Q) / 2) for y, sy in zip((-B, 0, B), square(B))] for x, sx in zip((-A, 0, A), square(A))]
    s = Step()
    refs = [[s.point(p) for p in row] for row in net]
    knots = "(3,3),(0.,1.)"
    surface = s.add("B_SPLINE_SURFACE_WITH_KNOTS('',2,2,(%s),.UNSPECIFIED.,.F.,.F.,.F.,(3,3),(3,3),(0.,1.),(0.,1.),.UNSPECIFIED.)" %
                    ",".join("(" + ",".join(row) + ")" for row in refs))

    # The four sides are rows and columns of the net, run once round counter-clockwise.
    sides = [[row[0] for row in net], net[2], [row[2] for row in net][::-1], net[0][::-1]]
    vertices = {p: s.add(f"VERTEX_POINT('',{s.point(p)})") for p in [side[0] for side in sides]}
    around = []
    for side in sides:
        curve = s.add("B_SPLINE_CURVE_WITH_KNOTS('',2,(%s),.UNSPECIFIED.,.F.,.F.,%s,.UNSPECIFIED.)" % (",".join(s.point(p) for p in side), knots))
        edge = s.add(f"EDGE_CURVE('',{vertices[side[0]]},{vertices[side[2]]},{curve},.T.)")
        around.append(s.add(f"ORIENTED_EDGE('',*,*,{edge},.T.)"))
    loop = s.add(f"EDGE_LOOP('',({','.join(around)}))")
    bound = s.add(f"FACE_OUTER_BOUND('',{loop},.T.)")
    face = s.add(f"ADVANCED_FACE('saddle',({bound}),{surface},.T.)")
    shell = s.add(f"OPEN_SHELL('',({face}))")
    model = s.add(f"SHELL_BASED_SURFACE_MODEL('',({shell}))")
    length = s.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))")
    angle = s.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
    solid = s.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")
    near = s.add(f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-06),{length},'distance_accuracy_value','')")
    context = s.add(f"(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({near}))"
                    f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{angle},{solid}))REPRESENTATION_CONTEXT('',''))")
    shape = s.add(f"MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',({model}),{context})")
    app = s.add("APPLICATION_CONTEXT('')")
    product_context = s.add(f"PRODUCT_CONTEXT('',{app},'mechanical')")
    product = s.add(f"PRODUCT('saddle','saddle','',({product_context}))")
    formation = s.add(f"PRODUCT_DEFINITION_FORMATION('','',{product})")
    definition_context = s.add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{app},'design')")
    definition = s.add(f"PRODUCT_DEFINITION('design','',{formation},{definition_context})")
    definition_shape = s.add(f"PRODUCT_DEFINITION_SHAPE('','',{definition})")
    s.add(f"SHAPE_DEFINITION_REPRESENTATION({definition_shape},{shape})")
    return ("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('saddle','',(''),(''),'','','');\n"
            "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n" + "\n".join(s.lines) + "\nENDSEC;\nEND-ISO-10303-21;\n")


if __name__ == "__main__":
    pathlib.Path(__file__).with_name("saddle.step").write_text(step())
