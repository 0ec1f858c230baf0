#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The contract of `burin verify` from outside: planted faults of known size in programs of burin rotary, orient and cycle and in
programs written here; the figures against closed forms, within the bound that the report states. Bad input.
usage: verify_cli_test.py PATH/TO/burin"""
import csv
import json
import math
import os
import re
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

import numpy as np

BURIN = ""
MEMORY = 4 << 30  # bytes a run may take


# --- parts and paths --------------------------------------------------------------------------------------------------

def stl(triangles):
    out = b"part".ljust(80) + struct.pack("<I", len(triangles))
    for t in triangles:
        n = np.cross(np.subtract(t[1], t[0]), np.subtract(t[2], t[0]))
        out += struct.pack("<12fH", *(n / (np.linalg.norm(n) or 1)), *t[0], *t[1], *t[2], 0)
    return out


def quad(a, b, c, d):
    return [(a, b, c), (a, c, d)]


def plate(x=20.0, y=20.0, z=0.0):
    return quad((-x, -y, z), (x, -y, z), (x, y, z), (-x, y, z))


def block(lo, hi):
    """A closed box, triangles counter-clockwise from outside."""
    (x0, y0, z0), (x1, y1, z1) = lo, hi
    return (quad((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)) + quad((x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0))
            + quad((x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)) + quad((x0, y1, z0), (x0, y1, z1), (x1, y1, z1), (x1, y1, z0))
            + quad((x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)) + quad((x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)))


def circle_dxf(radius):
    pairs = [(0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1015"), (9, "$INSUNITS"), (70, 4), (0, "ENDSEC"), (0, "SECTION"),
             (2, "ENTITIES"), (0, "CIRCLE"), (5, "1F"), (100, "AcDbEntity"), (8, "0"), (100, "AcDbCircle"), (10, 0.0), (20, 0.0), (40, radius),
             (0, "ENDSEC"), (0, "EOF")]
    return "".join(f"{code}\n{value}\n" for code, value in pairs)


def raster(step=2.0, size=20.0, over=8.0, skip=None, z=0.0, cutter="10.0,5.0"):
    """Lines along X over the plate and beyond, lifted between."""
    lines = [f"CUTTER/{cutter}", "LOADTL/1", "FEDRAT/500,MMPM"]
    reach, n = size + over, int(round(size / step))
    for i in range(-n, n + 1):
        if i == skip:
            continue
        a, b = (-reach, reach) if i % 2 == 0 else (reach, -reach)
        y = i * step
        lines += ["RAPID", f"GOTO/{a},{y},20.0", f"GOTO/{a},{y},{z}", f"GOTO/{b},{y},{z}", "RAPID", f"GOTO/{b},{y},20.0"]
    return lines + ["FINI"]


TOOL = '[tool]\nkind = "ball"\nradius = 5.0\nshank_length = 40.0\nholder = [{ radius = 12.0, height = 30.0 }]\n'
FLAT = '[tool]\nkind = "flat"\nradius = 8.0\nlength = 30.0\nholder = [{ radius = 20.0, height = 50.0 }]\n'


def limits():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


class Case(unittest.TestCase):
    def setUp(self):
        self.dir = tempfile.mkdtemp(prefix="burin-verify-")
        self.addCleanup(shutil.rmtree, self.dir, ignore_errors=True)

    def path(self, name):
        return os.path.join(self.dir, name)

    def write(self, name, content):
        with open(self.path(name), "wb") as f:
            f.write(content if isinstance(content, bytes) else content.encode())
        return name

    def run_burin(self, *args, expect=0):
        p = subprocess.run([BURIN, *args], cwd=self.dir, capture_output=True, text=True, timeout=300, preexec_fn=limits)
        self.assertEqual(p.returncode, expect, f"{args}\n{p.stdout}{p.stderr}")
        return p

    def verify(self, *args, expect=0):
        if "--spacing" not in args and "--csv" not in args:
            args = (*args, "--samples", "3000")
        p = self.run_burin("verify", *args, "--json", "report.json", expect=expect)
        with open(self.path("report.json")) as f:
            self.report = json.load(f)
        os.remove(self.path("report.json"))
        self.said = p.stderr
        return self.report["quality"]

    def near(self, figure, expected, quality, more=0.0):
        self.assertLessEqual(abs(figure - expected), quality["bound_mm"] + more, f"{figure} instead of {expected}")

    def plate_job(self, extra="", tool=TOOL, machine="none", triangles=None):
        self.write("plate.stl", stl(triangles or plate()))
        return self.write("plate.toml", f'[part]\nmesh = "plate.stl"\n{tool}[operation]\ntolerance = 0.01\nscallop = 0.1\n'
                                        f'[machine]\nname = "{machine}"\n{extra}')


def scallop(radius, step):
    return radius - math.sqrt(radius * radius - step * step / 4)


class PlaneTest(Case):
    """A ball and a flat end over a plane: everything is known."""

    def test_clean(self):
        job = self.plate_job()
        path = self.write("path.cl", "\n".join(raster()))
        q = self.verify(job, "--path", path, "--max-gouge", "0.01", "--max-excess", "0.11", "--csv", "points.csv")
        self.assertLessEqual(q["gouge_max_mm"], q["bound_mm"])
        self.near(q["excess_max_mm"], scallop(5, 2), q)
        self.assertLessEqual(q["bound_mm"], 0.002)
        self.assertEqual(q["collisions"], [])
        self.assertEqual(q["unmachined_area_mm2"], 0)
        with open(self.path("points.csv"), newline="") as f:
            rows = list(csv.DictReader(f))
        self.assertEqual(len(rows), self.report["counts"]["samples"])
        for row in rows[:: max(1, len(rows) // 500)]:
            off = float(row["y"]) % 2
            off = min(off, 2 - off)
            self.near(float(row["deviation_mm"]), 5 - math.sqrt(25 - off * off), q)
        total = sum(q["histogram"]["area_mm2"])
        self.assertAlmostEqual(total, q["area_mm2"], delta=1e-3 * total)
        self.assertAlmostEqual(q["area_mm2"], 1600, delta=1e-3)
        # The same for any number of threads, and a narrower limit fails but writes.
        self.assertEqual(self.verify(job, "--path", path, "--threads", "1", "--csv", "again.csv")["excess_max_mm"], q["excess_max_mm"])
        self.verify(job, "--path", path, "--max-excess", "0.09", expect=1)

    def test_a_point_too_deep(self):
        job = self.plate_job()
        lines = raster()
        i = next(k for k, line in enumerate(lines) if line == "GOTO/28.0,0.0,0.0")
        lines.insert(i, "GOTO/3.0,0.0,-0.05")
        q = self.verify(job, "--path", self.write("deep.cl", "\n".join(lines)), "--max-gouge", "0.01", expect=1)
        self.near(q["gouge_max_mm"], 0.05, q)
        np.testing.assert_allclose(q["gouge_at_mm"], [3, 0, 0], atol=0.7)
        move = sum(line.startswith("GOTO/") for line in lines[:i])
        self.assertIn(q["gouge_move"], (move, move + 1))
        self.assertIn(q["gouge_line"], (i + 1, i + 2))
        self.assertIn("--max-gouge 0.01", self.said)

    def test_a_skipped_path(self):
        job = self.plate_job()
        q = self.verify(job, "--path", self.write("skipped.cl", "\n".join(raster(skip=3))), "--max-excess", "0.11", expect=1)
        self.near(q["excess_max_mm"], scallop(5, 4), q)
        self.assertAlmostEqual(q["excess_at_mm"][1], 6, delta=0.1)
        # So many skipped that nothing comes near.
        lines = raster(step=12.0)
        q = self.verify(job, "--path", self.write("few.cl", "\n".join(lines)), "--reach", "1", expect=3)
        # Paths at -24, -12, 0, 12 and 24: within 3 mm of each the ball of 5 mm leaves up to 1 mm.
        self.assertAlmostEqual(q["unmachined_area_mm2"], 40 * (6 + 6 + 5 + 5), delta=40)

    def test_a_wrong_radius(self):
        # A wall at x = 0 beside the path of a flat end.
        self.write("wall.stl", stl(quad((0, -20, 0), (0, -20, 20), (0, 20, 20), (0, 20, 0)) + plate(0.5)))
        self.write("wall.stl", stl(quad((0, -20, 0), (0, 20, 0), (0, 20, 20), (0, -20, 20))[::-1]))
        path = self.write("wall.cl", "CUTTER/16\nLOADTL/1\nFEDRAT/500\nRAPID\nGOTO/8,-40,0\nGOTO/8,40,0\nFINI\n")
        q = self.verify("wall.stl", "--path", path, "--tool-length", "30")
        self.assertLessEqual(max(q["gouge_max_mm"], q["excess_max_mm"]), q["bound_mm"])
        q = self.verify("wall.stl", "--path", path, "--tool-length", "30", "--tool-diameter", "16.2", "--max-gouge", "0.05", expect=1)
        self.near(q["gouge_max_mm"], 0.1, q)
        # A job whose tool is not the program's is said.
        self.plate_job()
        p = self.run_burin("verify", "plate.toml", "--path", self.write("other.cl", "\n".join(raster(cutter="8.0,4.0"))))
        self.assertIn("tool_differs", p.stderr)

    def test_a_wrong_axis(self):
        job = self.plate_job(tool=FLAT)
        lines = raster(step=8.0, over=12.0)
        q = self.verify(job, "--path", self.write("flat.cl", "\n".join(lines)))
        self.assertLessEqual(max(q["gouge_max_mm"], q["excess_max_mm"]), q["bound_mm"])
        tilt = math.radians(2)
        lines = [line + f",0,{math.sin(tilt)},{math.cos(tilt)}" if line.startswith("GOTO/") and ",8.0," in line else
                 line + ",0,0,1" if line.startswith("GOTO/") else line for line in lines]
        q = self.verify(job, "--path", self.write("tilted.cl", "\n".join(lines)), "--max-gouge", "0.05", expect=1)
        self.near(q["gouge_max_mm"], 8 * math.sin(tilt), q)

    def test_a_rapid_through_the_part(self):
        self.write("block.stl", stl(block((-20, -20, -10), (20, 20, 0))))
        path = ("CUTTER/10,5\nLOADTL/1\nFEDRAT/500\nRAPID\nGOTO/-40,0,20\nRAPID\nGOTO/-40,0,-2\nRAPID\nGOTO/40,0,-2\nRAPID\nGOTO/40,0,20\n")
        q = self.verify("block.stl", "--path", self.write("rapid.cl", path + "FINI\n"), "--tool-length", "40", "--reach", "1", expect=3)
        hits = [c for c in q["collisions"] if c["body"] == "cutter" and c["against"] == "part"]
        self.assertEqual([c["move"] for c in hits], [2])
        self.assertEqual(hits[0]["line"], 9)
        self.near(hits[0]["depth_mm"], 2, q, 0.002)
        self.assertIn("collision", self.said)
        # The same against stock: the box is 1 mm larger, so 3 mm deep.
        stocked = self.verify("block.stl", "--path", "rapid.cl", "--tool-length", "40", "--stock", "block", "--stl", "left.stl", "--resolution",
                              "0.5", "--reach", "1", expect=3)
        hits = [c for c in stocked["collisions"] if c["against"] == "stock" and c["body"] == "cutter"]
        self.assertEqual([c["move"] for c in hits], [2])
        r, depth = 5.0, 3.0
        groove = 42 * (r * r * math.acos((r - depth) / r) - (r - depth) * math.sqrt(2 * r * depth - depth * depth))
        self.assertAlmostEqual(stocked["removed_mm3"], groove, delta=0.02 * groove)
        self.assertGreater(os.path.getsize(self.path("left.stl")), 1000)

    def test_a_holder_through_a_wall(self):
        # The floor is milled clean; a wall higher than the cutter stands where the holder comes by.
        wall = block((-20, 9, 0), (20, 11, 60))
        tall = '[tool]\nkind = "flat"\nradius = 4.0\nlength = 30.0\nholder = [{ radius = 7.0, height = 50.0 }]\n'
        self.write("wall.stl", stl(wall))
        self.write("floor.stl", stl(quad((-20, -2, 0), (20, -2, 0), (20, 2, 0), (-20, 2, 0))))
        self.write("floor.toml", f'[part]\nmesh = "floor.stl"\nobstacles = ["wall.stl"]\n{tall}')
        head = "CUTTER/8\nLOADTL/1\nFEDRAT/500\nRAPID\nGOTO/-30,0,80\nRAPID\nGOTO/-30,0,0\n"
        self.verify("floor.toml", "--path", self.write("ok.cl", head + "GOTO/30,0,0\nFINI\n"))
        q = self.verify("floor.toml", "--path", self.write("near.cl", head + "GOTO/-30,3,0\nGOTO/30,3,0\nGOTO/30,0,0\nGOTO/-30,0,0\nFINI\n"), expect=3)
        self.assertEqual({(c["move"], c["body"], c["against"]) for c in q["collisions"]}, {(3, "holder", "obstacle")})
        self.near(q["collisions"][0]["depth_mm"], 3 + 7 - 9, q, 0.002)

    def test_nc_and_one_digit(self):
        job = self.plate_job()
        self.write("path.cl", "\n".join(raster()))
        self.run_burin("post", "path.cl", "--machine", "xyz", "-o", "path.ngc")
        q = self.verify(job, "--path", "path.ngc")
        self.assertEqual(self.report["parameters"]["path_kind"], "nc")
        self.near(q["excess_max_mm"], scallop(5, 2), q)
        with open(self.path("path.ngc")) as f:
            lines = f.read().splitlines()
        k = [i for i, line in enumerate(lines) if re.search(r"\bZ0\b", line)][7]
        lines[k] = re.sub(r"\bZ0\b", "Z-0.3", lines[k])
        q = self.verify(job, "--path", self.write("digit.ngc", "\n".join(lines)), "--max-gouge", "0.01", expect=1)
        # The plunge goes 0.3 too deep outside; the line that follows stays there to its end.
        self.near(q["gouge_max_mm"], 0.3, q)
        self.assertLessEqual(abs(q["gouge_line"] - (k + 1)), 1)


class RotaryTest(Case):
    """A round bar of 10 mm: the distance of any place from the axis is known."""

    def setUp(self):
        super().setUp()
        self.write("section.dxf", circle_dxf(10.0))
        self.job = self.write("bar.toml", '[part]\nsection = "section.dxf"\nlength = 6.0\n[tool]\nkind = "ball"\nradius = 2.0\n'
                                          'shank_length = 40.0\nholder = [{ radius = 15.0, height = 40.0 }]\n[operation]\npattern = "rings"\n'
                                          'tolerance = 0.01\nside_step = 1.0\nfeed = 600.0\n[machine]\nname = "xyza"\n')
        self.run_burin("rotary", self.job, "--cl", "bar.cl", "-o", "bar.ngc")

    def test_clean_and_faults(self):
        q = self.verify(self.job, "--path", "bar.cl", "--max-gouge", "0.01", "--max-excess", "0.08")
        self.assertGreaterEqual(q["excess_max_mm"], scallop(2, 1) - 0.02)
        n = self.verify(self.job, "--path", "bar.ngc", "--max-gouge", "0.01", "--max-excess", "0.08")
        self.near(n["excess_max_mm"], q["excess_max_mm"], q, 0.002)
        self.assertGreater(self.report["parameters"]["path_kind"], "")

        with open(self.path("bar.cl")) as f:
            lines = f.read().splitlines()
        axis, cuts = None, []
        for i, line in enumerate(lines):
            v = [float(x) for x in line[5:].split(",")] if line.startswith("GOTO/") else []
            axis = v[3:] or axis
            if v and 1 < v[0] < 5 and math.hypot(v[1] + 2 * axis[1], v[2] + 2 * axis[2]) < 12.02:
                cuts.append((i, v[:3], axis))
        k, v, axis = cuts[len(cuts) // 2]
        center = np.array(v[1:]) + 2 * np.array(axis[1:])
        r = np.linalg.norm(center)
        v[1:] = np.array(v[1:]) - 0.05 * center / r
        deep = lines[:]
        deep[k] = "GOTO/" + ",".join(f"{x:.12f}" for x in v + axis)
        q = self.verify(self.job, "--path", self.write("deep.cl", "\n".join(deep)), "--max-gouge", "0.02", expect=1)
        self.near(q["gouge_max_mm"], 12 - (r - 0.05), q)
        self.assertIn(q["gouge_line"], (k + 1, k + 2))

    def test_one_digit_of_the_joints(self):
        with open(self.path("bar.ngc")) as f:
            lines = f.read().splitlines()
        # A block of the middle that names Y and Z, and the next one too.
        full = [bool(re.fullmatch(r"Y\S+ Z\S+ A\S+ F\S+", line)) for line in lines]
        at = [i for i in range(len(lines) - 1) if full[i] and full[i + 1]]
        k = at[len(at) // 2]
        y, z = (float(x) for x in re.match(r"Y(\S+) Z(\S+)", lines[k]).groups())
        self.assertAlmostEqual(math.hypot(y, z + 2), 12, delta=0.011)
        lines[k] = re.sub(r"\bZ-?[\d.]+", f"Z{z - 0.07:.4f}", lines[k])
        q = self.verify(self.job, "--path", self.write("digit.ngc", "\n".join(lines)), "--max-gouge", "0.02", expect=1)
        # The axis is along Z: the ball's centre stands 2 mm above the tip, whatever A is.
        self.near(q["gouge_max_mm"], 12 - math.hypot(y, round(z - 0.07, 4) + 2), q)
        self.assertLessEqual(abs(q["gouge_line"] - (k + 1)), 1)

    def test_a_wrong_tool_and_a_wrong_machine(self):
        with open(self.path("bar.toml")) as f:
            text = f.read()
        # A smaller ball on the same tips leaves more: scallops of its own radius.
        self.write("small.toml", text.replace("radius = 2.0", "radius = 1.0", 1))
        q = self.verify("small.toml", "--path", "bar.cl", "--max-excess", "0.08", expect=1)
        self.near(q["excess_max_mm"], scallop(1, 1), q, 0.02)
        p = self.run_burin("verify", "bar.toml", "--path", "bar.ngc", "--machine", "xyz", expect=1)
        self.assertIn("the axis A", p.stderr)


class OrientTest(Case):
    def test_planned_paths(self):
        tool = '[tool]\nkind = "flat"\nradius = 8.0\nlength = 30.0\nholder = [{ radius = 12.0, height = 50.0 }]\n'
        self.write("strip.stl", stl(quad((-15, -1, 0), (15, -1, 0), (15, 1, 0), (-15, 1, 0))))
        self.write("contacts.csv", "path,x,y,z,nx,ny,nz,fx,fy,fz\n" + "".join(f"0,{x},0,0,0,0,1,1,0,0\n" for x in range(-16, 17, 2)))
        job = self.write("strip.toml", f'[part]\nmesh = "strip.stl"\ncontacts = "contacts.csv"\n{tool}[operation]\ntilt = [1.5, 20.0]\n'
                                       'yaw = [-10.0, 10.0]\ntolerance = 0.01\nscallop = 0.05\nfeed = 1000.0\n[machine]\nname = "xyzac-trunnion"\n')
        self.run_burin("orient", job, "--cl", "strip.cl", "-o", "strip.ngc")
        self.run_burin("post", "strip.cl", "--machine", "xyzac-trunnion", "--dialect", "fanuc", "--tcp", "-o", "tcp.nc")
        results = [self.verify(job, "--path", name, *more, "--max-gouge", "0.012", "--max-excess", "0.02")
                   for name, more in (("strip.cl", ()), ("strip.cl", ("--joints",)), ("strip.ngc", ()), ("tcp.nc", ()))]
        for q in results[1:]:
            self.near(q["excess_max_mm"], results[0]["excess_max_mm"], q, 0.012)
        # Tilted three times as far, the rim of the mill digs in.
        with open(self.path("strip.cl")) as f:
            lines = f.read().splitlines()
        k = [i for i, line in enumerate(lines) if re.match(r"GOTO/0\.", line) or re.match(r"GOTO/-?\d\.\d+,", line)]
        axis = None
        for i, line in enumerate(lines):
            v = line[5:].split(",") if line.startswith("GOTO/") else []
            if len(v) == 6:
                axis = [float(x) for x in v[3:]]
            if axis and k and i == k[len(k) // 2]:
                break
        v = [float(x) for x in lines[i][5:].split(",")][:3]
        wrong = [3 * axis[0], 3 * axis[1], math.sqrt(1 - 9 * (axis[0] ** 2 + axis[1] ** 2))]
        lines[i] = "GOTO/" + ",".join(f"{x:.12f}" for x in v + wrong)
        if i + 1 < len(lines) and lines[i + 1].startswith("GOTO/") and lines[i + 1].count(",") == 2:
            lines[i + 1] += "," + ",".join(f"{x:.12f}" for x in axis)
        q = self.verify(job, "--path", self.write("wrong.cl", "\n".join(lines)), "--max-gouge", "0.02", expect=1)
        # The lowest place of the rim on the line y = v[1] +- 1 (the strip), at the pose itself; more of it is gone between.
        low = self.lowest(v, wrong, 8.0)
        self.assertGreaterEqual(q["gouge_max_mm"], -low - q["bound_mm"])
        self.assertLessEqual(q["gouge_max_mm"], -low + 0.25)

    @staticmethod
    def lowest(tip, axis, radius):
        """Of a flat end's bottom disc over |y| <= 1, |x| <= 15."""
        u = np.array(axis)
        e = np.cross(u, [0, 1, 0])
        e /= np.linalg.norm(e)
        f = np.cross(u, e)
        low = 0.0
        for r in np.linspace(0, radius, 81):
            a = np.linspace(0, 2 * math.pi, 1441)
            p = np.array(tip) + r * (np.outer(np.cos(a), e) + np.outer(np.sin(a), f))
            on = (np.abs(p[:, 1]) <= 1) & (np.abs(p[:, 0]) <= 15)
            if on.any():
                low = min(low, p[on, 2].min())
        return low


class CycleTest(Case):
    def surface(self, slope=0.2):
        points = "".join(f"X{x}. Y{y}. Z{slope * x:.3f} W1.;\n" for y in (0, 5, 10, 15) for x in (0, 10, 20, 30))
        return "G21 G90 G00 Z30.;\nN10 G06.23 U4 V4 D6. L0. F500. S0.02;\n" + points + "M30;\n"

    def test_clean_and_faults(self):
        design = self.write("slope.nc", self.surface())
        self.run_burin("cycle", design, "--cl", "slope.cl", "-o", "slope.ngc")
        for path in ("slope.cl", "slope.ngc"):
            q = self.verify(design, "--path", path, "--max-gouge", "0.011", "--max-excess", "0.035")
            self.assertEqual(self.report["parameters"]["design_kind"], "cycle")
            self.assertEqual(self.report["parameters"]["tools"][0]["radius_mm"], 3)
        with open(self.path("slope.ngc")) as f:
            lines = f.read().splitlines()
        # A place in the middle of a path up the slope, 0.08 mm too low.
        k = next(i for i, line in enumerate(lines) if re.match(r"X29\S* Z", line))
        x, z = (float(v) for v in re.match(r"X(\S+) Z(\S+)", lines[k]).groups())
        tip = (15.0, z - 0.2 * (x - 15))
        deep = round(tip[1] - 0.08, 4)
        lines.insert(k, f"X15 Z{deep:.4f}")
        q = self.verify(design, "--path", self.write("deep.ngc", "\n".join(lines)), "--max-gouge", "0.02", expect=1)
        # Depth of the ball below the plane z = 0.2 x.
        n = np.array([-0.2, 0, 1]) / math.hypot(0.2, 1)
        expected = 3 - n @ np.array([tip[0], 0, deep + 3])
        self.near(q["gouge_max_mm"], expected, q, 1e-4)
        # Without the last third of the program.
        lines = lines[: 2 * len(lines) // 3] + ["M2"]
        q = self.verify(design, "--path", self.write("cut.ngc", "\n".join(lines)), "--reach", "1", expect=3)
        self.assertGreater(q["unmachined_area_mm2"], 30)


class ForeignTest(Case):
    def test_two_tools_by_number_or_comment(self):
        self.write("plate.stl", stl(plate()))
        program = ["(T1 D=10. CR=5. - ZMIN=0. - ball end mill)", "G21 G90 G94 G17", "G54", "T1 M6", "S5000 M3", "G28 G91 Z0.", "G90"]
        for i in range(-10, 11):
            if i == 0:
                program += ["T2 M6", "G0 X0 Y0 Z20"]
            a, b = (-30, 30) if i % 2 == 0 else (30, -30)
            program += [f"G0 X{a} Y{2 * i} Z20", f"G1 Z0 F500", f"G1 X{b}", "G0 Z20"]
        path = self.write("two.nc", "\n".join(program + ["M30"]))
        p = self.run_burin("verify", "plate.stl", "--path", path, expect=2)
        self.assertIn("tool 2", p.stderr)
        self.write("two.toml", '[part]\nmesh = "plate.stl"\n[[tools]]\nnumber = 1\nkind = "ball"\nradius = 5.0\n[[tools]]\nnumber = 2\n'
                               'kind = "flat"\nradius = 4.0\nlength = 20.0\n')
        q = self.verify("two.toml", "--path", path, expect=3)  # G28 is the machine's
        self.assertEqual([t["radius_mm"] for t in self.report["parameters"]["tools"]], [5, 4])
        self.near(q["excess_max_mm"], scallop(5, 2), q)
        self.assertEqual(q["unmachined_area_mm2"], 0)

    def test_apt_of_another_system(self):
        self.write("plate.stl", stl(plate()))
        lines = ["TOOL PATH/FLOOR,TOOL,BALL10", "TLDATA/MILL,10.0,5.0,75.0,0.0,0.0", "MSYS/0,0,0,1,0,0,0,1,0", "$$ centerline data", "PAINT/PATH",
                 "INTOL/0.03", "MULTAX/ON", "LOAD/TOOL,1", *raster()[2:-1], "END-OF-PATH", "FINI"]
        q = self.verify("plate.stl", "--path", self.write("foreign.cls", "\n".join(lines)))
        self.near(q["excess_max_mm"], scallop(5, 2), q)


class BadInputTest(Case):
    def refuse(self, *args, code=1, says=()):
        before = set(os.listdir(self.dir))
        p = self.run_burin("verify", *args, "--json", "x.json", "--csv", "x.csv", expect=code)
        for word in [says] if isinstance(says, str) else says:
            self.assertIn(word, p.stderr)
        self.assertEqual(set(os.listdir(self.dir)), before, "nothing is left behind")

    def test_files(self):
        job = self.plate_job()
        path = self.write("path.cl", "\n".join(raster()))
        self.refuse(job, "--path", "missing.cl", says="missing.cl")
        self.refuse("missing.toml", "--path", path, says="missing.toml")
        self.refuse(job, "--path", self.write("damaged.cl", "\n".join(raster())[:300] + "\nGOTO/1,2,x\nFINI"), says="damaged.cl:")
        self.refuse(job, "--path", self.write("nan.cl", "GOTO/1,2,nan\nFINI\n"), says="nan.cl:1")
        self.refuse(job, "--path", self.write("empty.cl", ""), says="empty.cl")
        self.refuse(job, "--path", self.write("text.txt", "Dear Sir,\nplease find enclosed\n"), says="no tool path")
        self.refuse(job, "--path", self.write("part.h", "0 BEGIN PGM 1 MM\n1 L X+0 Y+0 R0 FMAX M3\n2 END PGM 1 MM\n"), says="Heidenhain")
        self.refuse(job, "--path", self.write("still.cl", "FEDRAT/100\nFINI\n"), says="moves nothing")
        self.refuse(job, "--path", self.write("cycle.nc", "G90 G0 X0 Y0\nG81 X1 Y1 Z-1 R1 F100\nM30\n"), says="cycle.nc:2")
        self.refuse(job, "--path", self.write("macro.nc", "#1=5\nG1 X#1 F100\n"), says="macro.nc:1")
        self.refuse(job, "--path", self.write("turn.cl", "CUTTER/10,5\nFEDRAT/100\nGOTO/0,0,9\nGOTO/1,0,9,0,0,-1\nFINI\n"), says=("turn.cl:4", "half a turn"))

    def test_tools(self):
        self.write("plate.stl", stl(plate()))
        path = self.write("path.cl", "FEDRAT/500\nGOTO/0,0,1\nGOTO/1,0,1\nFINI\n")
        self.refuse("plate.stl", "--path", path, code=2, says="--tool-diameter")
        self.refuse("plate.stl", "--path", path, "--tool-diameter", "6", "--tool-corner", "4", says="corner")
        self.refuse("plate.stl", "--path", path, "--tool-diameter", "-6", code=2, says="--tool-diameter")

    def test_jobs(self):
        path = self.write("path.cl", "\n".join(raster()))
        for old, new, near in (("radius = 5.0", "radios = 5.0", "radius"), ("mesh =", "mash =", "mesh"), ("name =", "nome =", "name")):
            self.plate_job()
            with open(self.path("plate.toml")) as f:
                text = f.read()
            self.refuse(self.write("typo.toml", text.replace(old, new, 1)), "--path", path, says=near)
        self.refuse(self.plate_job('[stock]\nkind = "block"\nmargim = 3.0\n'), "--path", path, says="margin")
        # What verify does not read may say what it likes.
        self.verify(self.plate_job("[output]\nwhatever = 1\n"), "--path", path)

    def test_meshes(self):
        path = self.write("path.cl", "\n".join(raster()))
        self.write("holes.stl", stl(block((-20, -20, -10), (20, 20, 0))[1:]))
        self.write("plate.stl", stl(plate()))
        self.refuse("plate.stl", "--path", path, "--stock", "holes.stl", says="stock")
        self.refuse(self.write("cut.stl", stl(plate())[:100]), "--path", path, says="cut.stl")
        self.refuse("plate.stl", "--path", path, "--stl", "left.stl", code=2, says="--stock")

    def test_sizes(self):
        job = self.plate_job()
        path = self.write("path.cl", "\n".join(raster()))
        self.refuse(job, "--path", path, "--samples", "2000000000", says="samples")
        self.refuse(job, "--path", path, "--spacing", "0.0001", says="spacing")
        self.refuse(job, "--path", path, "--stock", "block", "--resolution", "0.0001")
        self.refuse(job, "--path", path, "--samples", "10", "--spacing", "1", code=2)


if __name__ == "__main__":
    BURIN = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=2)
