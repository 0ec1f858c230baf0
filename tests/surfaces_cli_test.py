#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The contract of `burin surfaces` from outside: STEP parts written here by hand, the program read back by a reader of our own.
usage: surfaces_cli_test.py PATH/TO/burin"""
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest

BURIN = ""


# --- parts ------------------------------------------------------------------------------------------------------------

class Step:
    """Writes entities one by one; `add` returns the reference."""

    def __init__(self, unit="MILLI"):
        self.lines, self.unit = [], unit

    def add(self, text):
        self.lines.append(f"#{len(self.lines) + 1}={text};")
        return f"#{len(self.lines)}"

    def point(self, p):
        return self.add("CARTESIAN_POINT('',(%s))" % ",".join(f"{float(c)!r}" for c in p))

    def direction(self, d):
        return self.add("DIRECTION('',(%s))" % ",".join(f"{float(c)!r}" for c in d))

    def placement(self, p, z, x):
        return self.add(f"AXIS2_PLACEMENT_3D('',{self.point(p)},{self.direction(z)},{self.direction(x)})")

    def vertex(self, p):
        return self.add(f"VERTEX_POINT('',{self.point(p)})")

    def line_edge(self, p, q, vp, vq):
        d = [b - a for a, b in zip(p, q)]
        n = math.sqrt(sum(c * c for c in d))
        vector = self.add(f"VECTOR('',{self.direction([c / n for c in d])},1.)")
        line = self.add(f"LINE('',{self.point(p)},{vector})")
        return self.add(f"EDGE_CURVE('',{vp},{vq},{line},.T.)")

    def loop(self, edges):
        oriented = [self.add(f"ORIENTED_EDGE('',*,*,{e},{'.T.' if forward else '.F.'})") for e, forward in edges]
        return self.add(f"EDGE_LOOP('',({','.join(oriented)}))")

    def text(self, faces, solid, name="part"):
        shell = self.add(f"{'CLOSED' if solid else 'OPEN'}_SHELL('',({','.join(faces)}))")
        if solid:
            item = self.add(f"MANIFOLD_SOLID_BREP('',{shell})")
        else:
            item = self.add(f"SHELL_BASED_SURFACE_MODEL('',({shell}))")
        prefix = f".{self.unit}." if self.unit else "$"
        length = self.add(f"(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT({prefix},.METRE.))")
        angle = self.add("(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.))")
        solid_angle = self.add("(NAMED_UNIT(*) SI_UNIT($,.STERADIAN.) SOLID_ANGLE_UNIT())")
        fuzz = self.add(f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-07),{length},'','')")
        context = self.add(f"(GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({fuzz})) "
                           f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{angle},{solid_angle})) REPRESENTATION_CONTEXT('',''))")
        kind = "ADVANCED_BREP_SHAPE_REPRESENTATION" if solid else "MANIFOLD_SURFACE_SHAPE_REPRESENTATION"
        shape = self.add(f"{kind}('',({item}),{context})")
        app = self.add("APPLICATION_CONTEXT('')")
        product_context = self.add(f"PRODUCT_CONTEXT('',{app},'mechanical')")
        product = self.add(f"PRODUCT('{name}','{name}','',({product_context}))")
        formation = self.add(f"PRODUCT_DEFINITION_FORMATION('','',{product})")
        definition_context = self.add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{app},'design')")
        definition = self.add(f"PRODUCT_DEFINITION('design','',{formation},{definition_context})")
        definition_shape = self.add(f"PRODUCT_DEFINITION_SHAPE('','',{definition})")
        self.add(f"SHAPE_DEFINITION_REPRESENTATION({definition_shape},{shape})")
        return ("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
                "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n" + "\n".join(self.lines) +
                "\nENDSEC;\nEND-ISO-10303-21;\n")


def box(a, b, c, **more):
    """A solid box from the origin; faces in order: -x, +x, -y, +y, -z, +z (named)."""
    s = Step(**more)
    corner = {(i, j, k): (i * a, j * b, k * c) for i in (0, 1) for j in (0, 1) for k in (0, 1)}
    vertices = {n: s.vertex(p) for n, p in corner.items()}
    edges = {}
    for n in corner:
        for axis in range(3):
            if n[axis] == 0:
                m = tuple(1 if x == axis else n[x] for x in range(3))
                edges[n, m] = s.line_edge(corner[n], corner[m], vertices[n], vertices[m])
    faces = []
    for axis in range(3):
        for side in (0, 1):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            ring = [(0, 0), (1, 0), (1, 1), (0, 1)]
            if side == 0:
                ring.reverse()
            nodes = []
            for p, q in ring:
                n = [0, 0, 0]
                n[axis], n[u], n[v] = side, p, q
                nodes.append(tuple(n))
            around = []
            for n, m in zip(nodes, nodes[1:] + nodes[:1]):
                around.append((edges[n, m], True) if (n, m) in edges else (edges[m, n], False))
            z = [0, 0, 0]
            z[axis] = 1 if side else -1
            x = [0, 0, 0]
            x[u] = 1
            plane = s.add(f"PLANE('',{s.placement(corner[nodes[0]], z, x)})")
            bound = s.add(f"FACE_OUTER_BOUND('',{s.loop(around)},.T.)")
            faces.append(s.add(f"ADVANCED_FACE('{'-+'[side]}{'xyz'[axis]}',({bound}),{plane},.T.)"))
    return s.text(faces, True)


def triangle(p, q, r, z=0.0):
    """One flat open sheet with a corner cut off: trimmed."""
    s = Step()
    points = [(*p, z), (*q, z), (*r, z)]
    vertices = [s.vertex(x) for x in points]
    edges = [(s.line_edge(points[i], points[(i + 1) % 3], vertices[i], vertices[(i + 1) % 3]), True) for i in range(3)]
    plane = s.add(f"PLANE('',{s.placement(points[0], (0, 0, 1), (1, 0, 0))})")
    bound = s.add(f"FACE_OUTER_BOUND('',{s.loop(edges)},.T.)")
    return s.text([s.add(f"ADVANCED_FACE('',({bound}),{plane},.T.)")], False)


# --- a small reader of surface programs -------------------------------------------------------------------------------

def words(block):
    block = re.sub(r"\([^)]*\)", "", block).split(";")[0]
    return [(letter, float(number)) for letter, number in re.findall(r"([A-Z])\s*([-+]?(?:\d+\.?\d*|\.\d+))", block)]


def read_program(text):
    """Blocks as {nu, nv, points: [(x, y, z, w)], number, words, trims}, and the words of the G106.2."""
    blocks, cycle, current, left = [], None, None, 0
    for raw in text.splitlines():
        assert len(raw) < 255, raw
        assert not re.search(r"\d[eE][-+]?\d", re.sub(r"\([^)]*\)", "", raw)), raw
        w = words(raw)
        codes = [n for letter, n in w if letter == "G"]
        if "BURIN TRIM" in raw and current:
            current["trims"].append(raw)
        if 106.2 in codes:
            cycle = dict(w)
        elif 6.23 in codes:
            current = dict(nu=0, nv=0, points=[], trims=[], words=dict(w))
            current["nu"], current["nv"] = int(dict(w)["U"]), int(dict(w)["V"])
            left = current["nu"] * current["nv"]
            blocks.append(current)
        elif left and any(letter in "XYZW" for letter, _ in w):
            before = current["points"][-1] if current["points"] else (0.0, 0.0, 0.0, 1.0)
            d = dict(w)
            current["points"].append(tuple(d.get(letter, b) for letter, b in zip("XYZW", before)))
            left -= 1
    assert left == 0
    return blocks, cycle


class Surfaces(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, name, text):
        with open(self.path(name), "w") as f:
            f.write(text)
        return self.path(name)

    def run_burin(self, *args, code=0):
        done = subprocess.run([BURIN, "surfaces", *args], capture_output=True, text=True, cwd=self.folder.name, timeout=120)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def program(self, *args, code=0):
        return read_program(self.run_burin(*args, "-o", "-", code=code).stdout)

    def test_box_top_is_taken_and_the_rest_is_listed(self):
        part = self.write("box.step", box(30, 20, 10))
        done = self.run_burin(part, "-o", "box.nc", "--json", "box.json", code=3)
        with open(self.path("box.nc")) as f:
            blocks, cycle = read_program(f.read())
        self.assertEqual(len(blocks), 1)
        self.assertEqual({p[2] for p in blocks[0]["points"]}, {10.0})
        self.assertEqual(sorted({p[:2] for p in blocks[0]["points"]}), [(0, 0), (0, 20), (30, 0), (30, 20)])
        self.assertEqual(cycle["W"], 20.0)
        self.assertEqual(cycle["E"], 1)
        self.assertEqual(cycle["I"], 2)
        self.assertEqual((cycle["D"], cycle["S"], cycle["F"]), (6, 0.01, 1000))
        with open(self.path("box.json")) as f:
            report = json.load(f)
        self.assertEqual(report["operation"], "surfaces")
        self.assertEqual(report["counts"]["faces"], 6)
        self.assertEqual(report["counts"]["blocks"], 1)
        self.assertEqual(report["counts"]["left_out"], 5)
        reasons = {f["name"]: f["reason"] for f in report["faces"]}
        self.assertEqual(reasons["-z"], "faces downwards")
        self.assertEqual({reasons[n] for n in ("-x", "+x", "-y", "+y")}, {"is an upright wall"})
        self.assertEqual(reasons["+z"], "")
        left_out = [w for w in report["warnings"] if w["code"] == "face_unreachable"]
        self.assertEqual(len(left_out), 5)
        self.assertTrue(all(w["severity"] == "left_out" for w in left_out))
        self.assertIn("face 5", done.stderr)

    def test_every_side_can_be_turned_up(self):
        part = self.write("box.step", box(30, 20, 10))
        sizes = {"X": (10, 20, 30), "Y": (30, 10, 20), "Z": (30, 20, 10)}
        for up in ("+X", "-X", "+Y", "-Y", "+Z", "-Z"):
            blocks, cycle = self.program(part, "--up=" + up, "--origin", "corner", code=3)
            self.assertEqual(len(blocks), 1, up)
            points = blocks[0]["points"]
            a, b, c = sizes[up[1]]
            self.assertEqual(max(p[0] for p in points), a, up)
            self.assertEqual(max(p[1] for p in points), b, up)
            self.assertEqual({p[2] for p in points}, {0.0}, up)
            self.assertEqual(cycle["W"], 10)

    def test_faces_override_the_choice(self):
        part = self.write("box.step", box(30, 20, 10))
        for lists, count in ((["2"], 1), (["1,3-5"], 4), (["6", "--faces", "5"], 2)):
            blocks, _ = self.program(part, "--faces", *lists)
            self.assertEqual(len(blocks), count)
        blocks, _ = self.program(part, "--all")
        self.assertEqual(len(blocks), 6)

    def test_cycle_words(self):
        part = self.write("t.step", triangle((0, 0), (40, 0), (0, 30), 5))
        blocks, cycle = self.program(part, "--tool-diameter", "8", "--scallop", "0.02", "--feed", "1500", "--group", "E3",
                                     "--method", "I1", "--side-step", "0.7", "--stock", "0.25", "--safety", "33")
        self.assertEqual(cycle["D"], 8)
        self.assertEqual(cycle["S"], 0.02)
        self.assertEqual(cycle["F"], 1500)
        self.assertEqual(cycle["E"], 3)
        self.assertEqual(cycle["I"], 1)
        self.assertEqual(cycle["M"], 0.7)
        self.assertEqual(cycle["W"], 33)
        self.assertEqual(blocks[0]["words"]["L"], 0.25)

    def test_trimmed_faces_bring_their_loops(self):
        part = self.write("t.step", triangle((0, 0), (40, 0), (0, 30)))
        blocks, _ = self.program(part)
        self.assertTrue(blocks[0]["trims"])
        self.assertEqual(sorted({p[:2] for p in blocks[0]["points"]}), [(0, 0), (0, 30), (40, 0), (40, 30)])

    def test_units(self):
        part = self.write("m.step", box(0.03, 0.02, 0.01, unit=""))
        blocks, _ = self.program(part, code=3)
        self.assertEqual({p[2] for p in blocks[0]["points"]}, {10.0})

    def test_list_prints_a_table_and_writes_nothing(self):
        part = self.write("box.step", box(30, 20, 10))
        done = self.run_burin(part, "--list", code=3)
        rows = done.stdout.splitlines()
        self.assertEqual(len(rows), 7)
        self.assertTrue(all("plane" in r for r in rows[1:]))
        self.assertIn("no: faces downwards", done.stdout)
        self.assertEqual(os.listdir(self.folder.name), ["box.step"])

    def test_default_name_and_origin(self):
        part = self.write("plate.step", box(30, 20, 10))
        self.run_burin(part, "--origin", "top", code=3)
        with open(self.path("plate.nc")) as f:
            blocks, cycle = read_program(f.read())
        self.assertEqual({p[:3] for p in blocks[0]["points"]}, {(-15, -10, 0), (15, -10, 0), (-15, 10, 0), (15, 10, 0)})
        self.assertEqual(cycle["W"], 10)
        blocks, _ = self.program(part, "--origin=1,2,-3.5", code=3)
        self.assertIn((-1, -2, 13.5), {p[:3] for p in blocks[0]["points"]})

    def test_same_bytes_each_time(self):
        part = self.write("box.step", box(30, 20, 10))
        first = self.run_burin(part, "--all", "-o", "-").stdout
        self.assertEqual(first, self.run_burin(part, "--all", "-o", "-").stdout)

    def test_wrong_usage(self):
        part = self.write("box.step", box(30, 20, 10))
        for args in (["--faces", "7"], ["--faces", "0"], ["--faces", "x"], ["--faces", "3-1"], ["--faces", "1,,2"],
                     ["--group", "E5"], ["--method", "I3"], ["--scallop", "-1"], ["--scallop", "nan"], ["--feed", "0"],
                     ["--up", "up"], ["--origin", "1,2"], ["--origin", "nowhere"], ["--safety", "9.5"], ["--nonsense"]):
            done = self.run_burin(part, "-o", "out.nc", *args, code=2)
            self.assertTrue(done.stderr.strip(), args)
        self.run_burin(part, "-o", part, code=2)
        self.assertEqual(os.listdir(self.folder.name), ["box.step"])

    def test_bad_parts_leave_nothing_behind(self):
        good = box(30, 20, 10)
        bad = {"empty.step": "", "head.step": good[:good.index("DATA;")], "half.step": good[:len(good) // 2],
               "text.igs": "this is no part\n", "dangling.step": good.replace("PLANE('',#", "PLANE('',#99", 1)}
        for name, text in bad.items():
            part = self.write(name, text)
            done = self.run_burin(part, "-o", "out.nc", "--json", "out.json", code=1)
            self.assertIn(name, done.stderr)
            self.assertFalse(os.path.exists(self.path("out.nc")))
            self.assertFalse(os.path.exists(self.path("out.json")))
        self.run_burin("missing.step", code=1)

    def test_no_face_upwards(self):
        text = box(30, 20, 10)
        part = self.write("box.step", text)
        done = self.run_burin(part, "--faces", "1", "-o", "-")
        self.assertIn("upright wall", done.stderr)


if __name__ == "__main__":
    BURIN = os.path.abspath(sys.argv.pop(1))
    unittest.main()
