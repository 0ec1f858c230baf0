#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The contract of `burin rotary` from outside. Parts are written here; NC and points are checked against formulas of our own:
the tip on the part from the joints, feeds from block times, the ball and the shank against dense samples of the section.
usage: rotary_cli_test.py PATH/TO/burin"""
import csv
import json
import math
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

import numpy as np

BURIN = ""
EXAMPLES = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "examples")
COLUMNS = ("path,index,u,w,contact_x,contact_y,contact_z,normal_x,normal_y,normal_z,center_x,center_y,center_z,"
           "theta_deg,state,reachable").split(",")


# --- parts ------------------------------------------------------------------------------------------------------------

def dxf(vertices, closed=True):
    pairs = [(0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1015"), (9, "$INSUNITS"), (70, 4), (0, "ENDSEC"),
             (0, "SECTION"), (2, "ENTITIES"), (0, "LWPOLYLINE"), (5, "1F"), (100, "AcDbEntity"), (8, "0"),
             (100, "AcDbPolyline"), (90, len(vertices)), (70, int(closed))]
    for x, y in vertices:
        pairs += [(10, f"{x:.9f}"), (20, f"{y:.9f}")]
    return "".join(f"{code}\n{value}\n" for code, value in pairs + [(0, "ENDSEC"), (0, "EOF")])


def star(count=3, mean=14.0, swing=3.0, n=96, shift=(0.0, 0.0)):
    """Lobes; between them the section is concave."""
    out = []
    for i in range(n):
        a = 2 * math.pi * i / n
        r = mean + swing * math.cos(count * a)
        out.append((r * math.cos(a) + shift[0], r * math.sin(a) + shift[1]))
    return out


def slotted(radius=15.0, width=5.0, depth=9.0, lean=35.0, n=60):
    """A shaft with one slot that leans away from the radius: the first axes at its sides hit the shaft."""
    a0 = math.asin(width / 2 / radius)
    ring = [(radius * math.cos(a), radius * math.sin(a)) for a in np.linspace(a0, 2 * math.pi - a0, n)]
    way = np.array([-math.cos(math.radians(lean)), -math.sin(math.radians(lean))])
    down, up = np.array(ring[-1]) + depth * way, np.array(ring[0]) + depth * way
    return [*ring, tuple(down), tuple(up)]


def stl(triangles):
    out = b"part".ljust(80) + struct.pack("<I", len(triangles))
    for t in triangles:
        n = np.cross(np.subtract(t[1], t[0]), np.subtract(t[2], t[0]))
        out += struct.pack("<12fH", *(n / (np.linalg.norm(n) or 1)), *t[0], *t[1], *t[2], 0)
    return out


def bar(radius=10.0, length=20.0, around=24, along=4, shift=0.0):
    """A closed cylinder about X as triangles."""
    p = lambda i, k: (length * i / along, radius * math.cos(2 * math.pi * k / around) + shift,
                      radius * math.sin(2 * math.pi * k / around))
    out = []
    for k in range(around):
        out += [((0, shift, 0), p(0, k + 1), p(0, k)), ((length, shift, 0), p(along, k), p(along, k + 1))]
        for i in range(along):
            out += [(p(i, k), p(i, k + 1), p(i + 1, k + 1)), (p(i, k), p(i + 1, k + 1), p(i + 1, k))]
    return out


def job(part='section = "section.dxf"\nlength = 6.0\ntwist = 10.0', tool="radius = 2.0\nshank_length = 60.0",
        operation='pattern = "rings"\ntolerance = 0.02\nside_step = 3.0\nfeed = 600.0', machine='name = "xyza"'):
    return f'[part]\n{part}\n[tool]\nkind = "ball"\n{tool}\n[operation]\n{operation}\n[machine]\n{machine}\n'


OUTPUTS = ["-o", "o.ngc", "--cl", "o.cl", "--json", "o.json", "--points", "o.csv", "--svg", "o.svg", "--html", "o.html"]


class Run:
    def __init__(self, text, *options, files=None, expect=(0,), outputs=tuple(OUTPUTS)):
        self.folder = tempfile.mkdtemp(prefix="rotary-")
        self.given = {"job.toml", *(files or {})}
        for name, content in {"job.toml": text, **(files or {})}.items():
            with open(self.file(name), "wb") as f:
                f.write(content if isinstance(content, bytes) else content.encode())
        self.process = subprocess.run([BURIN, "rotary", "job.toml", *outputs, *options], cwd=self.folder,
                                      capture_output=True, text=True, timeout=280)
        self.stderr = self.process.stderr
        self.left = sorted(set(os.listdir(self.folder)) - self.given)
        if self.process.returncode not in expect:
            raise AssertionError(f"exit {self.process.returncode}: {self.stderr}")

    def file(self, name):
        return os.path.join(self.folder, name)

    def bytes(self, name):
        with open(self.file(name), "rb") as f:
            return f.read()

    def json(self):
        return json.loads(self.bytes("o.json"))

    def rows(self):
        with open(self.file("o.csv"), newline="") as f:
            return list(csv.DictReader(f))

    def __del__(self):
        shutil.rmtree(self.folder, ignore_errors=True)


# --- NC, read on its own ----------------------------------------------------------------------------------------------

class Block:
    def __init__(self, line, rapid, at, minutes):
        self.line, self.rapid, self.at, self.minutes = line, rapid, at, minutes


def read_nc(text):
    """Blocks with motion: X, Y, Z, A after it, and the time that G93 gives it."""
    at, blocks, rapid, inverse, feed = dict.fromkeys("XYZA", 0.0), [], True, False, None
    for number, line in enumerate(text.splitlines(), 1):
        words = re.findall(r"([A-Z])(-?\d*\.?\d+)", re.sub(r"\(.*?\)", "", line))
        if ("G", "93") in words:
            inverse = True
        for g in [float(v) for c, v in words if c == "G"]:
            rapid = g == 0 if g in (0, 1) else rapid
        moved = False
        for c, v in words:
            if c in at:
                at[c], moved = float(v), True
            elif c == "F":
                feed = float(v)
        if moved:
            assert rapid or (inverse and feed), f"line {number}: {line}"
            blocks.append(Block(number, rapid, dict(at), None if rapid else 1 / feed))
    return blocks


def on_part(at):
    """Joints -> tip on the part: the table has turned it right-handed about +X by A."""
    a = math.radians(at["A"])
    return np.array([at["X"], at["Y"] * math.cos(a) + at["Z"] * math.sin(a), -at["Y"] * math.sin(a) + at["Z"] * math.cos(a)])


def tip_feeds(blocks, parts=16):
    """mm/min of the tip on the part during each feed block: least and greatest of its parts."""
    out = []
    for before, block in zip(blocks, blocks[1:]):
        if block.rapid:
            continue
        way = [on_part({c: before.at[c] + f * (block.at[c] - before.at[c]) for c in "XYZA"}) for f in np.linspace(0, 1, parts + 1)]
        steps = np.linalg.norm(np.diff(way, axis=0), axis=1)
        out.append((steps.sum(), parts * steps.min() / block.minutes, parts * steps.max() / block.minutes, block.line,
                    abs(block.at["A"] - before.at["A"]) / block.minutes))
    return out


def dense(vertices, step=0.02):
    """Points of a closed polygon."""
    v = np.array(vertices)
    out = []
    for a, b in zip(v, np.roll(v, -1, axis=0)):
        n = max(1, math.ceil(np.linalg.norm(b - a) / step))
        out.append(a + np.linspace(0, 1, n, endpoint=False)[:, None] * (b - a))
    return np.concatenate(out)


def inside(vertices, points):
    """Which points lie inside of a closed polygon (even-odd)."""
    v = np.array(vertices)
    a, b = v, np.roll(v, -1, axis=0)
    out = np.zeros(len(points), bool)
    for (ax, ay), (bx, by) in zip(a, b):
        crosses = (ay > points[:, 1]) != (by > points[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            out ^= crosses & (points[:, 0] < (bx - ax) * (points[:, 1] - ay) / (by - ay) + ax)
    return out


def shank_depth(vertices, boundary, center, theta, radius, length=60.0):
    """How deep the middle plane of ball and shank lies in the section: least way from a place of the section's outline
    inside of the tool to the outside of the tool."""
    d = boundary - center
    axis = np.array([math.sin(theta), math.cos(theta)])
    along, across = d @ axis, np.abs(d @ np.array([axis[1], -axis[0]]))
    depth = np.where(along < 0, radius - np.linalg.norm(d, axis=1), np.minimum(radius - across, length))
    return depth.max()


# --- tests ------------------------------------------------------------------------------------------------------------

class Contract(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = Run(job(), files={"section.dxf": dxf(star())})

    def test_files_and_keys(self):
        self.assertEqual(self.made.left, ["o.cl", "o.csv", "o.html", "o.json", "o.ngc", "o.svg"])
        j = self.made.json()
        for key in ("operation", "version", "input", "inputs_sha256", "parameters", "counts", "lengths_mm", "time_s", "quality", "warnings", "outputs"):
            self.assertIn(key, j)
        self.assertEqual(j["operation"], "rotary")
        self.assertLessEqual({"contact_points", "ssi_split", "tsi", "tai", "moved", "unreachable", "cl_points", "axis_reversals"}, set(j["counts"]))
        self.assertLessEqual({"ssi_max_mm", "gouge_max_mm", "excess_max_mm", "axis_step_max_deg", "axis_turn_total_deg"}, set(j["quality"]))
        self.assertLessEqual({"cut", "link", "rapid"}, set(j["lengths_mm"]))
        self.assertEqual(sorted(j["inputs_sha256"]), ["job.toml", "section.dxf"])
        self.assertEqual(self.made.bytes("o.csv").decode().splitlines()[0], ",".join(COLUMNS))
        self.assertIn("G93", self.made.bytes("o.ngc").decode())

    def test_report_stands_alone(self):
        page = self.made.bytes("o.html").decode()
        self.assertNotRegex(page, r"(src|href)\s*=|https?://|@import|url\(")
        self.assertTrue(page.rstrip().endswith("</html>"))
        svg = self.made.bytes("o.svg").decode()
        self.assertTrue(svg.startswith("<svg") and "nan" not in svg)

    def test_points_are_consistent(self):
        rows, radius = self.made.rows(), 2.0
        self.assertEqual(len(rows), self.made.json()["counts"]["contact_points"])
        last = (-1, -1)
        for r in rows:
            here = int(r["path"]), int(r["index"])
            self.assertEqual(here, (last[0], last[1] + 1) if here[0] == last[0] else (last[0] + 1, 0))
            last = here
            p, n, c = (np.array([float(r[f"{what}_{k}"]) for k in "xyz"]) for what in ("contact", "normal", "center"))
            self.assertAlmostEqual(np.linalg.norm(n), 1, places=6)
            self.assertLess(np.abs(p + radius * n - c).max(), 2e-6)
            self.assertIn(r["state"], ("ok", "moved", "unreachable"))
            theta, spans = float(r["theta_deg"]), []
            if r["reachable"]:
                spans = [tuple(map(float, s.split(":"))) for s in r["reachable"].split(";")]
            self.assertTrue(all(lo < hi and -180 <= lo < 180 and hi <= lo + 360 for lo, hi in spans))
            self.assertTrue(all(a[1] < b[0] for a, b in zip(spans, spans[1:])))
            if r["state"] != "unreachable":
                self.assertTrue(any((theta - lo + 1e-3) % 360 <= hi - lo + 2e-3 for lo, hi in spans), (theta, spans))
            for key in ("u", "w"):
                self.assertTrue(-1e-9 <= float(r[key]) <= 1 + 1e-9)

    def test_cl_holds_the_points(self):
        goto = [tuple(map(float, line.split("/")[1].split(","))) for line in self.made.bytes("o.cl").decode().splitlines() if line.startswith("GOTO/")]
        tips = np.array([g[:3] for g in goto])
        for r in self.made.rows()[::7]:
            t = math.radians(float(r["theta_deg"]))
            tip = np.array([float(r["center_x"]), float(r["center_y"]) - 2 * math.sin(t), float(r["center_z"]) - 2 * math.cos(t)])
            near = np.linalg.norm(tips - tip, axis=1).min()
            (self.assertLess if r["state"] != "unreachable" else self.assertGreater)(near, 1e-4)

    def test_axis_goes_on(self):
        """No block turns by half a turn or more except rapids, and those do not unwind whole turns."""
        blocks = read_nc(self.made.bytes("o.ngc").decode())
        for a, b in zip(blocks, blocks[1:]):
            self.assertLess(abs(b.at["A"] - a.at["A"]), 180 if not b.rapid else 181, f"line {b.line}")
        self.assertGreater(abs(blocks[-1].at["A"] - blocks[0].at["A"]), 360)  # rings follow each other without going back

    def test_feed_at_the_tip(self):
        """Within a per cent of the feed; slower only where the A axis is at its speed. The last decimals of blocks of a few
        hundredths are rounding, which is allowed for by their share of the length."""
        feeds = tip_feeds(read_nc(self.made.bytes("o.ngc").decode()))
        self.assertGreater(len(feeds), 100)
        top = max(f[4] for f in feeds)
        for length, slow, fast, line, turn in feeds:
            rounding = 3e-4 / max(length, 1e-9)
            self.assertLess(fast, 600 * (1.01 + rounding) * (1 + 1e-3), f"line {line}")
            if turn < 0.98 * top:
                self.assertGreater(slow, 600 * (0.99 - rounding) * (1 - 1e-3), f"line {line}")

    def test_no_gouge_by_dense_samples(self):
        """Every CL point of the ring at x = 0 against the outline, in the plane of the section."""
        outline = star()
        boundary = dense(outline)
        for r in self.made.rows():
            if r["path"] != "0" or r["state"] == "unreachable":
                continue
            c, t = np.array([float(r["center_y"]), float(r["center_z"])]), math.radians(float(r["theta_deg"]))
            if abs(float(r["center_x"])) > 0.05:
                continue  # the twist leans the normal out of the plane
            self.assertLess(shank_depth(outline, boundary, c, t, 2.0), 0.02 + 1e-3)

    def test_checked_by_itself(self):
        q = self.made.json()["quality"]
        self.assertLessEqual(q["gouge_max_mm"], 0.02 + q["bound_mm"])
        self.assertLessEqual(q["ssi_max_mm"], 0.02 + 1e-9)

    def test_same_bytes(self):
        text, files = job(), {"section.dxf": dxf(star())}
        a, b = Run(text, files=files), Run(text, "--threads", "2", files=files)
        for name in ("o.ngc", "o.cl", "o.csv", "o.svg"):
            self.assertEqual(self.made.bytes(name), a.bytes(name), name)
            self.assertEqual(a.bytes(name), b.bytes(name), name)
        strip = lambda r: re.sub(r'"planning": [\d.e+-]+|--threads 2', "", r.bytes("o.json").decode())
        self.assertEqual(strip(a), strip(b))

    def test_names_without_options(self):
        run = Run(job(), files={"section.dxf": dxf(star())}, outputs=())
        self.assertEqual(run.left, ["job.ngc"])
        self.assertEqual(run.bytes("job.ngc"), self.made.bytes("o.ngc"))

    def test_feed_per_minute(self):
        run = Run(job(), "--feed-mode", "per-minute", files={"section.dxf": dxf(star())}, outputs=("-o", "o.ngc"))
        text = run.bytes("o.ngc").decode()
        self.assertNotIn("G93", text)
        self.assertIn("G94", text)


class Patterns(unittest.TestCase):
    def test_spiral_and_lines(self):
        for pattern in ("spiral", "lines"):
            run = Run(job(operation=f'pattern = "{pattern}"\ntolerance = 0.02\nside_step = 3.0\nfeed = 600.0'), files={"section.dxf": dxf(star())})
            j = run.json()
            self.assertEqual(j["counts"]["unreachable"], 0)
            self.assertLessEqual(j["quality"]["gouge_max_mm"], 0.02 + j["quality"]["bound_mm"])

    def test_smoothing_turns_less(self):
        turn = [Run(job(operation=f'tolerance = 0.02\nside_step = 3.0\nsmooth = {on}'), files={"section.dxf": dxf(star(5, 14, 2))}).json()["quality"]["axis_turn_total_deg"]
                for on in ("true", "false")]
        self.assertLess(turn[0], turn[1])


class Leaning(unittest.TestCase):
    """A slot that leans: the first axes interfere, the chosen ones do not, and the paper's method beside the exact one."""
    @classmethod
    def setUpClass(cls):
        cls.outline = slotted()
        cls.files = {"section.dxf": dxf(cls.outline)}
        text = job(part='section = "section.dxf"\nlength = 4.0', tool="radius = 1.5\nshank_length = 60.0", operation="tolerance = 0.02\nside_step = 2.0")
        cls.exact = Run(text, files=cls.files, expect=(0, 3))
        cls.section = Run(text, "--tai", "section", files=cls.files, expect=(0, 1, 3))

    def depths(self, run, first):
        boundary, out = dense(self.outline), []
        for r in run.rows():
            if r["state"] == "unreachable":
                continue
            c = np.array([float(r["center_y"]), float(r["center_z"])])
            t = math.atan2(*c) if first else math.radians(float(r["theta_deg"]))
            out.append(shank_depth(self.outline, boundary, c, t, 1.5))
        return np.array(out)

    def test_first_axes_interfere_and_chosen_do_not(self):
        first, chosen = self.depths(self.exact, True), self.depths(self.exact, False)
        self.assertGreater((first > 0.03).sum(), 5)
        self.assertLess(chosen.max(), 0.021)
        # burin's own count: contacts graze, so those that are deep are fewer than those that interfere at all.
        self.assertGreaterEqual(self.exact.json()["counts"]["tai"], (first > 0.03).sum())

    def test_section_beside_exact(self):
        """The middle of the paper's cone is free in the plane of the section, which is all it promises."""
        if self.section.process.returncode == 1:
            self.assertIn("no contact point is reached", self.section.stderr)
            self.skipTest("nothing is reached by the section method")
        depths = self.depths(self.section, False)
        print(f"tai exact: deepest {self.depths(self.exact, False).max():.4f} mm, {self.exact.json()['counts']['unreachable']} not reached; "
              f"tai section: deepest {depths.max():.4f} mm, {self.section.json()['counts']['unreachable']} not reached", file=sys.stderr)
        self.assertGreaterEqual(self.section.json()["counts"]["unreachable"], self.exact.json()["counts"]["unreachable"])


class NotReached(unittest.TestCase):
    def test_listed_and_not_cut(self):
        """A T-slot: what lies in its wings is listed, with exit code 3, and no CL point stands there."""
        n, w, top = 3.5, 9.0, math.sqrt(16**2 - 3.5**2)
        start = math.atan2(top, -n)
        ring = [(16 * math.cos(a), 16 * math.sin(a)) for a in np.linspace(start, start + 2 * math.pi - 2 * math.atan2(n, top), 60)]
        outline = [*ring, (n, 11.5), (w, 11.5), (w, 6.5), (-w, 6.5), (-w, 11.5), (-n, 11.5)]
        run = Run(job(part='section = "section.dxf"\nlength = 4.0', tool="radius = 2.0\nshank_length = 60.0", operation="tolerance = 0.02\nside_step = 2.0"),
                  files={"section.dxf": dxf(outline)}, expect=(3,))
        j, rows = run.json(), run.rows()
        unreachable = [r for r in rows if r["state"] == "unreachable"]
        self.assertGreater(len(unreachable), 0)
        self.assertEqual(j["counts"]["unreachable"], len(unreachable))
        self.assertTrue(all(r["reachable"] == "" for r in unreachable))
        said = [w for w in j["warnings"] if w["severity"] == "left_out"]
        self.assertTrue(said and any("reach" in w["message"] for w in said), j["warnings"])
        self.assertIn("reach", run.stderr)
        self.assertGreater(j["quality"]["excess_max_mm"], 0.5)
        self.assertLessEqual(j["quality"]["gouge_max_mm"], 0.02 + j["quality"]["bound_mm"])


class BadInput(unittest.TestCase):
    def refused(self, text, *words, files=None, code=(1,), accepted=True):
        run = Run(text, files=files if files is not None else {"section.dxf": dxf(star())}, expect=code)
        self.assertEqual(run.left, [], run.stderr)
        if accepted:
            self.assertRegex(run.stderr, r"\(.*\)", run.stderr)  # what would be accepted
        for word in words:
            self.assertRegex(run.stderr, word)
        return run.stderr

    def test_open_section(self):
        self.refused(job(), r"section\.dxf", "open|closed", files={"section.dxf": dxf(star(), closed=False)})

    def test_self_crossing_section(self):
        bow = [(12, 0), (10, 10), (-10, 8), (-4, -12), (6, 14), (8, -10)]
        self.refused(job(), r"section\.dxf", "cross|touch", files={"section.dxf": dxf(bow)})

    def test_axis_outside(self):
        self.refused(job(), r"section\.dxf", "axis", files={"section.dxf": dxf(star(shift=(25.0, 0)))})

    def test_tool_larger_than_the_part(self):
        self.refused(job(tool="radius = 500.0\nshank_length = 600.0"), "radius|larger|tool")

    def test_holder_that_never_fits(self):
        """A holder so near to the ball that it hits the shaft in the slot: that is left out and listed, the rest is cut."""
        part = 'section = "section.dxf"\nlength = 4.0'
        run = Run(job(part, "radius = 1.5\nshank_length = 3.0\nholder = [{ radius = 20.0, height = 40.0 }]", "tolerance = 0.02\nside_step = 2.0"),
                  files={"section.dxf": dxf(slotted())}, expect=(3,))
        free = Run(job(part, "radius = 1.5\nshank_length = 60.0", "tolerance = 0.02\nside_step = 2.0"), files={"section.dxf": dxf(slotted())})
        self.assertGreater(run.json()["counts"]["unreachable"], 10)
        self.assertEqual(free.json()["counts"]["unreachable"], 0)

    def test_mesh_with_holes(self):
        part = bar()
        del part[30:32]
        said = self.refused(job(part='mesh = "bar.stl"'), r"bar\.stl", "hole", files={"bar.stl": stl(part)})
        self.assertRegex(said, r"-?\d+\.\d")  # where

    def test_mesh_beside_the_axis(self):
        self.refused(job(part='mesh = "bar.stl"'), r"bar\.stl", "axis", files={"bar.stl": stl(bar(shift=25.0))})

    def test_damaged_mesh(self):
        whole = stl(bar())
        for bad in (b"", b"solid x\nfacet\n", whole[:200], whole[:80] + struct.pack("<I", 2**31) + whole[84:],
                    whole[:84] + struct.pack("<f", math.nan) * 12 + whole[132:]):
            self.refused(job(part='mesh = "bar.stl"'), r"bar\.stl", files={"bar.stl": bad}, accepted=False)

    def test_keys(self):
        self.assertIn("side_step", self.refused(job(operation="sidestep = 1.0"), r"job\.toml:\d+:\d+"))
        self.assertIn("holder", self.refused(job(tool="radius = 2.0\nholders = []"), r"job\.toml:\d+:\d+"))
        self.refused(job() + "[tol]\nx = 1\n", r"job\.toml:\d+:\d+")
        self.refused(job(part='length = 5.0'), r"job\.toml:\d+:\d+", "section")
        self.refused(job(part='section = "section.dxf"\nmesh = "x.stl"\nlength = 1.0'), r"job\.toml:\d+:\d+", "beside")
        self.refused(job(part='section = "section.dxf"\nlength = 5.0\nstations = [[0.0, 0.0], [5.0, 9.0]]'), r"job\.toml:\d+:\d+", "stations")

    def test_values(self):
        for bad in ('feed = "fast"', "feed = 0", "feed = -1.0", "tolerance = nan", "tolerance = 1e9", "side_step = 0.0", 'pattern = "zigzag"',
                    "smooth = 1", 'tai = "best"', "clearance_angle = 400.0", "side_step = 1.0\nscallop = 0.1"):
            self.refused(job(operation=bad), r"job\.toml:\d+:\d+", accepted=bad != "smooth = 1")
        for bad in ("radius = 0.0", "radius = inf", 'radius = "2"', "radius = 2.0\nshank_length = 0.5", "radius = 2.0\nholder = [{ radius = 2.0 }]",
                    "radius = 2.0\nholder = 5", "radius = [2.0]"):
            self.refused(job(tool=bad), r"job\.toml:\d+")
        for bad in ("stations = [[0.0, 0.0]]", "stations = [[0.0, 0.0], [0.0, 5.0]]", "stations = [[1.0, 0.0], [2.0, 5.0]]", "stations = 5",
                    'stations = [["a", 0.0], [1.0, 2.0]]', "length = -5.0", "length = 1e30"):
            self.refused(job(part='section = "section.dxf"\n' + bad), r"job\.toml:\d+")
        self.refused("[part\n", r"job\.toml:1", accepted=False)
        self.refused("", r"job\.toml", accepted=False)

    def test_machines(self):
        for name in ("xyz", "xyzac-trunnion", "nothing-like-it"):
            self.refused(job(machine=f'name = "{name}"'), name, code=(1, 2))

    def test_missing_files(self):
        self.refused(job(), r"section\.dxf", files={}, accepted=False)
        run = subprocess.run([BURIN, "rotary", "nowhere.toml"], capture_output=True, text=True)
        self.assertEqual(run.returncode, 1)
        self.assertIn("nowhere.toml", run.stderr)

    def test_usage(self):
        for options in ((), ("a.toml", "--unknown"), ("a.toml", "--tolerance", "-1"), ("a.toml", "--feed-mode", "warp")):
            run = subprocess.run([BURIN, "rotary", *options], capture_output=True, text=True)
            self.assertEqual(run.returncode, 2, run.stderr)

    def test_too_much(self):
        """A side step that would make millions of paths is refused before it costs time."""
        self.refused(job(part='section = "section.dxf"\nlength = 90000.0', operation="side_step = 0.0001"), "side_step|scallop|paths|points")

    def test_odd_drawings(self):
        for bad in ("", "garbage", "0\nSECTION\n", dxf([(0, 0)]), dxf([(1, 1), (1, 1), (1, 1)])):
            self.refused(job(), r"section\.dxf", files={"section.dxf": bad}, accepted=False)


if __name__ == "__main__":
    BURIN = os.path.abspath(sys.argv.pop(1))
    unittest.main()
