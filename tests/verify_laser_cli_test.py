#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`burin verify DRAWING --kerf MM --path PROGRAM` from outside: the examples are clean in every dialect and as CL; faults of known
size, planted in the programs of burin laser and written here, are found with figure, place and line. usage:
verify_laser_cli_test.py PATH/TO/burin"""
import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest

BURIN = ""
EXAMPLES = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "examples")
KERF = 0.2
RADIUS = KERF / 2
FIT = 0.01  # tolerance of burin laser
PLATE = '<rect id="plate" x="10" y="10" width="60" height="40"/><circle id="hole" cx="40" cy="30" r="8"/>'


def svg(shapes):
    return f'<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">{shapes}</svg>'


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = folder.name

    def path(self, name):
        return os.path.join(self.dir, name)

    def write(self, name, text):
        with open(self.path(name), "w") as f:
            f.write(text)
        return self.path(name)

    def read(self, name):
        with open(self.path(name)) as f:
            return f.read()

    def burin(self, *args, code=0):
        run = subprocess.run([BURIN, *map(str, args)], capture_output=True, text=True, timeout=120, cwd=self.dir)
        self.assertEqual(run.returncode, code, run.stderr + run.stdout)
        return run

    def laser(self, drawing, *more, out="part.ngc", code=0):
        self.burin("laser", drawing, "--kerf", KERF, "--power", 500, "--speed", 2000, "-o", out, *more, code=code)
        return self.path(out)

    def verify(self, drawing, program, *more, code=0):
        self.burin("verify", drawing, "--kerf", KERF, "--path", program, "--json", self.path("v.json"), *more, code=code)
        return json.loads(self.read("v.json"))

    def plate(self, *more):
        drawing = self.write("plate.svg", svg(PLATE))
        return drawing, self.laser(drawing, "--lead", "none", *more)

    def assert_clean(self, report, fit=FIT):
        q = report["quality"]
        self.assertLessEqual(q["bound_mm"], 0.001)
        self.assertLessEqual(q["gouge_max_mm"], fit + q["bound_mm"])
        self.assertLessEqual(q["excess_max_mm"], fit + q["bound_mm"])
        self.assertEqual((q["gouge_area_mm2"], q["excess_area_mm2"]), (0, 0))
        self.assertEqual(report["lengths_mm"]["uncut"], 0)


class Clean(Case):
    def test_examples_in_every_dialect(self):
        for name, drawing, code in (("k", "k/k.dxf", 0), ("bracket", "bracket/bracket.dxf", 3), ("box", "box/box.svg", 3)):
            drawing = os.path.join(EXAMPLES, drawing)
            for dialect in ("linuxcnc", "fanuc", "grbl"):
                with self.subTest(name=name, dialect=dialect):
                    self.laser(drawing, "--dialect", dialect, "--cl", self.path("part.cl"), code=code)
                    self.assert_clean(self.verify(drawing, "part.ngc", code=self.left_out(drawing)))
            self.assert_clean(self.verify(drawing, "part.cl", code=self.left_out(drawing)))

    def left_out(self, drawing):
        """Open lines of a drawing are said to be cut on the line: 3, as of burin laser."""
        return 0 if drawing.endswith("k.dxf") else 3

    def test_leads_loops_and_overcut(self):
        drawing = self.write("plate.svg", svg(PLATE))
        for more in (["--lead", "line"], ["--corners", "loop"], ["--overcut", "1", "--lead-out", "1"], ["--no-arcs"],
                     ["--direction", "conventional"]):
            with self.subTest(more=more):
                self.assert_clean(self.verify(drawing, self.laser(drawing, *more)))

    def test_csv_and_sides(self):
        drawing, program = self.plate()
        self.verify(drawing, program, "--csv", self.path("v.csv"))
        with open(self.path("v.csv")) as f:
            rows = list(csv.DictReader(f))
        self.assertGreater(len(rows), 100)
        self.assertLess(max(abs(float(r["deviation_mm"])) for r in rows), 0.001)
        one = self.write("one.svg", svg('<circle cx="40" cy="30" r="8"/>'))
        inside = self.laser(one, "--side", "inside", "--lead", "none", out="inside.ngc")
        self.assert_clean(self.verify(one, inside, "--side", "inside"))
        q = self.verify(one, inside)["quality"]
        self.assertAlmostEqual(q["gouge_max_mm"], KERF, delta=q["bound_mm"] + 0.001)


class Faults(Case):
    def test_wrong_kerf(self):
        drawing, program = self.plate()
        for kerf in (0.3, 0.1):
            self.burin("verify", drawing, "--kerf", kerf, "--path", program, "--json", self.path("v.json"))
            q = json.loads(self.read("v.json"))["quality"]
            which = "gouge" if kerf > KERF else "excess"
            self.assertAlmostEqual(q[which + "_max_mm"], 0.05, delta=q["bound_mm"] + 2e-4)
            self.assertAlmostEqual(q[which + "_area_mm2"], 0.05 * (200 + 16 * math.pi), delta=0.3)

    def test_beam_that_stays_on(self):
        drawing, program = self.plate("--order", "file")
        lines = self.read("part.ngc").splitlines()
        first = next(i for i, line in enumerate(lines) if line.strip() == "M5")
        # Without the first M5 (and the M3 after it) the beam crosses the part on the rapid to the next contour.
        report = self.verify(drawing, self.write("on.ngc", "\n".join(lines[:first] + lines[first + 1:])))
        q = report["quality"]
        self.assertGreater(q["gouge_max_mm"], 1)
        self.assertIn("G00", "\n".join(lines[:first] + lines[first + 1:]).splitlines()[q["gouge_line"] - 1])
        self.burin("verify", drawing, "--kerf", KERF, "--path", "on.ngc", "--max-gouge", 0.05, code=1)

    def test_one_digit(self):
        drawing = self.write("plate.svg", svg('<rect id="plate" x="10" y="10" width="60" height="40"/>'))
        good = "G21 G90\nG0 X9.9 Y49.9\nM3 S500\nG1 X70.1 F2000\nY90.1\nX9.9\nY49.9\nM5\nM2\n"
        self.assert_clean(self.verify(drawing, self.write("good.ngc", good)), fit=0)
        for digit, which, size in (("X70.0", "gouge", 0.1), ("X70.3", "excess", 0.2)):
            q = self.verify(drawing, self.write("digit.ngc", good.replace("X70.1", digit)))["quality"]
            self.assertAlmostEqual(q[which + "_max_mm"], size, delta=q["bound_mm"] + 1e-6)
            self.assertIn(q[which + "_line"], (4, 5))
            self.assertAlmostEqual(q[which + "_at_mm"][0], 69.9 if which == "gouge" else 70, delta=1e-3)

    def test_wrong_centre(self):
        drawing, program = self.plate("--dialect", "linuxcnc")
        text = self.read("part.ngc")
        # All of the hole 0.04 mm to the right: gouge there, excess on the left.
        moved = re.sub(r"\(contour 2.*?M5", lambda m: re.sub(r"X([-\d.]+)", lambda x: f"X{float(x[1]) + 0.04:.4f}", m[0]), text,
                       flags=re.S)
        self.assertNotEqual(moved, text)
        q = self.verify(drawing, self.write("moved.ngc", moved))["quality"]
        for which in ("gouge", "excess"):
            self.assertAlmostEqual(q[which + "_max_mm"], 0.04, delta=q["bound_mm"] + 2e-4)

    def test_missing_contour(self):
        drawing, program = self.plate()
        text = self.read("part.ngc")
        without = re.sub(r"\(contour 2.*?M5\n", "F2000\n", text, flags=re.S)
        self.assertNotEqual(without, text)
        report = self.verify(drawing, self.write("missing.ngc", without), code=3)
        self.assertAlmostEqual(report["lengths_mm"]["uncut"], 16 * math.pi, delta=0.01)
        self.assertTrue(any(w["code"] == "uncut" and "hole" in w["message"] for w in report["warnings"]), report["warnings"])
        self.assertLess(report["quality"]["gouge_max_mm"], 0.001)

    def test_wrong_side_in_cl(self):
        drawing = self.write("plate.svg", svg(PLATE))
        self.burin("laser", drawing, "--offset", -RADIUS, "--lead", "none", "--power", 500, "--speed", 2000, "-o", "w.ngc", "--cl",
                   self.path("wrong.cl"))
        # Beside the corners of the plate the edge is out of the beam's reach.
        q = self.verify(drawing, "wrong.cl", code=3)["quality"]
        self.assertAlmostEqual(q["gouge_max_mm"], KERF, delta=q["bound_mm"] + 2e-4)
        self.assertAlmostEqual(q["gouge_area_mm2"], KERF * (200 + 16 * math.pi), delta=0.5)


class BadInput(Case):
    def test_messages(self):
        drawing, program = self.plate()
        run = self.burin("verify", drawing, "--path", program, code=2)
        self.assertIn("--kerf", run.stderr)
        self.burin("verify", drawing, "--kerf", 0, "--path", program, code=2)
        self.burin("verify", drawing, "--kerf", KERF, "--path", self.write("bad.ngc", "G1 X1 Y\n"), code=1)
        self.burin("verify", self.write("empty.svg", svg("")), "--kerf", KERF, "--path", program, code=1)
        self.burin("verify", drawing, "--kerf", KERF, "--path", program, "--layers", "nosuch=cut", code=2)
        self.burin("verify", drawing, "--kerf", KERF, "--path", program, "--spacing", "1e-9", code=1)


if __name__ == "__main__":
    BURIN = os.path.abspath(sys.argv.pop(1))
    unittest.main()
