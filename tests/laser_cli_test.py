#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The contract of `burin laser` from outside: drawings written here, the NC read back by a reader of our own.
usage: laser_cli_test.py PATH/TO/burin"""
import json
import math
import os
import re
import stat
import subprocess
import sys
import tempfile
import unittest

BURIN = ""
EXAMPLES = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "examples")
PLAIN = ["--lead", "none", "--order", "file"]


# --- drawings ---------------------------------------------------------------------------------------------------------

def tags(*pairs):
    return "".join(f"{code}\n{value}\n" for code, value in pairs)


def dxf(*entities, units=4, layers=(), blocks=""):
    """layers: (name, flags, color); entities: texts of tags."""
    head = tags((0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1015"))
    if units is not None:
        head += tags((9, "$INSUNITS"), (70, units))
    head += tags((0, "ENDSEC"))
    if layers:
        head += tags((0, "SECTION"), (2, "TABLES"), (0, "TABLE"), (2, "LAYER"), (70, len(layers)))
        for name, flags, color in layers:
            head += tags((0, "LAYER"), (2, name), (70, flags), (62, color), (6, "CONTINUOUS"))
        head += tags((0, "ENDTAB"), (0, "ENDSEC"))
    if blocks:
        head += tags((0, "SECTION"), (2, "BLOCKS")) + blocks + tags((0, "ENDSEC"))
    return head + tags((0, "SECTION"), (2, "ENTITIES")) + "".join(entities) + tags((0, "ENDSEC"), (0, "EOF"))


def line(x0, y0, x1, y1, layer="0", handle="A1"):
    return tags((0, "LINE"), (5, handle), (8, layer), (10, x0), (20, y0), (11, x1), (21, y1))


def circle(x, y, r, layer="0", handle="C1"):
    return tags((0, "CIRCLE"), (5, handle), (8, layer), (10, x), (20, y), (40, r))


def poly(points, closed=True, layer="0", handle="B1", extrusion=None):
    """points: (x, y) or (x, y, bulge)."""
    text = tags((0, "LWPOLYLINE"), (5, handle), (8, layer), (90, len(points)), (70, 1 if closed else 0))
    for p in points:
        text += tags((10, p[0]), (20, p[1]), (42, p[2] if len(p) > 2 else 0.0))
    if extrusion:
        text += tags((210, 0.0), (220, 0.0), (230, extrusion))
    return text


def rect(x0, y0, x1, y1, **more):
    return poly([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], **more)


def slot(cx, cy, length, width, **more):
    h, r = length / 2, width / 2
    return poly([(cx - h, cy - r), (cx + h, cy - r, 1.0), (cx + h, cy + r), (cx - h, cy + r, 1.0)], **more)


def svg(body, attributes='width="100mm" height="100mm" viewBox="0 0 100 100"', comment=""):
    return (f'<?xml version="1.0"?>\n{comment}<svg xmlns="http://www.w3.org/2000/svg" {attributes}>'
            f'<g fill="none" stroke="black">{body}</g></svg>')


# --- a small control --------------------------------------------------------------------------------------------------

class Move:
    def __init__(self, code, a, b, center, power, feed, on):
        self.code, self.a, self.b, self.center, self.power, self.feed, self.on = code, a, b, center, power, feed, on

    def radii(self):
        return math.dist(self.a, self.center), math.dist(self.b, self.center)

    def sweep(self):
        """Signed; a full circle where start and end agree."""
        s = math.atan2(self.a[1] - self.center[1], self.a[0] - self.center[0])
        e = math.atan2(self.b[1] - self.center[1], self.b[0] - self.center[0])
        turn = (e - s) % (2 * math.pi) if self.code == 3 else -((s - e) % (2 * math.pi))
        if self.a == self.b:
            turn = 2 * math.pi if self.code == 3 else -2 * math.pi
        return turn

    def length(self):
        if self.code in (0, 1):
            return math.dist(self.a, self.b)
        return abs(self.sweep()) * self.radii()[0]

    def points(self, n=24):
        if self.code in (0, 1):
            return [(self.a[0] + (self.b[0] - self.a[0]) * i / n, self.a[1] + (self.b[1] - self.a[1]) * i / n)
                    for i in range(n + 1)]
        r, s, turn = self.radii()[0], math.atan2(self.a[1] - self.center[1], self.a[0] - self.center[0]), self.sweep()
        return [(self.center[0] + r * math.cos(s + turn * i / n), self.center[1] + r * math.sin(s + turn * i / n))
                for i in range(n + 1)]


def read_nc(text):
    """Moves of an absolute program in mm with relative arc centres; asserts on what it does not understand."""
    moves, at, mode, on, power, feed = [], (0.0, 0.0), None, False, 0.0, 0.0
    ended = False
    for raw in text.splitlines():
        block = re.sub(r"\([^)]*\)", "", raw).split(";")[0].strip()
        if not block or block == "%":
            continue
        assert not ended, "after the end: " + raw
        words = re.findall(r"([A-Z])\s*([-+]?(?:\d+\.?\d*|\.\d+))", block)
        assert re.sub(r"[A-Z]\s*[-+]?(?:\d+\.?\d*|\.\d+)|\s", "", block) == "", raw
        value = {}
        for letter, number in words:
            if letter == "G":
                code = float(number)
                if code in (0, 1, 2, 3):
                    mode = int(code)
                else:
                    assert code in (4, 17, 21, 40, 49, 54, 64, 80, 90, 91.1, 94), raw
                    if code == 64:
                        assert value.setdefault("P", None) is None
            elif letter == "M":
                code = int(float(number))
                assert code in (2, 3, 4, 5, 9, 30), raw
                on = True if code in (3, 4) else False if code == 5 else on
                ended = code in (2, 30)
            elif letter in "XYIJSFPON":
                value[letter] = float(number)
            else:
                raise AssertionError("unknown word in " + raw)
        power, feed = value.get("S", power), value.get("F", feed)
        if any(c in value for c in "XYIJ"):
            to = (value.get("X", at[0]), value.get("Y", at[1]))
            center = None
            if mode in (2, 3):
                center = (at[0] + value.get("I", 0.0), at[1] + value.get("J", 0.0))
            else:
                assert "I" not in value and "J" not in value, raw
            assert mode is not None and (mode == 0 or feed > 0), raw
            moves.append(Move(mode, at, to, center, power, feed, on and mode != 0))
            at = to
    assert ended and not on, "the program must end with the beam off"
    return moves


def loops(moves):
    """Beam-on chains."""
    chains, current = [], []
    for m in moves:
        if m.on:
            current.append(m)
        elif current:
            chains.append(current)
            current = []
    return chains + ([current] if current else [])


def area(chain):
    total = 0.0
    for m in chain:
        total += 0.5 * (m.a[0] * m.b[1] - m.b[0] * m.a[1])
        if m.code in (2, 3):
            turn, r = m.sweep(), m.radii()[0]
            total += 0.5 * r * r * (turn - math.sin(turn))
    return total


def to_rounded_box(p, x0, y0, x1, y1):
    """Signed distance from p to the box (negative inside)."""
    dx, dy = max(x0 - p[0], p[0] - x1), max(y0 - p[1], p[1] - y1)
    if dx > 0 and dy > 0:
        return math.hypot(dx, dy)
    return max(dx, dy)


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.env = {**os.environ, "XDG_DATA_HOME": os.path.join(self.folder, "none"), "NO_COLOR": "1"}

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content):
        with open(self.path(name), "wb") as f:
            f.write(content if isinstance(content, bytes) else content.encode())
        return name

    def read(self, name):
        with open(self.path(name), newline="") as f:
            return f.read()

    def names(self):
        return sorted(os.listdir(self.folder))

    def burin(self, *args, expect=0):
        done = subprocess.run([BURIN, "laser", *args], capture_output=True, text=True, timeout=120, cwd=self.folder,
                              env=self.env)
        self.assertEqual(done.returncode, expect, f"burin laser {' '.join(args)}\n{done.stdout[:2000]}{done.stderr}")
        return done

    def job(self, drawing, *args, expect=0, name="part.dxf"):
        """Runs on the text of a drawing; returns the moves and the JSON."""
        self.write(name, drawing)
        self.last = self.burin(name, *args, "-o", "out.ngc", "--json", "out.json", expect=expect)
        return read_nc(self.read("out.ngc")), json.loads(self.read("out.json"))

    def refused(self, drawing, *args, expect=1, name="part.dxf", says=()):
        """Nothing but the drawing is left, and the message says what it should."""
        self.write(name, drawing)
        before = self.names()
        done = self.burin(name, *args, "--json", "out.json", "--html", "out.html", "--cl", "out.cl", expect=expect)
        self.assertEqual(self.names(), before)
        self.assertEqual(done.stdout, "")
        for text in says:
            self.assertIn(text, done.stderr)
        return done

    def any_of(self, *codes):
        class Any(int):
            def __eq__(self, other):
                return other in codes
            __hash__ = int.__hash__
        return Any(codes[0])

    @staticmethod
    def codes(report):
        return sorted(w["code"] for w in report["warnings"])

    def box_of(self, moves):
        points = [p for m in moves if m.on for p in m.points(90)]
        return [min(p[0] for p in points), min(p[1] for p in points), max(p[0] for p in points),
                max(p[1] for p in points)]

    def assert_box(self, moves, *box, near=2e-3):
        for got, wanted in zip(self.box_of(moves), box):
            self.assertAlmostEqual(got, wanted, delta=near)


class Geometry(Case):
    def test_square_circle_slot_are_their_exact_offsets(self):
        d = 0.25
        drawing = dxf(rect(0, 0, 60, 40), circle(12, 20, 6), slot(40, 20, 20, 8))
        for dialect, unit in (("linuxcnc", 1e-4), ("fanuc", 1e-4), ("grbl", 1e-3)):
            with self.subTest(dialect):
                moves, report = self.job(drawing, "--offset", str(d), *PLAIN, "--dialect", dialect)
                box, hole, long_hole = loops(moves)
                near = 2 * unit
                for m in box:
                    for p in m.points():
                        self.assertAlmostEqual(to_rounded_box(p, 0, 0, 60, 40), d, delta=near)
                for m in hole:
                    for p in m.points():
                        self.assertAlmostEqual(math.dist(p, (12, 20)), 6 - d, delta=near)
                for m in long_hole:
                    for p in m.points():
                        on_axis = (min(max(p[0], 30), 50), 20)
                        self.assertAlmostEqual(math.dist(p, on_axis), 4 - d, delta=near)
                self.assertAlmostEqual(abs(area(box)), 60 * 40 + 200 * d + math.pi * d * d, delta=200 * near)
                self.assertAlmostEqual(abs(area(hole)), math.pi * (6 - d) ** 2, delta=40 * near)
                r = 4 - d
                self.assertAlmostEqual(abs(area(long_hole)), math.pi * r * r + 20 * 2 * r, delta=60 * near)
                for chain in loops(moves):
                    self.assertEqual(chain[0].a, chain[-1].b)
                c = report["counts"]
                self.assertEqual((c["entities"], c["contours"], c["outer"], c["holes"], c["open"], c["pierces"]),
                                 (3, 3, 1, 2, 0, 3))
                self.assertEqual((c["arcs"], c["lines"]), (4 + 2 + 2, 4 + 2))
                self.assertAlmostEqual(report["lengths_mm"]["cut"], sum(m.length() for m in moves if m.on), delta=0.01)
                self.assertAlmostEqual(report["lengths_mm"]["rapid"], sum(m.length() for m in moves if m.code == 0),
                                       delta=70)  # from where the first rapid starts is the machine's
                self.assertEqual(report["lengths_mm"]["lead"], 0)
                self.assertEqual(self.codes(report), ["default_feed", "no_power"])
                # Every coordinate has at most the dialect's decimals.
                for number in re.findall(r"[XYIJ]([-+.\d]+)", self.read("out.ngc")):
                    self.assertLessEqual(len(number.partition(".")[2]), 3 if dialect == "grbl" else 4)

    def test_order_and_one_pierce_a_contour(self):
        drawing = dxf(rect(0, 0, 60, 40), circle(12, 20, 6), circle(40, 20, 5))
        moves, _ = self.job(drawing, "--kerf", "0.5", *PLAIN)
        self.assertEqual([round(abs(area(c))) for c in loops(moves)],
                         [round(a) for a in (2400 + 50 + 0.25**2 * math.pi, 5.75**2 * math.pi, 4.75**2 * math.pi)])
        moves, report = self.job(drawing, "--kerf", "0.5")
        ends = [c[-1].b for c in loops(moves)]
        self.assertEqual(len(ends), 3)
        self.assertEqual(report["counts"]["pierces"], 3)
        self.assertGreater(report["lengths_mm"]["lead"], 0)
        self.assertFalse(5 < ends[-1][0] < 55 and 1 < ends[-1][1] < 39, "the outline is cut last")

    def test_sides_and_negative_offsets(self):
        drawing = dxf(rect(0, 0, 40, 40), rect(10, 10, 30, 30))
        grown, shrunk = (lambda s: s * s + 4 * s * 0.5 + math.pi * 0.25), (lambda s: (s - 1) ** 2)
        for args, outer, inner in ((("--offset", "0.5"), grown(40), shrunk(20)),
                                   (("--offset", "-0.5"), shrunk(40), grown(20)),
                                   (("--offset=-0.5",), shrunk(40), grown(20)),
                                   (("--kerf", "1", "--side", "outside"), grown(40), grown(20)),
                                   (("--kerf", "1", "--side", "inside"), shrunk(40), shrunk(20)),
                                   (("--kerf", "1", "--side", "on"), 1600, 400),
                                   (("--side", "on"), 1600, 400),
                                   (("--offset", "0"), 1600, 400)):
            moves, _ = self.job(drawing, *args, *PLAIN)
            areas = [abs(area(c)) for c in loops(moves)]
            self.assertEqual(len(areas), 2)
            self.assertAlmostEqual(areas[0], outer, delta=0.02, msg=str(args))
            self.assertAlmostEqual(areas[1], inner, delta=0.02, msg=str(args))

    def test_no_arcs(self):
        d = 0.25
        for tolerance in (0.1, 0.01, 0.001):
            moves, report = self.job(dxf(slot(40, 20, 20, 8)), "--offset", str(d), *PLAIN, "--no-arcs", "--tolerance",
                                     str(tolerance))
            self.assertNotRegex(self.read("out.ngc"), r"G0?[23]\b")
            (chain,) = loops(moves)
            worst = 0
            for m in chain:
                for p in m.points():
                    worst = max(worst, abs(math.dist(p, (min(max(p[0], 30), 50), 20)) - 4 - d))
            self.assertLessEqual(worst, tolerance + 1e-4)
            self.assertEqual(report["counts"]["arcs"], 0)
            self.assertEqual(report["counts"]["lines"], len(chain))
            self.assertLessEqual(report["quality"]["max_deviation_mm"], tolerance)

    def test_arcs_suit_the_control(self):
        # Large and small radii, odd positions: what rounding does to them differs.
        drawing = dxf(*(circle(17.1234567 * i, 3.7654321 * i, 0.31 + 1.37 * i, handle=f"C{i}") for i in range(1, 6)),
                      poly([(200.00013, 0.00017), (300.12345, 0.54321, 0.0123), (300.7, 90.1, -0.4), (200, 80, 0.9)]))
        for dialect in ("linuxcnc", "fanuc", "grbl"):
            moves, _ = self.job(drawing, "--kerf", "0.5", "--dialect", dialect, "--lead", "arc", "--lead-out", "1")
            arcs = [m for m in moves if m.code in (2, 3)]
            self.assertGreater(len(arcs), 10)
            for m in arcs:
                start, end = m.radii()
                self.assertLessEqual(abs(start - end), max(0.005, 0.001 * start) if dialect != "fanuc" else 0.005)

    def test_free_curves_stay_with_the_exact_offset(self):
        # An ellipse 60 x 30 as an SVG draws it; the exact offset of an ellipse has a closed form.
        for fit in ("minimal", "bisect"):
            moves, report = self.job(svg('<ellipse cx="50" cy="50" rx="30" ry="15"/>'), "--offset", "1", *PLAIN, "--fit",
                                     fit, "--dialect", "fanuc", name="e.svg")
            self.assertEqual(report["quality"]["g1_breaks"], 0)
            self.assertLessEqual(report["quality"]["max_deviation_mm"], 0.01)
            self.assertGreater(report["quality"]["max_deviation_mm"], 0)
            exact = []
            for i in range(20000):
                u = math.pi * i / 10000
                n = math.hypot(15 * math.cos(u), 30 * math.sin(u))
                exact.append((50 + (30 + 15 / n) * math.cos(u), 50 + (15 + 30 / n) * math.sin(u)))
            (chain,) = loops(moves)
            for p in (p for m in chain for p in m.points(4)):
                # Neighbours in angle are enough: the curve is convex.
                self.assertLessEqual(min(math.dist(p, q) for q in exact if abs(q[0] - p[0]) < 0.1), 0.01 + 3e-3)


class Process(Case):
    SETTING = ["--thickness", "2", "--power", "1800"]

    def test_kerf_from_process_knowledge(self):
        moves, report = self.job(dxf(rect(0, 0, 40, 40)), *self.SETTING, "--speed", "4000", *PLAIN)
        kerf = 0.0061 * 1800 / 4000 + 0.560
        p = report["parameters"]
        self.assertAlmostEqual(p["kerf_mm"], kerf, 12)
        self.assertAlmostEqual(p["kerf_mm"], 0.562745, 12)
        self.assertAlmostEqual(p["offset_mm"], kerf / 2, 12)
        self.assertEqual(p["kerf_model"]["thickness_mm"], 2.0)
        self.assertEqual(self.codes(report), [])
        self.assert_box(moves, -kerf / 2, -kerf / 2, 40 + kerf / 2, 40 + kerf / 2, near=1e-3)
        self.assertEqual({m.feed for m in moves if m.on}, {4000})
        self.assertEqual({m.power for m in moves if m.on}, {1800})

    def test_outside_the_permissible_range(self):
        for speed, nearest in (("9000", "5000"), ("100", "3000")):
            self.refused(dxf(rect(0, 0, 9, 9)), *self.SETTING, "--speed", speed, says=["nearest", nearest, "1800"])
        _, report = self.job(dxf(rect(0, 0, 9, 9)), *self.SETTING, "--speed", "9000", "--force")
        self.assertIs(report["parameters"]["kerf_model"]["permissible"], False)
        self.assertAlmostEqual(report["parameters"]["kerf_mm"], 0.0061 * 0.2 + 0.56, 12)

    def test_engraving_is_on_the_line_at_reduced_power(self):
        drawing = dxf(rect(0, 0, 40, 40, layer="CUT"), line(10, 10, 30, 10, layer="MARK"),
                      layers=[("CUT", 0, 7), ("MARK", 0, 5)])
        moves, report = self.job(drawing, "--kerf", "0.5", "--power", "1000", "--layers", "MARK=engrave")
        mark = [m for m in moves if m.on and m.power < 1000]
        self.assertAlmostEqual(sum(m.length() for m in mark), 20, 4)
        for m in mark:
            self.assertEqual(m.power, 200)
            self.assertEqual((m.a[1], m.b[1]), (10, 10))
        self.assertEqual(report["counts"]["engraved"], 1)
        self.assertEqual(report["counts"]["contours"], 1)

    def test_default_feed_is_said(self):
        moves, report = self.job(dxf(rect(0, 0, 9, 9)), "--kerf", "0.2")
        self.assertEqual({m.feed for m in moves if m.on}, {1000})
        self.assertEqual(self.codes(report), ["default_feed", "no_power"])


class Traps(Case):
    def test_units_of_dxf(self):
        for units, options, scale in ((4, [], 1), (1, [], 25.4), (6, [], 1000), (5, [], 10), (0, [], 1), (None, [], 1),
                                      (1, ["--units", "mm"], 1), (4, ["--units", "inch"], 25.4),
                                      (None, ["--units", "inch"], 25.4)):
            moves, report = self.job(dxf(rect(0, 0, 4, 3), units=units), "--side", "on", *PLAIN, *options)
            self.assert_box(moves, 0, 0, 4 * scale, 3 * scale)
            self.assertAlmostEqual(report["parameters"]["mm_per_unit"], scale)

    def test_inch_and_mm_make_the_same_part(self):
        d, e = 0.3, 25.4
        inch, report_inch = self.job(dxf(rect(0, 0, 2, 2), circle(1, 1, 0.5), units=1), "--offset", str(d), *PLAIN)
        nc = self.read("out.ngc")
        mm, report_mm = self.job(dxf(rect(0, 0, 2 * e, 2 * e), circle(e, e, 0.5 * e)), "--offset", str(d), *PLAIN)
        self.assertEqual(self.read("out.ngc"), nc)
        self.assertEqual(report_inch["counts"], report_mm["counts"])

    def test_units_of_svg(self):
        square = '<rect x="10" y="10" width="20" height="20"/>'
        px = 25.4 / 96
        for attributes, comment, options, scale in (
                ('width="100mm" height="100mm" viewBox="0 0 100 100"', "", [], 1),
                ('width="50mm" height="50mm" viewBox="0 0 100 100"', "", [], 0.5),
                ('width="10cm" height="10cm" viewBox="0 0 100 100"', "", [], 1),
                ('width="1in" height="1in" viewBox="0 0 100 100"', "", [], 0.254),
                ('width="100" height="100"', "", [], px),
                ('viewBox="0 0 100 100"', "", [], px),
                ('width="100" height="100" viewBox="0 0 100 100" '
                 'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" inkscape:version="0.48.4 r9939"', "", [],
                 25.4 / 90),
                ('width="100" height="100" viewBox="0 0 100 100" '
                 'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" inkscape:version="1.2 (dc2aeda)"', "", [],
                 px),
                ('width="100mm" height="100mm" viewBox="0 0 100 100" '
                 'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" inkscape:version="0.48.4 r9939"', "", [],
                 1),
                ('width="100px" height="100px" viewBox="0 0 100 100"',
                 "<!-- Generator: Adobe Illustrator 19.0.0, SVG Export Plug-In . SVG Version: 6.00 Build 0)  -->\n", [],
                 25.4 / 72),
                ('width="100" height="100"', "", ["--units", "mm"], 1),
                ('width="100mm" height="100mm" viewBox="0 0 100 100"', "", ["--units", "inch"], 25.4)):
            with self.subTest(attributes=attributes, options=options):
                moves, report = self.job(svg(square, attributes, comment), "--side", "on", *PLAIN, *options,
                                         name="part.svg")
                (chain,) = loops(moves)
                self.assertAlmostEqual(math.sqrt(abs(area(chain))), 20 * scale, delta=2e-3)
                self.assertAlmostEqual(report["parameters"]["mm_per_unit"], scale, places=9)

    def test_svg_y_points_up(self):
        moves, _ = self.job(svg('<rect x="10" y="10" width="20" height="5"/>'), "--side", "on", *PLAIN, name="p.svg")
        self.assert_box(moves, 10, 85, 30, 90)

    def test_hidden_layers_are_ignored_and_listed(self):
        drawing = dxf(rect(0, 0, 40, 40, layer="CUT"), circle(10, 10, 3, layer="FROZEN"), circle(20, 20, 3, layer="OFF"),
                      circle(30, 30, 3, layer="Defpoints"),
                      tags((0, "TEXT"), (8, "CUT"), (10, 1), (20, 1), (40, 2.5), (1, "hello")),
                      layers=[("CUT", 0, 7), ("FROZEN", 1, 7), ("OFF", 0, -7), ("Defpoints", 0, 7)])
        moves, report = self.job(drawing, "--side", "on", *PLAIN)
        self.assertEqual(len(loops(moves)), 1)
        self.assertEqual(report["counts"]["entities"], 1)
        self.assertEqual(sum(report["ignored"].values()), 4)
        self.assertIn("TEXT", report["ignored"])

    def test_layers(self):
        drawing = dxf(rect(0, 0, 40, 40, layer="CUT"), circle(10, 10, 3, layer="HELP"),
                      layers=[("CUT", 0, 7), ("HELP", 0, 1)])
        moves, report = self.job(drawing, "--side", "on", *PLAIN, "--layers", "HELP=ignore,CUT=cut")
        self.assertEqual(len(loops(moves)), 1)
        self.refused(drawing, "--side", "on", "--layers", "HLEP=ignore", expect=2, says=["HLEP", "CUT", "HELP"])
        self.refused(drawing, "--side", "on", "--layers", "HELP=burn", expect=2, says=["HELP=burn"])
        self.refused(drawing, "--side", "on", "--layers", "CUT=ignore,HELP=ignore", says=["nothing"])

    def test_damaged_files(self):
        whole = dxf(rect(0, 0, 40, 40), circle(10, 10, 3))
        self.refused(b"AutoCAD Binary DXF\r\n\x1a\x00" + b"\x00" * 100, "--kerf", "0.2", says=["part.dxf", "binary"])
        self.refused(whole[:-len("0\nEOF\n")], "--kerf", "0.2", says=["part.dxf"])
        self.refused(whole[:len(whole) // 2], "--kerf", "0.2", says=["part.dxf"])
        self.refused("", "--kerf", "0.2", says=["part.dxf"])
        self.refused("AC1032\0\0\0\0\0", "--kerf", "0.2", says=["part.dxf"])
        self.refused("<svg", "--kerf", "0.2", name="part.svg", says=["part.svg:1:"])
        self.refused(svg('<path d="M 0 0 L 10 x"/>'), "--kerf", "0.2", name="part.svg", says=["part.svg"])
        self.refused(dxf(), "--kerf", "0.2", says=["nothing to cut"])
        self.refused(b"hello", "--kerf", "0.2", name="part.pdf", expect=2, says=["part.pdf", ".dxf"])
        done = self.burin("none.dxf", "--kerf", "0.2", expect=1)
        self.assertIn("none.dxf", done.stderr)

    def test_vanished_contours(self):
        moves, report = self.job(dxf(rect(0, 0, 40, 40), circle(10, 10, 0.2, handle="77")), "--offset", "0.3", expect=3)
        self.assertEqual(len(loops(moves)), 1)
        (w,) = [w for w in report["warnings"] if w["code"] == "contour_vanished"]
        self.assertIn("77", w["entity"])
        self.assertAlmostEqual(math.dist(w["position_mm"][:2], (10, 10)), 0.2)
        self.assertIn("contour_vanished", self.last.stderr)
        self.refused(dxf(circle(10, 10, 0.2)), "--offset", "-0.3", says=["nothing left to cut"])

    def test_gap_of_exactly_the_kerf(self):
        # Two parts whose paths would coincide: whatever is decided, it must be said or be exact.
        moves, report = self.job(dxf(rect(0, 0, 10, 10), rect(10.5, 0, 20, 10, handle="B2")), "--kerf", "0.5", *PLAIN,
                                 expect=self.any_of(0, 3))
        total = sum(abs(area(c)) for c in loops(moves))
        alone = lambda w: w * 10 + 2 * (w + 10) * 0.25 + math.pi * 0.0625
        self.assertAlmostEqual(total, alone(10) + alone(9.5), delta=0.02)

    def test_merging_holes(self):
        moves, report = self.job(dxf(rect(0, 0, 40, 20), rect(5, 5, 19.8, 15, handle="B2"),
                                     rect(20.2, 5, 35, 15, handle="B3")), "--offset", "-0.3", expect=3)
        self.assertEqual(len(loops(moves)), 2)
        self.assertIn("contours_merged", self.codes(report))

    def test_open_chains(self):
        moves, report = self.job(dxf(rect(0, 0, 40, 40), line(5, 5, 20, 5, handle="L1"), line(20, 5, 20, 20, handle="L2")),
                                 "--offset", "0.3", *PLAIN, expect=3)
        self.assertEqual(report["counts"]["open"], 1)
        self.assertEqual(report["counts"]["contours"], 2)
        chain = loops(moves)[1]
        self.assertAlmostEqual(sum(m.length() for m in chain), 30, 4)
        self.assertEqual({chain[0].a, chain[-1].b}, {(5, 5), (20, 20)})
        (w,) = [w for w in report["warnings"] if w["code"] == "open_chain"]
        self.assertIn("L1", w["entity"])

    def test_joins_and_duplicates_are_fine(self):
        sides = [line(0, 0, 10, 0), line(10.004, 0.003, 10, 10), line(10, 10, 0, 10), line(0, 10, 0, 0)]
        moves, report = self.job(dxf(*sides), "--offset", "0.1", *PLAIN)
        self.assertEqual(self.codes(report), ["default_feed", "ends_joined", "no_power"])
        self.assertEqual(len(loops(moves)), 1)
        self.assertIn("open_chain", self.codes(self.job(dxf(*sides), "--offset", "0.1", "--join", "0.001", expect=3)[1]))
        moves, report = self.job(dxf(rect(0, 0, 10, 10), line(10, 0, 0, 0), rect(0, 0, 10, 10)), "--offset", "0.1",
                                 *PLAIN)
        self.assertEqual(len(loops(moves)), 1)
        self.assertIn("duplicate_removed", self.codes(report))

    def test_first_and_last_vertex_nearly_the_same(self):
        moves, report = self.job(dxf(poly([(0, 0), (10, 0), (10, 10), (0, 10), (1e-6, -1e-6)])), "--offset", "0.2", *PLAIN)
        (chain,) = loops(moves)
        self.assertAlmostEqual(abs(area(chain)), 100 + 8 + 0.04 * math.pi, delta=2e-3)
        self.assertEqual(report["counts"]["contours"], 1)

    def test_zero_width_ring(self):
        # Out and back along the same line, and a ring whose hole is its outline: nothing but what is said is cut.
        moves, report = self.job(dxf(poly([(0, 0), (10, 0), (10, 10), (10, 0)])), "--offset", "0.2", *PLAIN, expect=3)
        self.assertEqual(self.codes(report), ["default_feed", "duplicate_removed", "no_power", "open_chain"])
        self.assertAlmostEqual(sum(m.length() for m in moves if m.on), 20, delta=1e-3)
        moves, report = self.job(dxf(circle(0, 0, 10), circle(0, 0, 10, handle="C2")), "--offset", "0.2", *PLAIN)
        self.assertEqual(self.codes(report), ["default_feed", "duplicate_removed", "no_power"])
        self.assertEqual(len(loops(moves)), 1)

    def test_crossing_contours(self):
        eight = poly([(0, 0), (10, 10), (10, 0), (0, 10)], handle="E8")
        moves, report = self.job(dxf(rect(20, 0, 40, 20), eight), "--offset", "0.3", expect=3)
        self.assertEqual(len(loops(moves)), 1)
        (w,) = [w for w in report["warnings"] if w["code"] == "self_crossing"]
        self.assertIn("E8", w["entity"])
        self.assertAlmostEqual(math.dist(w["position_mm"][:2], (5, 5)), 0, delta=1e-6)
        self.refused(dxf(eight), "--offset", "0.3", says=["E8", "nothing left to cut"])
        self.refused(dxf(rect(0, 0, 10, 10), rect(5, 5, 15, 15, handle="B2")), "--offset", "0.3", says=["cross"])
        # Less deep than the tolerance: repaired and said.
        moves, report = self.job(dxf(rect(0, 0, 10, 10), rect(9.995, 2, 20, 8, handle="B2")), "--offset", "0.3",
                                 expect=self.any_of(0, 3))
        self.assertIn("crossing_repaired", self.codes(report))

    def test_mirrored_arcs(self):
        # Extrusion (0, 0, -1) and a negative INSERT scale: the bulge turns with the mirror.
        half_moon = [(0, 0), (10, 0, 1.0), (10, 10), (0, 10)]
        straight = 100 + 12.5 * math.pi
        for drawing, x in ((dxf(poly(half_moon)), (0, 15)), (dxf(poly(half_moon, extrusion=-1.0)), (-15, 0)),
                           (dxf(tags((0, "INSERT"), (8, "0"), (2, "M"), (10, 0), (20, 0), (41, -1.0), (42, 1.0)),
                                blocks=tags((0, "BLOCK"), (8, "0"), (2, "M"), (70, 0), (10, 0), (20, 0), (30, 0)) +
                                poly(half_moon) + tags((0, "ENDBLK"), (8, "0"))), (-15, 0))):
            moves, _ = self.job(drawing, "--side", "on", *PLAIN)
            (chain,) = loops(moves)
            self.assertAlmostEqual(abs(area(chain)), straight, delta=5e-3)
            self.assert_box(moves, x[0], 0, x[1], 10)

    def test_nested_and_arrayed_blocks(self):
        def block(name, body):
            return (tags((0, "BLOCK"), (8, "0"), (2, name), (70, 0), (10, 0), (20, 0), (30, 0)) + body +
                    tags((0, "ENDBLK"), (8, "0")))
        blocks = (block("HOLE", circle(0, 0, 1)) +
                  block("PAIR", tags((0, "INSERT"), (8, "0"), (2, "HOLE"), (10, 0), (20, 0), (70, 2), (44, 5.0))))
        drawing = dxf(rect(-5, -5, 40, 40),
                      tags((0, "INSERT"), (8, "0"), (2, "PAIR"), (10, 0), (20, 0), (70, 3), (71, 2), (44, 12.0),
                           (45, 20.0)), blocks=blocks)
        moves, report = self.job(drawing, "--offset", "0.1", *PLAIN)
        self.assertEqual(report["counts"]["entities"], 1 + 12)
        centers = sorted((round(c[0].center[0], 3), round(c[0].center[1], 3))
                         for c in loops(moves)[1:])
        self.assertEqual(centers, sorted((12.0 * i + 5.0 * k, 20.0 * j) for i in range(3) for j in range(2)
                                         for k in range(2)))

    def test_spline_by_fit_points_only(self):
        n = 24
        points = [(10 * math.cos(2 * math.pi * i / n), 10 * math.sin(2 * math.pi * i / n)) for i in range(n + 1)]
        spline = tags((0, "SPLINE"), (5, "5F"), (8, "0"), (70, 11), (71, 3), (72, 0), (73, 0), (74, n + 1))
        spline += "".join(tags((11, x), (21, y), (31, 0.0)) for x, y in points)
        moves, report = self.job(dxf(spline), "--offset", "0.5", *PLAIN)
        (chain,) = loops(moves)
        for p in (p for m in chain for p in m.points(6)):
            self.assertAlmostEqual(math.hypot(*p), 10.5, delta=0.02)
        self.assertEqual(report["quality"]["g1_breaks"], 0)


class Usage(Case):
    def test_missing_and_impossible_values(self):
        part = dxf(rect(0, 0, 40, 40))
        self.refused(part, expect=2, says=["kerf"])
        self.refused(part, "--thickness", "2", "--power", "1800", expect=2, says=["--speed"])
        self.refused(part, "--kerf", "0.2", "--offset", "0.1", expect=2, says=["--kerf"])
        for option, values in {"--kerf": ("-1", "nan", "x", "1,5", "inf"), "--offset": ("nan", "x", "1e9"),
                               "--tolerance": ("0", "-1", "x"), "--join": ("-1", "x"), "--lead-length": ("0", "-2"),
                               "--power": ("-5", "x"), "--speed": ("0", "-5"), "--side": ("left",),
                               "--fit": ("best",), "--corners": ("sharp",), "--lead": ("spiral",),
                               "--order": ("random",), "--units": ("furlong",), "--dialect": ("siemens",),
                               "--threads": ("0", "x"), "--copies": ("0x3", "axb", "3x"), "--thickness": ("0", "-1")}.items():
            for value in values:
                given = [] if option in ("--kerf", "--offset") else ["--kerf", "0.2"]
                self.refused(part, *given, f"{option}={value}", expect=2, says=[option])
        self.refused(part, "--kerf", "0.2", "--tolerence", "0.1", expect=2, says=["--tolerance"])
        self.assertEqual(self.burin("--kerf", "0.2", expect=2).stdout, "")

    def test_default_output(self):
        self.write("my.part.dxf", dxf(rect(0, 0, 40, 40)))
        self.burin("my.part.dxf", "--kerf", "0.2", "--quiet")
        self.assertEqual(self.names(), ["my.part.dxf", "my.part.ngc"])
        os.mkdir(self.path("sub"))
        self.write("sub/b.svg", svg('<circle cx="50" cy="50" r="10"/>'))
        self.burin("sub/b.svg", "--kerf", "0.2")
        self.assertEqual(sorted(os.listdir(self.path("sub"))), ["b.ngc", "b.svg"])

    def test_standard_output(self):
        self.write("p.dxf", dxf(rect(0, 0, 40, 40)))
        done = self.burin("p.dxf", "--kerf", "0.2", "-o", "-")
        self.assertEqual(len(loops(read_nc(done.stdout))), 1)
        self.assertEqual(self.names(), ["p.dxf"])
        self.assertEqual(self.burin("p.dxf", "--kerf", "0.2", "-o", "-", "--quiet").stderr, "")
        json.loads(self.burin("p.dxf", "--kerf", "0.2", "--json", "-").stdout)
        self.burin("p.dxf", "--kerf", "0.2", "-o", "-", "--json", "-", expect=2)

    def test_outputs_are_all_or_nothing(self):
        self.write("p.dxf", dxf(rect(0, 0, 40, 40)))
        done = self.burin("p.dxf", "--kerf", "0.2", "-o", "none/p.ngc", "--json", "j.json", expect=1)
        self.assertIn("none/p.ngc", done.stderr)
        self.assertEqual(self.names(), ["p.dxf"])
        self.burin("p.dxf", "--kerf", "0.2", "-o", "p.ngc", "--json", "none/j.json", expect=1)
        self.assertEqual(self.names(), ["p.dxf"])
        if os.geteuid() != 0:
            os.mkdir(self.path("locked"))
            os.chmod(self.path("locked"), stat.S_IRUSR | stat.S_IXUSR)
            self.burin("p.dxf", "--kerf", "0.2", "-o", "locked/p.ngc", expect=1)
            self.assertEqual(os.listdir(self.path("locked")), [])

    def test_output_over_input_is_refused(self):
        drawing = dxf(rect(0, 0, 40, 40))
        self.write("p.dxf", drawing)
        for args in (("-o", "p.dxf"), ("-o", "./p.dxf"), ("-o", "x.ngc", "--json", "p.dxf"),
                     ("-o", "x.ngc", "--html", "x.ngc")):
            self.burin("p.dxf", "--kerf", "0.2", *args, expect=2)
            self.assertEqual(self.names(), ["p.dxf"])
            self.assertEqual(self.read("p.dxf"), drawing)


class Reports(Case):
    OUTPUTS = ("out.ngc", "out.cl", "out.svg", "out.html", "out.json")

    def example(self, name, *args, expect=0):
        folder = os.path.join(EXAMPLES, name)
        (drawing,) = [f for f in sorted(os.listdir(folder)) if f.endswith((".dxf", ".svg"))]
        with open(os.path.join(folder, drawing), "rb") as f:
            self.write(drawing, f.read())
        self.burin(drawing, *args, "-o", "out.ngc", "--cl", "out.cl", "--svg", "out.svg", "--html", "out.html", "--json",
                   "out.json", expect=expect)
        return read_nc(self.read("out.ngc")), json.loads(self.read("out.json"))

    def test_examples(self):
        _, k = self.example("k", "--offset", "0.28", "--tolerance", "0.1", *PLAIN)
        self.assertEqual((k["counts"]["entities"], k["counts"]["contours"], k["counts"]["outer"]), (13, 1, 1))
        self.assertLessEqual(k["quality"]["max_deviation_mm"], 0.1)
        self.assertEqual(k["quality"]["g1_breaks"], 0)
        self.assertLessEqual(k["counts"]["fitted_segments"], 48)
        moves, bracket = self.example("bracket", "--thickness", "2", "--power", "1800", "--speed", "4000", "--layers",
                                      "MARK=engrave,CENTER=ignore")
        self.assertEqual(bracket["counts"]["outer"], 1)
        self.assertEqual(bracket["counts"]["holes"], 7)
        self.assertLessEqual(bracket["quality"]["max_deviation_mm"], 0.01)
        self.assertEqual(len({m.power for m in moves if m.on}), 2)
        _, box = self.example("box", "--kerf", "0.2", "--layers", "mark=engrave")
        self.assertEqual((box["counts"]["outer"], box["counts"]["holes"]), (1, 6))
        self.assertEqual(box["quality"]["g1_breaks"], 0)

    def test_keys(self):
        _, report = self.example("k", "--kerf", "0.56")
        for key in ("operation", "version", "input", "inputs_sha256", "parameters", "counts", "lengths_mm", "time_s",
                    "quality", "warnings", "outputs"):
            self.assertIn(key, report)
        self.assertEqual(report["operation"], "laser")
        self.assertEqual(report["input"], "k.dxf")
        self.assertEqual(sorted(report["outputs"]), sorted(self.OUTPUTS))
        for key in ("entities", "contours", "outer", "holes", "open", "arcs", "lines", "pierces"):
            self.assertIsInstance(report["counts"][key], int, key)
        self.assertEqual(set(report["lengths_mm"]), {"cut", "rapid", "lead"})
        for key in ("max_deviation_mm", "g1_breaks"):
            self.assertIn(key, report["quality"])
        for key in ("kerf_mm", "offset_mm", "kerf_model", "lead_length_mm"):
            self.assertIn(key, report["parameters"])
        self.assertIsNone(report["parameters"]["kerf_model"])
        self.assertEqual(report["parameters"]["lead_length_mm"], 2)
        for w in report["warnings"]:
            self.assertLessEqual({"code", "entity", "position_mm", "message"}, set(w))

    def test_pages_fetch_nothing(self):
        self.example("bracket", "--kerf", "0.4", "--layers", "MARK=engrave,CENTER=ignore")
        for name in ("out.html", "out.svg"):
            text = self.read(name)
            self.assertEqual(set(re.findall(r"https?://[^\s\"'<>)]+", text)) - {"http://www.w3.org/2000/svg",
                                                                               "http://www.w3.org/1999/xlink"}, set())
            self.assertNotRegex(text, r"<script[^>]+src|<link[^>]+href|@import|url\((?!#)")
        self.assertTrue(self.read("out.html").lstrip().lower().startswith("<!doctype html"))

    def test_a_hostile_name_stays_text(self):
        name = 'a<script>alert(1)</script>&"b.dxf'.replace("/", "_")
        self.write(name, dxf(rect(0, 0, 9, 9, handle="B1"), circle(4, 4, 0.01, handle="C1")))
        self.burin(name, "--kerf", "0.4", "-o", "out.ngc", "--html", "out.html", "--svg", "out.svg", expect=3)
        for page in ("out.html", "out.svg"):
            self.assertNotIn("<script>alert", self.read(page))
        read_nc(self.read("out.ngc"))

    def test_the_same_twice_and_with_any_threads(self):
        def once(*args):
            self.example("box", "--kerf", "0.2", "--layers", "mark=engrave", *args)
            kept = {}
            for name in self.OUTPUTS:
                text = self.read(name)
                if name == "out.json":
                    report = json.loads(text)
                    del report["time_s"]
                    text = json.dumps(report)
                kept[name] = text
            return kept
        first = once()
        self.assertEqual(once(), first)
        # The page quotes the command line, which differs by the option itself.
        one, two = once("--threads", "1"), once("--threads", "2")
        for name in self.OUTPUTS:
            self.assertEqual(one[name].replace("--threads 1", "--threads 2"), two[name], name)
        self.assertEqual(one["out.ngc"], first["out.ngc"])

    def test_cl_goes_through_the_post_to_the_same_nc(self):
        self.example("bracket", "--kerf", "0.4", "--layers", "MARK=engrave,CENTER=ignore", "--power", "900")
        done = subprocess.run([BURIN, "post", "out.cl", "--machine", "laser-xy", "--dialect", "linuxcnc", "-o", "again.ngc"],
                              capture_output=True, text=True, cwd=self.folder, env=self.env, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        def body(text):
            return [l for l in text.splitlines() if not l.startswith("(")]
        self.assertEqual(body(self.read("again.ngc")), body(self.read("out.ngc")))


if __name__ == "__main__":
    BURIN = os.path.abspath(sys.argv.pop(1))
    unittest.main()
