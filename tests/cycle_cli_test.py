#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The contract of `burin cycle` from outside. Programs are written here, results are checked with numpy against
formulas of our own: a NURBS evaluator by the recursive definition, differences of setpoints, scallops by brute force.
usage: cycle_cli_test.py PATH/TO/burin"""
import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np

BURIN = ""
EXAMPLES = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "examples")


# --- NURBS by the recursive definition --------------------------------------------------------------------------------

def basis(knots, degree, count, t):
    """All basis functions at t, Cox and de Boor's recursion over the whole vector; the last span is closed."""
    knots = np.asarray(knots, float)
    t = min(max(t, knots[degree]), knots[count])
    n = np.zeros(len(knots) - 1)
    for i in range(len(n)):
        n[i] = 1.0 if knots[i] <= t < knots[i + 1] else 0.0
    if t >= knots[count]:
        n[:] = 0
        n[max(i for i in range(len(n)) if knots[i] < knots[i + 1])] = 1.0
    for p in range(1, degree + 1):
        m = np.zeros(len(n) - 1)
        for i in range(len(m)):
            a = knots[i + p] - knots[i]
            b = knots[i + p + 1] - knots[i + 1]
            m[i] = (n[i] * (t - knots[i]) / a if a > 0 else 0) + (n[i + 1] * (knots[i + p + 1] - t) / b if b > 0 else 0)
        n = m
    return n[:count]


class Surface:
    def __init__(self, s):
        self.s = s
        self.net = np.array(s["points"], float).reshape(s["count_v"], s["count_u"], 4)
        self.h = self.net.copy()
        self.h[:, :, :3] *= self.net[:, :, 3:]

    def domain(self):
        return self.s["knots_u"][0], self.s["knots_u"][-1], self.s["knots_v"][0], self.s["knots_v"][-1]

    def point(self, u, v):
        bu = basis(self.s["knots_u"], self.s["degree_u"], self.s["count_u"], u)
        bv = basis(self.s["knots_v"], self.s["degree_v"], self.s["count_v"], v)
        h = np.einsum("j,i,jik->k", bv, bu, self.h)
        return h[:3] / h[3]

    def normal(self, u, v):
        """Up, by central differences (one-sided at the border)."""
        u0, u1, v0, v1 = self.domain()
        eu, ev = 1e-6 * (u1 - u0), 1e-6 * (v1 - v0)
        du = self.point(min(u + eu, u1), v) - self.point(max(u - eu, u0), v)
        dv = self.point(u, min(v + ev, v1)) - self.point(u, max(v - ev, v0))
        n = np.cross(du, dv)
        n /= np.linalg.norm(n)
        return n if n[2] >= 0 else -n


# --- programs ---------------------------------------------------------------------------------------------------------

def number(x):
    text = f"{x:.9f}".rstrip("0")
    return text if not text.endswith("-0.") else "0."


def block(n, net, order=(4, 4), knots=None, words="D6. L0. F1200. S0.01"):
    """net[j][i] = (x, y, z) or (x, y, z, w)."""
    lines = [f"N{n} G06.23 U{len(net[0])} V{len(net)} P{order[0]} Q{order[1]} {words};"]
    for row in net:
        for p in row:
            w = p[3] if len(p) > 3 else 1.0
            lines.append("".join(f"{c}{number(x)} " for c, x in zip("XYZW", (*p[:3], w))).strip() + ";")
    for k in knots or []:
        lines.append(f"K{number(k)};")
    return "\n".join(lines) + "\n"


def program(*parts, head="G90 G00 Z30."):
    return "%\nG21 G05 P10000;\n" + head + ";\n" + "".join(parts) + "G80 M05;\nG90 G00 Z40.;\nG05 P0;\nM30;\n%\n"


def cycle(first, last, i=1, e=1, w=20, d=6, m=None, s=0.01, f=1200):
    side = f" M{m}" if m else ""
    return f"N1 G106.2 I{i} E{e} P{first} Q{last} W{w}. D{d}.{side} S{s} F{f}.;\n"


def wave(x0, x1, y0, y1, nx=6, ny=6, height=3.0):
    f = lambda x, y: height * math.sin(x / 14.0) * math.cos(y / 18.0)
    return [[(x, y, f(x, y)) for x in np.linspace(x0, x1, nx)] for y in np.linspace(y0, y1, ny)]


def flat(x0, x1, y0, y1, n=4, slope=0.0):
    return [[(x, y, slope * x) for x in np.linspace(x0, x1, n)] for y in np.linspace(y0, y1, n)]


def quarter(radius, y0, y1, start):
    """Quarter of a horizontal cylinder about Y, from angle `start` on (degrees from +X towards +Z), rational quadratic."""
    a, b = math.radians(start), math.radians(start + 90)
    mid = ((math.cos(a) + math.cos(b)), (math.sin(a) + math.sin(b)))
    ring = [(math.cos(a), math.sin(a), 1.0), (*mid, math.sqrt(0.5)), (math.cos(b), math.sin(b), 1.0)]
    return [[(radius * c, y, radius * s, w) for c, s, w in ring] for y in (y0, y1)]


class Run:
    def __init__(self, text, *options, name="p.nc", expect=(0,), outputs=True):
        self.folder = tempfile.mkdtemp(prefix="cycle-")
        self.path = os.path.join(self.folder, name)
        with open(self.path, "w") as f:
            f.write(text)
        out = ["-o", "o.ngc", "--cl", "o.cl", "--json", "o.json", "--surfaces", "s.json", "--setpoints", "s.npy"] if outputs else []
        self.process = subprocess.run([BURIN, "cycle", name, *out, *options], cwd=self.folder, capture_output=True, text=True, timeout=250)
        if self.process.returncode not in expect:
            raise AssertionError(f"exit {self.process.returncode}: {self.process.stderr}")
        self.stderr = self.process.stderr

    def file(self, name):
        return os.path.join(self.folder, name)

    def json(self, name="o.json"):
        with open(self.file(name)) as f:
            return json.load(f)

    def points(self):
        return np.load(self.file("s.npy"))


# --- checks -----------------------------------------------------------------------------------------------------------

def check_limits(test, s, period, accel=5000.0, jerk=50000.0):
    """Every axis by differences of the stream itself; at rest at both ends."""
    p = s[:, 1:4]
    test.assertTrue(np.all(np.isfinite(p)))
    np.testing.assert_allclose(s[:, 0], np.arange(len(s)) * period, rtol=0, atol=1e-9)
    a = np.abs(np.diff(p, 2, axis=0)).max() / period**2
    j = np.abs(np.diff(p, 3, axis=0)).max() / period**3
    noise = 8 * 1e-12 * max(1.0, np.abs(p).max()) / period**3  # rounding of the coordinates themselves
    test.assertLessEqual(a, accel * (1 + 1e-6))
    test.assertLessEqual(j, jerk * (1 + 1e-6) + noise)
    test.assertLess(np.linalg.norm(p[1] - p[0]), jerk * period**3)
    test.assertLess(np.linalg.norm(p[-1] - p[-2]), jerk * period**3)
    test.assertEqual(s[0, 4], 0)
    test.assertAlmostEqual(s[-1, 4], 0, places=6)


def check_on_surface(test, s, surfaces, radius, stock=0.0, tolerance=2e-6, every=37):
    """The tool at (u, v) touches the surface there: tip = S + (R + L) n - R k."""
    rows = s[(s[:, 6] >= 0) & np.isfinite(s[:, 7]) & np.isfinite(s[:, 8])][::every]
    test.assertGreater(len(rows), 10)
    for row in rows:
        surface = surfaces[int(row[5])]
        tip = surface.point(row[7], row[8]) + (radius + stock) * surface.normal(row[7], row[8]) - np.array([0, 0, radius])
        test.assertLess(np.linalg.norm(tip - row[1:4]), tolerance, f"at u {row[7]}, v {row[8]}")


def steady_fluctuation(s, period, feed):
    """Largest relative deviation of chord / T from the feed where the feed has been the commanded one for a while."""
    chord = np.linalg.norm(np.diff(s[:, 1:4], axis=0), axis=1) / period * 60
    steady = np.abs(s[:, 4] - feed) < 1e-9 * feed
    both = steady[1:] & steady[:-1]
    return (np.abs(chord[both] / feed - 1).max() if both.any() else None), int(both.sum())


def passes_of(s):
    """Tips of each path, in order."""
    out = {}
    for row in s[s[:, 6] >= 0]:
        out.setdefault((int(row[5]), int(row[6])), []).append(row[1:4])
    return {k: np.array(v) for k, v in out.items()}


class Joining(unittest.TestCase):
    def test_two_patches_become_one(self):
        a, b = flat(0, 30, 0, 20), flat(30, 60, 0, 20)
        run = Run(program(cycle(10, 20), block(10, a), block(20, b)))
        s = run.json("s.json")
        self.assertEqual(len(s), 1)
        self.assertEqual(s[0]["blocks"], [10, 20])
        self.assertEqual(len(s[0]["joints"]), 1)
        self.assertEqual(s[0]["joints"][0]["continuity"], "G2")
        self.assertLess(s[0]["deviation_mm"], 1e-9)

    def test_whole_half_cylinder_from_quarters(self):
        """Shape compared with x^2 + z^2 = R^2, both patches swapped and reversed in turn."""
        left = quarter(20, 0, 30, 90)
        right = quarter(20, 0, 30, 0)
        turned = [[right[j][2 - i] for j in range(2)] for i in range(3)]  # swapped and reversed
        run = Run(program(cycle(10, 20, s=0.02),
                          block(10, left, order=(3, 2)), block(20, turned, order=(2, 3))))
        s = run.json("s.json")
        self.assertEqual(len(s), 1)
        surface = Surface(s[0])
        u0, u1, v0, v1 = surface.domain()
        angles = []
        for u in np.linspace(u0, u1, 13):
            for v in np.linspace(v0, v1, 13):
                p = surface.point(u, v)
                self.assertAlmostEqual(math.hypot(p[0], p[2]), 20, delta=2e-8)
                angles.append(math.degrees(math.atan2(p[2], p[0])))
        self.assertAlmostEqual(min(angles), 0, delta=1e-6)
        self.assertAlmostEqual(max(angles), 180, delta=1e-6)

    def test_apart_stays_apart(self):
        run = Run(program(cycle(10, 20), block(10, flat(0, 30, 0, 20)), block(20, flat(30.01, 60, 0, 20))))
        self.assertEqual(len(run.json("s.json")), 2)
        run = Run(program(cycle(10, 20), block(10, flat(0, 30, 0, 20)), block(20, flat(30.01, 60, 0, 20))), "--join", "0.02")
        s = run.json("s.json")
        self.assertEqual(len(s), 1)
        self.assertAlmostEqual(s[0]["joints"][0]["gap_mm"], 0.01, places=6)
        self.assertAlmostEqual(run.json()["quality"]["join_gap_max_mm"], 0.01, places=6)


class Paths(unittest.TestCase):
    def test_setpoints_lie_on_the_tool_surface_and_keep_the_limits(self):
        for method in (1, 2):
            run = Run(program(cycle(10, 10, i=method, s=0.02), block(10, wave(0, 50, 0, 30))))
            s = run.points()
            check_limits(self, s, 0.001)
            check_on_surface(self, s, [Surface(x) for x in run.json("s.json")], 3.0)
            worst, count = steady_fluctuation(s, 0.001, 1200.0)
            self.assertGreater(count, 1000)
            self.assertLess(worst, 1e-4)
            q = run.json()["quality"]
            self.assertLessEqual(q["scallop_max_mm"], 0.02 * (1.0 if method == 1 else 1.02) + 1e-9)
            self.assertLess(q["chord_error_max_mm"], 0.001)
            self.assertLess(q["gouge_max_mm"], 1e-3)

    def test_scallop_on_a_plane(self):
        """h = R - sqrt(R^2 - (d/2)^2) for paths d apart; the plan must come close to S from below."""
        run = Run(program(cycle(10, 10, i=1, s=0.01), block(10, flat(0, 40, 0, 25, slope=0.3))))
        tips = passes_of(run.points())
        # Distance of neighbouring paths, square to the path, in the plane of the surface.
        n = np.array([-0.3, 0, 1]) / math.hypot(0.3, 1)
        gaps = []
        keys = sorted(tips)
        for a, b in zip(keys, keys[1:]):
            along = tips[a][-1] - tips[a][0]
            along /= np.linalg.norm(along)
            side = np.cross(n, along)
            gaps.append(abs(np.dot(tips[b][0] - tips[a][0], side)))
        heights = [3 - math.sqrt(9 - (g / 2) ** 2) for g in gaps]
        self.assertLessEqual(max(heights), 0.01 + 1e-9)
        self.assertGreater(min(heights[:-1]), 0.0098)

    def test_side_step_binds(self):
        run = Run(program(cycle(10, 10, i=1, m=0.2, s=0.05), block(10, flat(0, 40, 0, 10))))
        self.assertLessEqual(run.json()["quality"]["side_step_max_mm"], 0.2 + 1e-9)
        self.assertGreaterEqual(run.json()["counts"]["paths"], 51)

    def test_iso_scallop_by_brute_force(self):
        """Material left over points of the surface, from the tips of all paths: no planner figure is used."""
        radius, scallop = 5.0, 0.02
        run = Run(program(cycle(10, 10, i=2, d=10, s=scallop, f=3000), block(10, wave(0, 50, 0, 30, height=5))))
        surface = Surface(run.json("s.json")[0])
        tips = passes_of(run.points())
        centers = np.concatenate([t[::3] for t in tips.values()]) + np.array([0, 0, radius])
        u0, u1, v0, v1 = surface.domain()
        left = []
        # A line across the paths in the middle and near the ends; dense enough to see every ridge.
        along_u = run.json()["parameters"]["along"] == "u"
        for share in (0.2, 0.5, 0.8):
            heights = []
            for t in np.linspace(0.0, 1.0, 4000):
                u = u0 + (share if along_u else t) * (u1 - u0)
                v = v0 + (t if along_u else share) * (v1 - v0)
                p, n = surface.point(u, v), surface.normal(u, v)
                d = centers - p
                near = d[np.einsum("ij,ij->i", d, d) < (radius + 2 * scallop + 0.2) ** 2]
                # p + h n is cut when |p + h n - c| < R: the lowest h that some ball reaches.
                b = near @ n
                q = b * b - (np.einsum("ij,ij->i", near, near) - radius * radius)
                h = (b - np.sqrt(np.maximum(q, 0)))[q > 0]
                heights.append(h.min() if len(h) else np.inf)
            ridges = [heights[i] for i in range(1, len(heights) - 1) if heights[i] >= heights[i - 1] and heights[i] > heights[i + 1] and heights[i] > scallop / 3]
            self.assertGreater(len(ridges), 8)
            left.append(ridges)
        for ridges in left:
            self.assertLess(max(ridges), scallop * 1.02)
            self.assertGreater(min(ridges[1:-1]), scallop * 0.95)  # sampled peaks lie a little below the true ones

    def test_shorter_with_iso_scallop(self):
        net = wave(0, 60, 0, 40, height=8)
        one = Run(program(cycle(10, 10, i=1), block(10, net))).json()["lengths_mm"]["cut"]
        two = Run(program(cycle(10, 10, i=2), block(10, net))).json()["lengths_mm"]["cut"]
        self.assertLess(two, one)

    def test_concave_groove_is_lifted(self):
        """A groove of radius 2 under a ball of radius 3: the ball cannot reach the ground, and says so."""
        net = [[(2 * c, y, 2 * s, w) for c, s, w in ((-1, 0, 1), (-1, -1, math.sqrt(0.5)), (0, -1, 1), (1, -1, math.sqrt(0.5)), (1, 0, 1))] for y in (0, 20)]
        run = Run(program(cycle(10, 10, s=0.02), block(10, net, order=(3, 2), knots=[0, 0, 0, 1, 1, 2, 2, 2, 0, 0, 1, 1])), expect=(0, 3))
        self.assertGreater(run.json()["counts"]["lifted"], 0)
        # The rims at x = -2 and 2, z = 0 hold the ball: its centre stands at sqrt(9 - (2 - |x|)^2) above them.
        s = run.points()
        cut = s[s[:, 6] >= 0]
        rim = np.sqrt(9 - (2 - np.minimum(np.abs(cut[:, 1]), 2)) ** 2) - 3
        self.assertGreater((cut[:, 3] - rim).min(), -0.0101)
        middle = cut[np.abs(cut[:, 1]) < 0.05]
        self.assertGreater(len(middle), 0)
        self.assertLess(middle[:, 3].min(), math.sqrt(5) - 3 + 0.01)


class Program(unittest.TestCase):
    def test_repeats(self):
        run = Run(program("G106.1 W25.;\n", block(10, wave(0, 15, 0, 15)), "G91 X20.;\nX20.;\nG80;\n"))
        self.assertEqual(run.json()["counts"]["repeats"], 2)
        self.assertEqual(run.json()["counts"]["surfaces_out"], 1)
        s = run.points()
        cut = s[s[:, 6] >= 0]
        self.assertGreater(cut[:, 1].max(), 50)
        # Between two machinings the tool is at the safety height when it travels.
        rapid = s[(s[:, 6] < 0) & (s[:, 1] > 16) & (s[:, 1] < 19)]
        self.assertGreater(len(rapid), 0)
        self.assertGreaterEqual(rapid[:, 3].min(), 25 - 1e-6)

    def test_ordinary_moves_and_curves(self):
        text = ("%\nG21 G90 G00 X0 Y0 Z10.;\nG01 Z0. F1000.;\nG01 X20.;\nG03 X20. Y20. I0. J10.;\nG02 X0. Y20. R10.;\n"
                "G06.2 P4 K0 X0. Y20. Z0. R1.;\nK0 X5. Y30. Z0.;\nK0 X10. Y30. Z2.;\nK0 X15. Y20. Z2.;\nK1;\nK1;\nK1;\nK1;\n"
                "G01 Z10.;\nM30;\n%\n")
        run = Run(text)
        s = run.points()
        check_limits(self, s, 0.001)
        np.testing.assert_allclose(s[-1, 1:4], [15, 20, 10], atol=1e-9)
        on_arc = s[(s[:, 1] > 20.5)]
        np.testing.assert_allclose(np.hypot(on_arc[:, 1] - 20, on_arc[:, 2] - 10), 10, atol=1e-6)

    def test_csv_and_npy_agree(self):
        text = program(cycle(10, 10, s=0.05), block(10, wave(0, 20, 0, 10)))
        run = Run(text, "--setpoints", "s.csv", "--json", "o.json", outputs=False)
        with open(run.file("s.csv"), newline="") as f:
            rows = list(csv.reader(f))
        self.assertEqual(rows[0], ["t_s", "x_mm", "y_mm", "z_mm", "feed_mm_min", "surface", "path", "u", "v"])
        s = Run(text).points()
        self.assertEqual(len(rows) - 1, len(s))
        self.assertEqual(s.shape[1], 9)
        for i in range(0, len(s), 97):
            for k in range(9):
                if rows[i + 1][k] == "":
                    self.assertTrue(math.isnan(s[i, k]))
                else:
                    self.assertAlmostEqual(float(rows[i + 1][k]), s[i, k], delta=1e-9 * max(1, abs(s[i, k])))
        self.assertIn("", rows[1])

    def test_period_and_limits(self):
        text = program(cycle(10, 10, s=0.05, f=6000), block(10, wave(0, 30, 0, 10)))
        run = Run(text, "--period", "0.0005", "--accel", "800", "--jerk", "9000", "--rapid", "5000")
        check_limits(self, run.points(), 0.0005, 800, 9000)
        self.assertLessEqual(run.points()[:, 4].max(), 6000 * (1 + 1e-9))

    def test_nc_follows_the_setpoints(self):
        run = Run(program(cycle(10, 10, s=0.05), block(10, wave(0, 20, 0, 10))), "--tolerance", "0.005")
        with open(run.file("o.ngc")) as f:
            nc = f.read()
        self.assertNotRegex(nc, r"[0-9][eE][-+]?[0-9]")
        self.assertTrue(all(len(line) < 256 for line in nc.splitlines()))
        # Ends of straight blocks lie near the stream.
        s = run.points()[:, 1:4]
        x = y = z = None
        count = 0
        for line in nc.splitlines():
            line = re.sub(r"\(.*?\)", "", line)
            words = dict((c, float(v)) for c, v in re.findall(r"([XYZ])([-+0-9.]+)", line))
            if not words or "G53" in line:
                continue
            x, y, z = words.get("X", x), words.get("Y", y), words.get("Z", z)
            if None in (x, y, z):
                continue
            count += 1
            if count % 5 == 0:
                self.assertLess(np.linalg.norm(s - np.array([x, y, z]), axis=1).min(), 0.03)
        self.assertGreater(count, 50)

    def test_same_bytes(self):
        text = program(cycle(10, 20, i=2, s=0.03), block(10, wave(0, 30, 0, 20)), block(20, wave(30, 60, 0, 20)))
        a, b = Run(text), Run(text, "--threads", "1")
        for name in ("o.ngc", "o.cl", "s.json", "s.npy"):
            with open(a.file(name), "rb") as one, open(b.file(name), "rb") as two:
                self.assertEqual(one.read(), two.read(), name)

    def test_report_of_the_tolerance(self):
        """The parameters are those in force: a forced join may bend as much as --tolerance says unless told otherwise."""
        text = program(cycle(10, 10, s=0.05), block(10, flat(0, 10, 0, 5)))
        p = Run(text, "--tolerance", "0.005").json()["parameters"]
        self.assertEqual((p["tolerance_mm"], p["join_deviation_mm"]), (0.005, 0.005))
        p = Run(text, "--tolerance", "0.005", "--join-deviation", "0.02").json()["parameters"]
        self.assertEqual((p["tolerance_mm"], p["join_deviation_mm"]), (0.005, 0.02))

    def test_errors_leave_nothing(self):
        good = program(cycle(10, 10), block(10, flat(0, 30, 0, 20)))
        for bad, where in ((good.replace("P10 Q10", "P30 Q10"), "p.nc:4:"), (good.replace("X10. ", "X10. X11. ", 1), "p.nc:"),
                           (good.replace("D6. L0.", "D0. L0.").replace("D6.", "D0."), "p.nc:")):
            run = Run(bad, expect=(1,))
            self.assertIn(where, run.stderr)
            self.assertEqual(os.listdir(run.folder), ["p.nc"])

    def test_empty_and_odd_names(self):
        self.assertIn("moves nothing", Run("%\nM30\n%\n", expect=(3,)).stderr)
        run = Run("M30\n", "--setpoints", "s.txt", outputs=False, expect=(2,))
        self.assertIn(".npy", run.stderr)

    def test_strict(self):
        """G91 of the repeats stays in force: the last retract becomes a step."""
        text = program("G106.1 W25.;\n", block(10, flat(0, 20, 0, 10)), "N50 G91 X30.;\n").replace("G90 G00 Z40.", "G00 Z40.")
        self.assertIn("G91", Run(text).stderr)
        self.assertEqual(os.listdir(Run(text, "--strict", expect=(1,)).folder), ["p.nc"])

    def test_safety_height_below_the_part(self):
        run = Run(program(cycle(10, 10, w=2, s=0.05), block(10, wave(0, 30, 0, 20, height=6))), expect=(1,))
        self.assertIn("safety", run.stderr)


if __name__ == "__main__":
    BURIN = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=1)
