#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The contract of `burin orient` and `burin cspace` from outside. Parts are written here; angles, radii and poses are computed again
by formulas of our own, and the tool is held against dense samples of the part.
usage: orient_cli_test.py PATH/TO/burin"""
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
COLUMNS = ("path,index,x,y,z,nx,ny,nz,fx,fy,fz,alpha_deg,beta_deg,rho_mm,alpha_initial_deg,beta_initial_deg,rho_initial_mm,"
           "px,py,pz,ux,uy,uz,tests,cause,state").split(",")
TEXT = ("cause", "state")


# --- parts ------------------------------------------------------------------------------------------------------------

def stl(triangles):
    out = b"part".ljust(80) + struct.pack("<I", len(triangles))
    for t in triangles:
        out += struct.pack("<12fH", 0, 0, 0, *t[0], *t[1], *t[2], 0)
    return out


def sheet(point, us, vs):
    """Triangles of a grid of point(u, v)."""
    out = []
    for u0, u1 in zip(us, us[1:]):
        for v0, v1 in zip(vs, vs[1:]):
            a, b, c, d = point(u0, v0), point(u1, v0), point(u1, v1), point(u0, v1)
            out += [(a, b, c), (a, c, d)]
    return out


def plane(half=40.0, z=0.0, n=4):
    return sheet(lambda u, v: (u, v, z), np.linspace(-half, half, n + 1), np.linspace(-half, half, n + 1))


TROUGH, WALL, TALL = 90.0, 12.0, 45.0


def trough():
    """z = x^2 / 180: concave along x; a wall at y = 12."""
    xs = np.linspace(-30, 30, 41)
    bottom = lambda x: x * x / (2 * TROUGH)
    floor = sheet(lambda u, v: (u, v, bottom(u)), xs, np.linspace(-30, WALL, 8))
    return floor + sheet(lambda u, v: (u, WALL, bottom(u) + v * (TALL - bottom(u))), xs, np.linspace(0, 1, 4))


def trough_contacts(ys=(0.0,), xs=tuple(np.linspace(-12, 18, 11))):
    lines = ["path,x,y,z,nx,ny,nz,fx,fy,fz"]
    for path, y in enumerate(ys):
        for x in xs:
            s = x / TROUGH
            k = math.sqrt(1 + s * s)
            lines.append(f"{path},{x!r},{y!r},{x * x / (2 * TROUGH)!r},{-s / k!r},0,{1 / k!r},{1 / k!r},0,{s / k!r}")
    return "\n".join(lines) + "\n"


def plane_contacts(n=9, z=0.0, normal="0,0,1", feed="1,0,0"):
    return "path,x,y,z,nx,ny,nz,fx,fy,fz\n" + "".join(f"0,{x},0,{z},{normal},{feed}\n" for x in np.linspace(-20, 20, n))


TOOL = 'kind = "flat"\nradius = 8.0\nlength = 25.0\nholder = [{ radius = 15.0, height = 40.0 }]'
BULL = 'kind = "bull"\nradius = 8.0\ncorner_radius = 1.5\nlength = 25.0\nholder = [{ radius = 15.0, height = 40.0 }]'
OPERATION = "tilt = [1.5, 40.0]\nyaw = [-90.0, 90.0]\ntolerance = 0.02\nclearance = 1.0\nfeed = 1000.0"


def job(part='mesh = "part.stl"\ncontacts = "contacts.csv"', tool=TOOL, operation=OPERATION, machine='name = "none"'):
    return f"[part]\n{part}\n[tool]\n{tool}\n[operation]\n{operation}\n[machine]\n{machine}\n"


PLANE = {"part.stl": stl(plane()), "contacts.csv": plane_contacts()}
TROUGH_FILES = {"part.stl": stl(trough()), "contacts.csv": trough_contacts()}
PROPELLER = 'propeller = { blades = 5, diameter = 1000.0, pitch_ratio = 1.0, area_ratio = 0.75, hub_ratio = 0.18, side = "face" }'
PROPELLER_TOOL = 'kind = "flat"\nradius = 30.0\nlength = 60.0\nholder = [{ radius = 40.0, height = 150.0 }]'
PROPELLER_WORK = 'paths = "iso-v"\ntilt = [1.5, 20.0]\ntolerance = 0.4\nclearance = 1.0\npath_count = 3\nmax_step = 30.0'
REPORTS = ("--cl", "o.cl", "--json", "o.json", "--points", "o.csv", "--html", "o.html")
NC = ("-o", "o.ngc", *REPORTS)


# Containers run as root and have few cores; other implementations of MPI do not ask.
OPEN_MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}


class Run:
    def __init__(self, text, *options, files=None, expect=(0,), outputs=REPORTS, command="orient", before=()):
        self.folder = tempfile.mkdtemp(prefix="orient-")
        self.given = {"job.toml", *(files or {})}
        for name, content in {"job.toml": text, **(files or {})}.items():
            with open(self.file(name), "wb") as f:
                f.write(content if isinstance(content, bytes) else content.encode())
        self.process = subprocess.run([*before, BURIN, command, "job.toml", *outputs, *options], cwd=self.folder, capture_output=True, text=True, timeout=120,
                                      env={**os.environ, **OPEN_MPI})
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

    def rows(self, name="o.csv"):
        with open(self.file(name), newline="") as f:
            return [{k: v if k in TEXT else float(v) for k, v in r.items()} for r in csv.DictReader(f)]

    def __del__(self):
        shutil.rmtree(self.folder, ignore_errors=True)


# --- the tool, on its own -----------------------------------------------------------------------------------------------

def vec(row, *names):
    return np.array([row[n] for n in names])


def pose(c, n, f, alpha, beta, R, r=0.0):
    """Angles in radians; arrays of them give arrays of poses."""
    alpha, beta = np.asarray(alpha)[..., None], np.asarray(beta)[..., None]
    t = np.cross(n, f)
    d = f * np.cos(beta) + t * np.sin(beta)
    u = n * np.cos(alpha) + d * np.sin(alpha)
    m = n * np.sin(alpha) - d * np.cos(alpha)  # in the plane of the bottom, from the contact towards the middle
    return c + r * n + (R - r) * m - r * u, u


def rho(alpha, beta, R, r=0.0):
    with np.errstate(divide="ignore"):
        return np.cos(beta) ** 2 * (R - r + r * np.sin(alpha)) / np.sin(alpha) + r * np.sin(beta) ** 2


def samples(triangles, spacing):
    out = []
    for a, b, c in np.array(triangles):
        n = max(1, math.ceil(max(np.linalg.norm(b - a), np.linalg.norm(c - a), np.linalg.norm(c - b)) / spacing))
        i, j = np.meshgrid(np.arange(n + 1), np.arange(n + 1))
        keep = i + j <= n
        out.append(a + np.outer(i[keep] / n, b - a) + np.outer(j[keep] / n, c - a))
    return np.unique(np.round(np.concatenate(out), 9), axis=0)


class Body:
    """Cutting body and holder against points: `excess` > 0 where a pose is not allowed."""

    def __init__(self, points, R=8.0, length=25.0, holder=((15.0, 40.0),), r=0.0, clearance=1.0):
        self.points, self.R, self.length, self.r, self.clearance, self.holder = points, R, length, r, clearance, holder

    def excess(self, tip, axis):
        """(cutter: deepest point, holder: clearance less least distance), mm."""
        q = self.points - tip
        h = q @ axis
        d = np.sqrt(np.maximum(np.einsum("ij,ij->i", q, q) - h * h, 0))
        depth = np.minimum(np.minimum(self.R - d, self.length - h), h)
        if self.r > 0:  # below the corner's centre circle the wall is a quarter of a torus
            inner = np.maximum(d - (self.R - self.r), 0)
            corner = self.r - np.hypot(inner, np.maximum(self.r - h, 0))
            depth = np.where(h < self.r, np.minimum(depth, np.where(inner > 0, corner, depth)), depth)
        near, z = math.inf, self.length
        for radius, height in self.holder:
            out = np.hypot(np.maximum(d - radius, 0), np.maximum(np.maximum(z - h, h - z - height), 0))
            near, z = min(near, out.min()), z + height
        return depth.max(), self.clearance - near


# --- tests ------------------------------------------------------------------------------------------------------------

class Contract(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = Run(job(machine='name = "xyzac-trunnion"'), files=TROUGH_FILES, outputs=NC)

    def test_files_and_keys(self):
        self.assertEqual(self.made.left, ["o.cl", "o.csv", "o.html", "o.json", "o.ngc"])
        j = self.made.json()
        for key in ("operation", "version", "input", "inputs_sha256", "parameters", "counts", "lengths_mm", "time_s", "quality", "warnings", "outputs"):
            self.assertIn(key, j)
        self.assertEqual(j["operation"], "orient")
        self.assertLessEqual({"contact_points", "unreachable", "feasibility_tests"}, set(j["counts"]))
        self.assertLessEqual({"rho_gain_mean", "rho_gain_per_path", "axis_step_max_deg", "gouge_max_mm"}, set(j["quality"]))
        self.assertLessEqual({"cut", "link", "rapid"}, set(j["lengths_mm"]))
        self.assertLessEqual({"planning", "machining"}, set(j["time_s"]))
        self.assertEqual(sorted(j["inputs_sha256"]), ["contacts.csv", "job.toml", "part.stl"])
        self.assertEqual(self.made.bytes("o.csv").decode().splitlines()[0], ",".join(COLUMNS))
        self.assertIn("G93", self.made.bytes("o.ngc").decode())
        self.assertEqual(j["counts"]["contact_points"], len(self.made.rows()))

    def test_report_stands_alone(self):
        page = self.made.bytes("o.html").decode()
        self.assertNotRegex(page, r"(src|href)\s*=\s*[\"']?http|@import|url\(")
        self.assertTrue(page.rstrip().endswith("</html>"))

    def test_gain_is_that_of_the_points(self):
        rows, q = self.made.rows(), self.made.json()["quality"]
        gains = [r["rho_mm"] / r["rho_initial_mm"] - 1 for r in rows if r["state"] == "ok" and r["rho_initial_mm"] > 0]
        self.assertGreater(len(gains), 5)
        self.assertAlmostEqual(q["rho_gain_mean"], np.mean(gains), places=9)
        self.assertAlmostEqual(q["rho_gain_per_path"][0], np.mean(gains), places=9)
        self.assertGreater(q["rho_gain_mean"], 0)

    def test_nc_runs_through_the_cl_points(self):
        """Joints of the trunnion back to the part: every CL point is passed."""
        at, passed = dict.fromkeys("XYZAC", 0.0), []
        for line in self.made.bytes("o.ngc").decode().splitlines():
            words = re.findall(r"([XYZAC])(-?\d*\.?\d+)", re.sub(r"\(.*?\)", "", line))
            at.update({c: float(v) for c, v in words})
            a, c = math.radians(at["A"]), math.radians(at["C"])
            q = np.array([at["X"], at["Y"] * math.cos(a) + at["Z"] * math.sin(a), -at["Y"] * math.sin(a) + at["Z"] * math.cos(a)])
            u = np.array([0.0, math.sin(a), math.cos(a)])
            turn = np.array([[math.cos(c), math.sin(c), 0], [-math.sin(c), math.cos(c), 0], [0, 0, 1]])
            if words:
                passed.append(np.concatenate([turn @ q, 100 * (turn @ u)]))
        passed = np.array(passed)
        axis = [0.0, 0.0, 1.0]
        for line in self.made.bytes("o.cl").decode().splitlines():
            if line.startswith("GOTO/"):
                p = [float(v) for v in line[5:].split(",")]
                axis = p[3:6] or axis  # without one the last one holds
                self.assertLess(np.abs(passed - np.concatenate([p[:3], 100 * np.array(axis)])).max(axis=1).min(), 2e-3, line)

    def test_tcp(self):
        run = Run(job(machine='name = "xyzac-trunnion"'), "--tcp", "--dialect", "fanuc", files=TROUGH_FILES, outputs=("-o", "o.ngc"))
        self.assertIn("G43.4", run.bytes("o.ngc").decode())

    def test_default_output(self):
        self.assertEqual(Run(job(machine='name = "xyzac-trunnion"'), files=PLANE, outputs=()).left, ["job.ngc"])
        self.assertEqual(Run(job(), files=PLANE, outputs=()).left, ["job.cl"])


class Points(unittest.TestCase):
    """points.csv by formulas of our own, and the tool against dense samples of the part."""

    TOLERANCE = 0.02

    def check(self, run, R, r, body=None, tolerance=TOLERANCE, clearance_slack=1e-6):
        rows, deepest, nearest = run.rows(), -math.inf, -math.inf
        self.assertGreater(len(rows), 0)
        for row in rows:
            c, n, f = vec(row, "x", "y", "z"), vec(row, "nx", "ny", "nz"), vec(row, "fx", "fy", "fz")
            self.assertAlmostEqual(np.linalg.norm(n), 1, places=12)
            self.assertAlmostEqual(np.linalg.norm(f), 1, places=12)
            self.assertAlmostEqual(n @ f, 0, places=9)
            self.assertIn(row["cause"], ("none", "gouge", "collision", "limit", "bound"))
            if row["rho_initial_mm"] > 0:
                self.assertAlmostEqual(row["rho_initial_mm"] / rho(math.radians(row["alpha_initial_deg"]), math.radians(row["beta_initial_deg"]), R, r), 1, places=9)
                self.assertGreaterEqual(row["rho_mm"], row["rho_initial_mm"] * (1 - 1e-9))
            if row["state"] != "ok":
                continue
            a, b = math.radians(row["alpha_deg"]), math.radians(row["beta_deg"])
            tip, axis = pose(c, n, f, a, b, R, r)
            self.assertLess(np.abs(tip - vec(row, "px", "py", "pz")).max(), 1e-6)
            self.assertLess(np.abs(axis - vec(row, "ux", "uy", "uz")).max(), 1e-9)
            self.assertAlmostEqual(row["rho_mm"] / rho(a, b, R, r), 1, places=9)
            if body is not None:
                gouge, near = body.excess(tip, axis)
                deepest, nearest = max(deepest, gouge), max(nearest, near)
        if body is not None:
            self.assertLessEqual(deepest, tolerance + 1e-6)
            self.assertLessEqual(nearest, clearance_slack)
        return rows

    def test_trough_with_wall(self):
        run = Run(job(), files={**TROUGH_FILES, "contacts.csv": trough_contacts((0.0, -8.0))})
        body = Body(samples(trough(), 0.4))
        rows = self.check(run, 8.0, 0.0, body)
        self.assertTrue(all(r["state"] == "ok" for r in rows))
        # The wall takes the straight lean away; far from it nothing but the trough counts.
        self.assertTrue(all(abs(r["beta_deg"]) > 5 for r in rows if r["path"] == 0), [r["beta_deg"] for r in rows])
        self.assertTrue(all(abs(r["beta_deg"]) < 1 for r in rows if r["path"] == 1), [r["beta_deg"] for r in rows])

    def test_bull(self):
        self.check(Run(job(tool=BULL), files=TROUGH_FILES), 8.0, 1.5, Body(samples(trough(), 0.4), r=1.5))

    def test_smooth_and_contour(self):
        body = Body(samples(trough(), 0.5))
        best = Run(job(), files=TROUGH_FILES).rows()
        for one, most in zip(self.check(Run(job(operation=OPERATION + '\nsearch = "contour"'), files=TROUGH_FILES), 8.0, 0.0, body), best):
            self.assertLessEqual(one["rho_mm"], most["rho_mm"] * (1 + 1e-3))
        self.check(Run(job(operation=OPERATION + "\nsmooth = true"), files=TROUGH_FILES), 8.0, 0.0, body)

    def test_optimum_in_a_second_narrow_piece(self):
        """At the points in the middle a piece of the allowed set near a yaw of 69 degrees, narrower than the steps in which yaws are looked
        at first, holds the optimum (rho 12.1; 11.1 in the other piece). `smooth` asks the neighbours' angles too and comes upon it."""
        best = Run(job(), files=TROUGH_FILES).rows()
        for one, most in zip(Run(job(operation=OPERATION + "\nsmooth = true"), files=TROUGH_FILES).rows(), best):
            self.assertLessEqual(one["rho_mm"], most["rho_mm"] * (1 + 1e-3))

    def test_plane_is_the_corner(self):
        for r in Run(job(), files=PLANE).rows():
            self.assertAlmostEqual(r["alpha_deg"], 1.5, places=9)
            self.assertAlmostEqual(r["beta_deg"], 0, places=9)
            self.assertEqual(r["cause"], "bound")

    def test_flat_bottom_is_infinitely_wide(self):
        run = Run(job(operation=OPERATION.replace("1.5", "0.0")), files=PLANE)
        with open(run.file("o.csv"), newline="") as f:
            self.assertTrue(all(r["rho_mm"] == "inf" for r in csv.DictReader(f)))
        self.assertTrue(math.isfinite(run.json()["quality"]["rho_gain_mean"]))

    def test_best_of_a_brute_force_search(self):
        """A grid of angles over samples that are kept a little farther away than need be: none of its free ones is better."""
        spacing = 0.5
        # A point of the part lies within spacing / sqrt(2) of a sample: sagging of the tool's wall over that is allowed for.
        sag = spacing**2 / (4 * 8.0)
        body = Body(samples(trough(), spacing))
        rows = Run(job(), files=TROUGH_FILES).rows()
        for row in (rows[0],):
            c, n, f = vec(row, "x", "y", "z"), vec(row, "nx", "ny", "nz"), vec(row, "fx", "fy", "fz")
            best = 0.0
            for a in np.radians(np.linspace(1.5, 40, 36)):
                for b in np.radians(np.linspace(-60, 60, 31)):
                    if rho(a, b, 8.0) <= best:
                        continue
                    gouge, near = body.excess(*pose(c, n, f, a, b, 8.0))
                    if gouge <= 0.02 - sag and near <= -sag:
                        best = rho(a, b, 8.0)
            self.assertGreater(best, 0)
            self.assertGreaterEqual(row["rho_mm"], 0.999 * best)

    def test_propeller(self):
        run = Run(job(PROPELLER, PROPELLER_TOOL, PROPELLER_WORK, 'name = "propeller-head-head"'), outputs=NC, expect=(0, 3))
        self.check(run, 30.0, 0.0)
        j = run.json()
        self.assertEqual(len(j["quality"]["rho_gain_per_path"]), j["counts"]["paths"])
        self.assertLess(j["counts"]["unreachable"], j["counts"]["contact_points"] / 2)
        self.assertLessEqual({"sturz_machining", "ball_machining"}, set(j["time_s"]))


class CSpace(unittest.TestCase):
    def test_boundary_within_half_a_cell(self):
        """Every node of the map by samples of the part; where the two differ the boundary passes within half a cell."""
        tilts, yaws = 23, 37
        run = Run(job(), "--path", "0", "--point", "4", "--grid", f"{tilts}x{yaws}", "--csv", "m.csv", "--png", "m.png", "--svg", "m.svg", "--json", "o.json",
                  files=TROUGH_FILES, outputs=(), command="cspace")
        self.assertEqual(run.left, ["m.csv", "m.png", "m.svg", "o.json"])
        self.assertEqual(run.bytes("m.png")[:8], b"\x89PNG\r\n\x1a\n")
        rows = run.rows("m.csv")
        self.assertEqual(run.bytes("m.csv").decode().splitlines()[0], "alpha_deg,beta_deg,cause,rho_mm")
        self.assertEqual(len(rows), tilts * yaws)
        alphas, betas = sorted({round(r["alpha_deg"], 9) for r in rows}), sorted({round(r["beta_deg"], 9) for r in rows})
        self.assertEqual((len(alphas), alphas[0], alphas[-1]), (tilts, 1.5, 40))
        self.assertEqual((len(betas), betas[0], betas[-1]), (yaws, -90, 90))
        at = Run(job(), files=TROUGH_FILES).rows()[4]
        c, n, f = vec(at, "x", "y", "z"), vec(at, "nx", "ny", "nz"), vec(at, "fx", "fy", "fz")
        body = Body(samples(trough(), 0.5))

        def word(alpha, beta):
            gouge, near = body.excess(*pose(c, n, f, math.radians(alpha), math.radians(beta), 8.0))
            return "gouge" if gouge > 0.02 else "collision" if near > 0 else "feasible"

        da, db = (40 - 1.5) / (tilts - 1) / 2, 180 / (yaws - 1) / 2
        differ, seen = 0, set()
        for r in rows:
            a, b = r["alpha_deg"], r["beta_deg"]
            self.assertAlmostEqual(r["rho_mm"], rho(math.radians(a), math.radians(b), 8.0), delta=1e-9 * (1 + r["rho_mm"]))
            seen.add(r["cause"])
            if word(a, b) != r["cause"]:
                differ += 1
                self.assertIn(r["cause"], {word(a + i * da, b + k * db) for i in (-1, 0, 1) for k in (-1, 0, 1)}, (a, b))
        self.assertEqual(seen, {"gouge", "collision", "feasible"})
        self.assertLess(differ, len(rows) / 20)

    def test_standard_output_and_marks(self):
        run = Run(job(), "--path", "0", "--point", "0", "--grid", "3x5", files=PLANE, outputs=(), command="cspace")
        self.assertEqual(run.left, [])
        lines = run.process.stdout.splitlines()
        self.assertEqual(len(lines), 16)
        self.assertTrue(all(line.endswith("inf") or "feasible" in line for line in lines[1:]))

    def test_usage(self):
        for options, words in ((("--path", "0"), "--point"), (("--path", "0", "--point", "99"), "9 points"), (("--path", "7", "--point", "0"), "1 path"),
                               (("--path", "-1", "--point", "0"), "whole number"), (("--path", "0", "--point", "0", "--grid", "90"), "90x45"),
                               (("--path", "0", "--point", "0", "--grid", "1x1"), "90x45"), (("--path", "0", "--point", "0", "--grid", "99999x99999"), "90x45")):
            run = Run(job(), *options, files=PLANE, outputs=("--csv", "m.csv"), command="cspace", expect=(2,))
            self.assertIn(words, run.stderr)
            self.assertEqual(run.left, [])


class Determinism(unittest.TestCase):
    def same(self, a, b, what):
        strip = lambda r, name: re.sub(rb'"planning": [\d.e+-]+| --threads \d', b"", r.bytes(name))
        for name in ("o.ngc", "o.cl", "o.csv", "o.json", "o.html"):
            self.assertEqual(strip(a, name), strip(b, name), f"{name} {what}")

    def run_job(self, *options, **more):
        return Run(self.text, *options, files=self.files, outputs=NC, expect=(0, 3), **more)

    def setUp(self):
        self.text = job(operation=OPERATION + "\nsmooth = true", machine='name = "xyzbc-head-table"')
        self.files = {**TROUGH_FILES, "contacts.csv": trough_contacts((0.0, -3.0, -6.0, -9.0, 11.0))}

    def test_threads(self):
        one = self.run_job("--threads", "1")
        for threads in ("2", "3"):
            self.same(one, self.run_job("--threads", threads), f"with {threads} threads")

    def test_ranks(self):
        if shutil.which("mpirun") is None:
            self.skipTest("no mpirun here")
        before = ["mpirun", "-n"]
        one = self.run_job("--threads", "1")
        for ranks in ("1", "2", "3"):
            run = self.run_job("--threads", "1", before=[*before, ranks])
            if "built without MPI" in run.stderr:
                self.skipTest("burin was built without MPI (BURIN_MPI)")
            self.same(one, run, f"with {ranks} ranks")
        # An error is said once, and nobody waits for the others.
        bad = Run(self.text, files={**self.files, "part.stl": b""}, outputs=NC, expect=(1,), before=[*before, "3"])
        self.assertEqual(bad.stderr.count("part.stl:"), 1, bad.stderr)
        self.assertEqual(bad.left, [])


class Unreachable(unittest.TestCase):
    def listed(self, run, count):
        j, rows = run.json(), run.rows()
        lost = [r for r in rows if r["state"] == "unreachable"]
        self.assertEqual(len(lost), count)
        self.assertEqual(j["counts"]["unreachable"], count)
        said = [w for w in j["warnings"] if w["severity"] == "left_out" and w["code"] == "unreachable"]
        self.assertGreater(len(said), 0)
        self.assertIn("unreachable", run.stderr)
        for r in lost:  # numbers, but no angles
            self.assertEqual((r["alpha_deg"], r["beta_deg"], r["rho_mm"]), (0, 0, 0))
            self.assertIn(r["cause"], ("gouge", "collision", "limit"))
        # No CL point stands there.
        gotos = [line for line in run.bytes("o.cl").decode().splitlines() if line.startswith("GOTO/")]
        tips = np.array([[float(v) for v in line[5:].split(",")[:3]] for line in gotos] or [[1e9] * 3])
        for r in rows:
            near = np.linalg.norm(tips - vec(r, "px", "py", "pz"), axis=1).min()
            (self.assertLess if r["state"] == "ok" else self.assertGreater)(near, 1e-5)
        return said

    def test_some(self):
        """Points at the foot of the wall: the mill does not fit beside it, whatever its angles."""
        run = Run(job(), files={**TROUGH_FILES, "contacts.csv": trough_contacts((0.0, 11.9))}, expect=(3,))
        said = self.listed(run, 11)
        self.assertTrue(all(re.match(r"path 1, points? \d+.* unreachable: ", w["message"]) for w in said))
        self.assertLess(len(said), 10)  # runs of points, not one by one

    def test_limits_that_exclude_everything(self):
        machine = ('name = "stiff"\npivot_length = 0.0\n' + "".join(
            f'[[axes]]\nletter = "{c}"\nkind = "linear"\nside = "head"\ndirection = {d}\npoint = [0, 0, 0]\nmin = {lo}\nmax = {hi}\nspeed = 10000.0\nacceleration = 1000.0\n'
            for c, d, lo, hi in (("X", [1, 0, 0], -999.0, 999.0), ("Y", [0, 1, 0], -999.0, 999.0), ("Z", [0, 0, 1], 500.0, 999.0))) + "".join(
                f'[[axes]]\nletter = "{c}"\nkind = "rotary"\nside = "head"\ndirection = {d}\npoint = [0, 0, 0]\nmin = -9.0\nmax = 9.0\nspeed = 5000.0\nacceleration = 500.0\n'
                for c, d in (("C", [0, 0, 1]), ("B", [0, 1, 0]))))
        files = {**PLANE, "stiff.toml": machine}
        run = Run(job(machine='name = "stiff.toml"'), files=files, expect=(3,), outputs=NC)
        self.listed(run, 9)
        self.assertRegex(run.stderr, "no contact point is reachable.*machine")
        self.assertIn("stiff.toml", run.json()["inputs_sha256"])
        nothing = Run(job(machine='name = "stiff.toml"'), files=files, expect=(1,), outputs=("-o", "o.ngc"))
        self.assertEqual(nothing.left, [])

    def test_normals_the_wrong_way(self):
        run = Run(job(), files={**PLANE, "part.stl": stl(plane() + plane(z=-3.0)), "contacts.csv": plane_contacts(z=-3.0)}, expect=(3,))
        self.listed(run, 9)
        self.assertRegex(run.stderr, "normals")

    def test_contact_inside_or_off(self):
        inside = Run(job(), files={**PLANE, "contacts.csv": plane_contacts(z=-5.0)}, expect=(1, 3))
        self.assertRegex(inside.stderr, "below")
        off = Run(job(), files={**PLANE, "contacts.csv": plane_contacts(z=0.5)}, expect=(0, 1, 3))
        self.assertRegex(off.stderr, "above")


class BadInput(unittest.TestCase):
    def refused(self, text, *words, files=None, code=(1,), accepted=True, outputs=NC):
        run = Run(text, files=files if files is not None else PLANE, expect=code, outputs=outputs)
        self.assertEqual(run.left, [], run.stderr)
        self.assertLess(len(run.stderr.splitlines()), 4, run.stderr)
        if accepted:
            self.assertRegex(run.stderr, r"\(.*\)")  # what would be accepted
        for word in words:
            self.assertRegex(run.stderr, word)
        return run.stderr

    machine = 'name = "xyzac-trunnion"'

    def test_part(self):
        where = r"job\.toml:\d+:\d+"
        for part, word in (('contacts = "contacts.csv"', "surface, mesh or propeller"),
                           ('mesh = "part.stl"', "contacts"),
                           ('mesh = "part.stl"\nsurface = "a.step"\ncontacts = "contacts.csv"', "beside"),
                           (PROPELLER + '\nmesh = "part.stl"', "beside"),
                           ('mesh = "part.stl"\ncontact = "contacts.csv"', "contacts"),
                           ('mesh = "part.stl"\ncontacts = "contacts.csv"\nfaces = [1]', "faces"),
                           ('surface = "a.step"\nfaces = [0]', "faces"),
                           ('surface = "a.step"\nfaces = [1, 1]', "twice"),
                           ('surface = "a.step"\nfaces = []', "faces"),
                           ('surface = "a.step"\nflip = 1', "true"),
                           ('surface = 5', "text"), ('surface = ""', "empty"),
                           ('surface = "a.step"\nobstacles = "hub.stl"', "list"),
                           ('surface = "a.step"\nobstacles = [3]', "file"),
                           ("propeller = 5", "table"),
                           (PROPELLER.replace("blades = 5", "blades = 99"), "blades"),
                           (PROPELLER.replace("blades = 5", "blades = 4.5"), "whole"),
                           (PROPELLER.replace("area_ratio = 0.75", "area_ratio = 7.0"), "area"),
                           (PROPELLER.replace("blades", "blade"), "did you mean blades"),
                           (PROPELLER.replace("1000.0", "nan"), "diameter"),
                           (PROPELLER.replace('"face"', '"left"'), "face, back")):
            self.refused(job(part, machine=self.machine), where, word)

    def test_tool(self):
        where = r"job\.toml:\d+:\d+"
        for tool, word in (("radius = 8.0", "length"), ("length = 8.0", "radius"), (TOOL.replace("25.0", "0.0"), "length"), (TOOL.replace("8.0", "-8.0"), "radius"),
                           (TOOL.replace("8.0", "inf"), "radius"), (TOOL.replace("8.0", "1e300"), "radius"), (TOOL.replace("8.0", '"8"'), "radius"),
                           (TOOL.replace("flat", "ball"), "flat, bull"), (TOOL + "\ncorner_radius = 2.0", "bull"), (BULL.replace("1.5", "9.0"), "corner"),
                           (TOOL + "\nholders = []", "did you mean holder"), (TOOL + "\nshank = 3", "shank"), (TOOL + "\nhead = [{ radius = 3.0 }]", "height"),
                           (TOOL + "\nhead = [{ radius = 3.0, height = nan }]", "height")):
            self.refused(job(tool=tool, machine=self.machine), where, word)

    def test_operation(self):
        where = r"job\.toml:\d+:\d+"
        for bad, word in (("tilt = [20.0, 1.5]", "empty"), ("tilt = [1.0]", "lo, hi"), ("tilt = 5.0", "lo, hi"), ("tilt = [-5.0, 10.0]", "0 to"), ("tilt = [1.0, 120.0]", "0 to"),
                          ("tilt = [nan, 10.0]", "0 to"), ('tilt = ["a", 10.0]', "number"), ("yaw = [-100.0, 0.0]", "-90 to 90"), ("yaw = [10.0, -10.0]", "empty"),
                          ("tolerance = 0.0", "tolerance"), ("tolerance = 1e9", "tolerance"), ("tolerance = nan", "tolerance"), ("clearance = -1.0", "clearance"),
                          ('objective = "width"', "radius, strip"), ('search = "best"', "optimal, contour, sturz"), ("smooth = 1", "true"), ('search = "contour"\nobjective = "strip"', "contour"),
                          ('paths = "rings"', "iso-u, iso-v, plane"), ("feed = 0.0", "feed"), ("scallop = -1", "scallop"), ("sturz_tilt = 200.0", "sturz_tilt"), ("tilts = [1.0, 2.0]", "did you mean tilt"),
                          ("spindle = -5.0", "spindle"), ("safety = 0.0", "safety")):
            self.refused(job(operation=bad, machine=self.machine), where, word)
        for bad, word in (("side_step = 0.0", "side_step"), ("side_step = 1.0\npath_count = 3", "beside"), ("path_count = 0", "path_count"), ("path_count = 2.5", "whole"),
                          ("plane_normal = [1.0, 0.0, 0.0]", "plane"), ('paths = "plane"\nplane_normal = [0.0, 0.0, 0.0]', "direction"), ('paths = "plane"\nplane_normal = [1.0]', "three"),
                          ("max_step = -1.0", "max_step"), ("edge = -1.0", "edge")):
            self.refused(job(PROPELLER, operation=bad, machine=self.machine), where, word)
        self.refused(job(operation="side_step = 2.0", machine=self.machine), where, "contacts")

    def test_machine(self):
        self.assertIn("did you mean xyzac-trunnion", self.refused(job(machine='name = "xyzac-trunion"'), r"job\.toml:\d+:\d+"))
        self.assertIn("xyz", Run(job(machine='name = "xyz"'), files=PLANE, expect=(3,)).stderr)  # cannot tilt: nothing is reachable
        self.refused(job(machine='name = "mine.toml"'), r"mine\.toml", accepted=False)
        self.refused(job(machine='name = "mine.toml"'), r"mine\.toml", files={**PLANE, "mine.toml": "garbage ["}, accepted=False)
        self.refused(job(machine="nam = 1"), "did you mean name")
        self.refused(job(), "none", "--cl", code=(2,), outputs=("-o", "o.ngc"))
        self.refused(job() + "[tol]\nx = 1\n", r"job\.toml:\d+:\d+", "did you mean tool")
        self.refused("[part\n", r"job\.toml:1", accepted=False)
        self.refused("", r"job\.toml", "part", accepted=False)

    def test_contacts(self):
        head = "path,x,y,z,nx,ny,nz,fx,fy,fz\n"
        for text, word in ((head + "0,0,0,0,0,0,0,1,0,0\n", "normal"), (head + "0,0,0,0,0,0,1,0,0,0\n", "feed"), (head + "0,0,0,0,0,0,1,0,0,1\n", "feed"),
                           (head + "0,0,0,0,0,0,1,1,0\n", "column|field|number"), (head + "0,0,0,a,0,0,1,1,0,0\n", "number"), (head + "0,0,0,nan,0,0,1,1,0,0\n", "number|finite"),
                           (head + "0,1e300,0,0,0,0,1,1,0,0\n", r"1e\+06"), (head, "point|line|empty"), ("", "contacts"), ("x,y,z\n1,2,3\n", "path,x,y,z"), (head + "-1,0,0,0,0,0,1,1,0,0\n", "path"),
                           (head + "1,0,0,0,0,0,1,1,0,0\n0,0,0,0,0,0,1,1,0,0\n", "path")):
            self.refused(job(machine=self.machine), r"contacts\.csv", word, files={**PLANE, "contacts.csv": text}, accepted=False)

    def test_files(self):
        self.refused(job(machine=self.machine), r"part\.stl", files={"contacts.csv": plane_contacts()}, accepted=False)
        self.refused(job(machine=self.machine), r"contacts\.csv", files={"part.stl": stl(plane())}, accepted=False)
        self.refused(job('surface = "none.step"', machine=self.machine), r"none\.step", accepted=False)
        whole = stl(plane())
        for bad in (b"", b"solid x\nfacet\n", whole[:200], whole[:80] + struct.pack("<I", 2**31) + whole[84:], whole[:84] + struct.pack("<f", math.nan) * 12 + whole[132:]):
            self.refused(job(machine=self.machine), r"part\.stl", files={**PLANE, "part.stl": bad}, accepted=False)
        for bad in (b"", b"garbage", b"ISO-10303-21;\nDATA;\n"):
            self.refused(job('surface = "a.step"', machine=self.machine), r"a\.step", files={"a.step": bad}, accepted=False)
        part = 'mesh = "part.stl"\ncontacts = "contacts.csv"\nobstacles = ["gone.stl"]'
        self.refused(job(part, machine=self.machine), r"gone\.stl", accepted=False)
        run = subprocess.run([BURIN, "orient", "nowhere.toml"], capture_output=True, text=True)
        self.assertEqual(run.returncode, 1)
        self.assertIn("nowhere.toml", run.stderr)

    def test_usage(self):
        for options in ((), ("a.toml", "--unknown"), ("a.toml", "--tolerance", "-1"), ("a.toml", "--tcp", "--joints"), ("a.toml", "--threads", "0")):
            run = subprocess.run([BURIN, "orient", *options], capture_output=True, text=True)
            self.assertEqual(run.returncode, 2, run.stderr)
        self.refused(job(), "job.toml", code=(2,), outputs=("--cl", "job.toml"))
        self.refused(job(), code=(2,), outputs=("--cl", "a", "--points", "a"))


if __name__ == "__main__":
    BURIN = os.path.abspath(sys.argv.pop(1))
    unittest.main()
