#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`burin view` from outside: pages of the outputs of all operations, decoded by code written from docs/viewer.md; bad input; the
server: who is answered, what, and how it ends.
usage: view_cli_test.py PATH/TO/burin"""
import base64
import http.client
import json
import os
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import numpy as np

BURIN = ""
EXAMPLES = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "examples")
SQUARE = """$$ a square, one millimetre deep
PARTNO SQUARE
CUTTER/6,3
LOADTL/2
SPINDL/RPM,5000,CLW
FROM/0,0,50
RAPID
GOTO/0,0,5
FEDRAT/600,MMPM
PPRINT down
GOTO/0,0,-1
PPRINT around
GOTO/30,0,-1
GOTO/30,30,-1
CIRCLE/15,30,-1,0,0,1,15
GOTO/0,30,-1
GOTO/0,0,-1
RAPID
GOTO/0,0,50
FINI
"""


class SceneFile:
    def __init__(self, data):
        assert data[:8] == b"BURINSC1", data[:8]
        size = struct.unpack("<I", data[8:12])[0]
        self.directory = json.loads(data[12:12 + size])
        self.body = data[12 + size:]
        self.chunks = {c["name"]: c for c in self.directory["chunks"]}

    def get(self, name):
        c = self.chunks[name]
        raw = zlib.decompress(self.body[c["at"]:c["at"] + c["bytes"]])
        if c["coding"] == "text":
            return raw.decode()
        shape = (c["count"], c["components"])
        if c["coding"] == "plain":
            return np.frombuffer(raw, {"u8": "u1", "u16": "<u2"}[c["type"]]).reshape(shape)
        planes = np.frombuffer(raw, "u1").reshape(4, -1).astype(np.uint64)
        zigzag = planes[0] | planes[1] << 8 | planes[2] << 16 | planes[3] << 24
        step = np.where(zigzag & 1, 2 ** 32 - (zigzag + 1) // 2, zigzag // 2)
        value = (np.cumsum(step.reshape(shape), axis=0) % 2 ** 32).astype(np.uint32).astype(np.int32)
        number = np.array(c["offset"]) + c["scale"] * value
        return np.where(value == 0x7FFFFFFF, np.nan, number) if c.get("none") else number


def scene_of(page):
    return SceneFile(base64.b64decode(re.search(rb'<script id="burin-scene"[^>]*>([^<]*)</script>', page).group(1)))


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, **files):
        for name, content in files.items():
            with open(os.path.join(self.folder, name.replace("__", ".")), "wb") as f:
                f.write(content if isinstance(content, bytes) else content.encode())

    def run_burin(self, *args, expect=0):
        done = subprocess.run([BURIN, *args], cwd=self.folder, capture_output=True, timeout=120)
        self.assertEqual(done.returncode, expect, done.stderr.decode(errors="replace"))
        return done

    def page(self, name):
        with open(os.path.join(self.folder, name), "rb") as f:
            return scene_of(f.read())

    def view(self, *args):
        self.run_burin("view", *args, "-o", "v.html")
        return self.page("v.html")


class Pages(Case):
    def test_cl_data(self):
        self.write(a__cl=SQUARE)
        s = self.view("a.cl")
        d = s.directory
        self.assertEqual(d["title"], "a.cl")
        self.assertEqual(d["groups"], ["tool 2", "down", "around"])
        self.assertEqual([t["name"] for t in d["tools"]], ["ball 6 mm"])
        self.assertEqual(s.get("program.text"), SQUARE)
        point, time, kind = s.get("path.point"), s.get("path.time")[:, 0], s.get("path.kind")[:, 0]
        self.assertTrue((np.diff(time) >= 0).all())
        np.testing.assert_allclose(point[0], (0, 0, 50), atol=1e-4)
        lines = SQUARE.splitlines()
        for line in s.get("path.line")[1:, 0]:
            self.assertTrue(lines[int(line) - 1].startswith("GOTO"))
        # 6 + 30 + 30 + 15 pi + 30 mm at 600 mm/min, however the arc was cut in pieces.
        feed = time[kind == 1]
        self.assertAlmostEqual(feed[-1] - time[1], (96 + 15 * np.pi) / 10, places=3)
        arc = point[s.get("path.move")[:, 0] == 4]
        np.testing.assert_allclose(np.hypot(arc[:, 0] - 15, arc[:, 1] - 30), 15, atol=2e-4)
        self.assertGreater(len(arc), 30)

    def test_the_page_is_one_file(self):
        self.write(a__cl=SQUARE)
        self.run_burin("view", "a.cl", "-o", "v.html")
        with open(os.path.join(self.folder, "v.html"), "rb") as f:
            page = f.read()
        self.assertTrue(page.lstrip().lower().startswith(b"<!doctype html"))
        self.assertNotIn(b"@SCENE@", page)
        self.assertNotIn(b"@TITLE@", page)
        self.assertIn(b"<title>a.cl</title>", page)
        self.assertEqual(re.findall(rb'(?:src|href)=["\']?(?:https?:|//)', page), [])
        self.run_burin("view", "a.cl", "-o", "again.html")
        with open(os.path.join(self.folder, "again.html"), "rb") as f:
            again = scene_of(f.read())
        self.assertEqual(again.body, scene_of(page).body)

    def test_laser(self):
        drawing = os.path.join(EXAMPLES, "bracket", "bracket.dxf")
        self.run_burin("laser", drawing, "--kerf", "0.3", "-o", "b.ngc", "--cl", "b.cl", "--json", "b.json", expect=3)
        s = self.view(drawing, "b.ngc", "b.json", "--kerf", "0.3")
        d = s.directory
        self.assertEqual(d["operation"], "laser")
        self.assertEqual(d["tools"][0]["kerf"], 0.3)
        self.assertGreater(len(d["outlines"]), 5)
        self.assertTrue(any(f["at"] for f in d["findings"]))
        self.assertTrue(any(f["group"] == "quality" for f in d["figures"]))
        cl = self.view("b.cl")
        np.testing.assert_allclose(cl.directory["box"]["hi"], s.directory["box"]["hi"], atol=0.5)
        self.assertEqual(set(np.unique(s.get("path.kind"))), {0, 1})

    def test_cycle(self):
        self.run_burin("cycle", os.path.join(EXAMPLES, "clock", "clock.nc"), "-o", "c.ngc", "--cl", "c.cl")
        part = os.path.join(EXAMPLES, "clock", "clock.nc")
        s = self.view(part, "c.ngc", "--tool-diameter", "6", "--tool-corner", "3")
        self.assertGreater(s.directory["meshes"][0]["triangles"], 100)
        self.assertGreater(s.directory["nodes"], 500)
        self.assertGreater(self.view("c.cl").directory["nodes"], 500)

    def test_rotary(self):
        job = os.path.join(EXAMPLES, "cam", "cam.toml")
        self.run_burin("rotary", job, "-o", "r.ngc", "--cl", "r.cl", "--view", "r.html")
        s = self.view(job, "r.ngc")
        self.assertEqual([a["letter"] for a in s.directory["machine"]["axes"]], ["A"])
        rotary, axis = s.get("path.rotary"), s.get("path.axis") / 32767 * 32767
        turn = np.radians(rotary[:, 0])
        np.testing.assert_allclose(np.abs(axis[:, 2]), np.abs(np.cos(turn)), atol=2e-4)
        self.assertEqual(s.directory["operation"], "rotary")
        self.assertEqual([p["kind"] for p in s.directory["tools"][0]["pieces"]][-1], 2)
        planned = self.page("r.html")
        names = [x["name"] for x in planned.directory["series"]]
        theta = planned.get(f"series.{names.index('axis')}")[:, 0]
        cuts = ~np.isnan(theta)
        ends = cuts & np.append(np.diff(planned.get("path.move")[:, 0]) != 0, True)
        np.testing.assert_allclose(np.sin(np.radians(theta[ends])), planned.get("path.axis")[ends, 1], atol=1e-3)
        lo, hi = (planned.get(f"series.{names.index(n)}")[:, 0] for n in ("reachable from", "reachable to"))
        known = cuts & ~np.isnan(lo)
        self.assertTrue((lo[known] <= theta[known] + 1e-2).all() and (theta[known] <= hi[known] + 1e-2).all())

    def test_orient(self):
        job = os.path.join(EXAMPLES, "saddle", "saddle.toml")
        self.run_burin("orient", job, "--cl", "o.cl", "--view", "o.html")
        s = self.view(job, "o.cl")
        self.assertEqual(s.directory["operation"], "orient")
        self.assertAlmostEqual(np.linalg.norm(s.get("path.axis"), axis=1).min(), 1, places=3)
        self.assertIsNotNone(s.directory["machine"])
        planned = self.page("o.html")
        names = [x["name"] for x in planned.directory["series"]]
        self.assertLessEqual({"effective radius", "tilt", "yaw", "gain"}, set(names))
        tilt, yaw = (planned.get(f"series.{names.index(n)}")[:, 0] for n in ("tilt", "yaw"))
        self.assertGreater(len(planned.directory["cspaces"]), 10)
        for k, c in enumerate(planned.directory["cspaces"]):
            self.assertAlmostEqual(c["chosen"][0], tilt[c["node"]], delta=1e-2)
            self.assertAlmostEqual(c["chosen"][1], yaw[c["node"]], delta=1e-2)
            cause, radius = planned.get(f"cspace.{k}.cause")[:, 0], planned.get(f"cspace.{k}.radius")[:, 0]
            self.assertTrue((np.isnan(radius) | (cause == 0)).all())

    def test_check_and_stock(self):
        block = []
        for (x, y, z), axis in (((0, 0, -8), 2), ((0, 0, -1), 2)):
            block += [[(-5, -5, z), (35, -5, z), (35, 50, z)], [(-5, -5, z), (35, 50, z), (-5, 50, z)]]
        raw = b"part".ljust(80) + struct.pack("<I", 2)
        for t in block[2:]:
            raw += struct.pack("<12fH", 0, 0, 1, *t[0], *t[1], *t[2], 0)
        self.write(p__stl=raw, a__cl=SQUARE.replace("GOTO/30,30,-1", "GOTO/30,30,-1.1"))
        s = self.view("p.stl", "a.cl", "--verify", "--stock", "block", "--resolution", "0.5")
        d = s.directory
        worst = [f for f in d["findings"] if "gouge" in f["title"]][0]
        self.assertEqual(worst["level"], 2)
        self.assertAlmostEqual(float(re.search(r"gouge ([\d.]+)", worst["title"]).group(1)), 0.1, delta=0.005)
        self.assertEqual(d["meshes"][0]["valueName"], "deviation")
        self.assertAlmostEqual(np.nanmin(s.get("mesh.0.value")), -0.1, delta=0.005)
        self.assertIn("deviation", [x["name"] for x in d["series"]])
        self.assertEqual(len(d["histograms"]), 1)
        cut = s.get("stock.cut")
        self.assertEqual(len(cut), np.prod(d["stock"]["count"]))
        self.assertTrue((cut > 0).any())


class Refused(Case):
    def test_bad_input(self):
        self.write(a__cl=SQUARE, b__cl=SQUARE, odd__bin=b"\0\1\2" * 50, broken__json="{", empty__nc="", bad__cl="GOTO/1,2\n")
        for args, code, about in ((["a.cl"], 2, "-o FILE.html"), (["a.cl", "--serve", "-o", "v.html"], 2, "--serve"),
                                  (["a.cl", "b.cl", "-o", "v.html"], 2, "two tool paths"), (["odd.bin", "-o", "v.html"], 1, "no known kind"),
                                  (["none.cl", "-o", "v.html"], 1, "none.cl"), (["broken.json", "-o", "v.html"], 1, "JSON"),
                                  (["empty.nc", "-o", "v.html"], 1, "empty.nc"), (["bad.cl", "-o", "v.html"], 1, "bad.cl:1"),
                                  (["-o", "v.html"], 2, "FILE"), (["a.cl", "-o", "a.cl"], 2, "overwritten"),
                                  (["a.cl", "--machine", "none-such", "-o", "v.html"], 2, "none-such"),
                                  (["a.cl", "--serve", "--port", "70000"], 2, "65535")):
            done = self.run_burin("view", *args, expect=code)
            self.assertIn(about, done.stderr.decode())
            self.assertFalse(os.path.exists(os.path.join(self.folder, "v.html")), args)

    def test_help(self):
        text = self.run_burin("view", "--help").stdout.decode()
        for word in ("--serve", "--verify", "--stock", "Examples:"):
            self.assertIn(word, text)


class Server(Case):
    def setUp(self):
        super().setUp()
        self.write(a__cl=SQUARE)
        self.process = subprocess.Popen([BURIN, "view", "--serve", "a.cl"], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(self.stop)
        address = self.process.stdout.readline().decode().strip()
        match = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/", address)
        self.assertIsNotNone(match, address)
        self.port = int(match.group(1))

    def stop(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()

    def ask(self, path, method="GET", host=None, headers=(), body=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=10)
        connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
        if host != "":
            connection.putheader("Host", host or f"127.0.0.1:{self.port}")
        for name, value in headers:
            connection.putheader(name, value)
        connection.endheaders(body)
        answer = connection.getresponse()
        content = answer.read()
        connection.close()
        return answer, content

    def raw(self, text):
        with socket.create_connection(("127.0.0.1", self.port), timeout=10) as s:
            s.sendall(text)
            out = b""
            while True:
                try:
                    part = s.recv(65536)
                except ConnectionResetError:
                    break
                if not part:
                    break
                out += part
        return out

    def test_page_and_scene(self):
        answer, page = self.ask("/")
        self.assertEqual(answer.status, 200)
        self.assertIn(b'<script id="burin-scene" type="text/plain"></script>', page)
        self.assertIn("default-src 'none'", answer.getheader("Content-Security-Policy"))
        self.assertEqual(answer.getheader("X-Content-Type-Options"), "nosniff")
        self.assertEqual(answer.getheader("Cache-Control"), "no-store")
        self.assertIsNone(answer.getheader("Access-Control-Allow-Origin"))
        answer, scene = self.ask("/scene.bin")
        self.assertEqual(SceneFile(scene).directory["title"], "a.cl")
        self.assertEqual(int(answer.getheader("Content-Length")), len(scene))
        answer, content = self.ask("/scene.bin", method="HEAD")
        self.assertEqual((answer.status, content, answer.getheader("Content-Length")), (200, b"", str(len(scene))))
        self.assertEqual(self.ask("/health")[1], b"ok\n")
        self.assertEqual(self.ask("/", host=f"localhost:{self.port}")[0].status, 200)

    def test_only_its_own_host(self):
        for host in ("", "evil.example", f"evil.example:{self.port}", "127.0.0.1.evil.example", f"127.0.0.1:{self.port + 1}", "[::1]",
                     "localhost@evil.example", "0.0.0.0"):
            answer, content = self.ask("/scene.bin", host=host)
            self.assertIn(answer.status, (400, 403), host)
            self.assertNotIn(b"BURINSC1", content)
        two = self.raw(f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\nHost: evil\r\n\r\n".encode())
        self.assertIn(b" 403 ", two.split(b"\r\n")[0])

    def test_nothing_but_its_paths(self):
        for path in ("/a.cl", "/../a.cl", "/%2e%2e/a.cl", "/..%2fa.cl", "//etc/passwd", "/etc/passwd", "/scene.bin/", "/Scene.bin",
                     "/health/..", "/%00", "/index.html", "/.", "*"):
            answer, content = self.ask(path)
            self.assertIn(answer.status, (400, 404), path)
            self.assertNotIn(b"PARTNO", content)
            self.assertLess(len(content), 100)

    def test_methods(self):
        for method in ("POST", "PUT", "DELETE", "OPTIONS", "PATCH"):
            self.assertEqual(self.ask("/", method=method)[0].status, 405, method)
        answer = self.raw(f"POST / HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\nContent-Length: 1000000000000\r\n\r\nxx".encode())
        self.assertIn(b" 405 ", answer.split(b"\r\n")[0])

    def test_sizes(self):
        long = self.raw(b"GET /" + b"a" * 100_000 + b" HTTP/1.1\r\nHost: localhost\r\n\r\n")
        self.assertNotIn(b" 200 ", long[:20])
        self.assertEqual(self.ask("/" + "a" * 1000)[0].status, 414)
        headers = self.raw(b"GET / HTTP/1.1\r\nHost: localhost\r\n" + b"X: " + b"b" * 100_000 + b"\r\n\r\n")
        self.assertNotIn(b" 200 ", headers[:20])
        self.raw(b"\r\n\r\n")
        self.raw(b"\x16\x03\x01\x02\x00")
        self.assertEqual(self.ask("/health")[0].status, 200)

    def test_ends_on_signals(self):
        for sign in (signal.SIGTERM, signal.SIGINT):
            self.process.send_signal(sign)
            self.assertEqual(self.process.wait(timeout=10), 0)
            self.assertEqual(self.process.stderr.read(), b"")
            if sign == signal.SIGTERM:
                self.stop()
                Server.setUp(self)

    def test_a_taken_port_is_said(self):
        done = self.run_burin("view", "--serve", "--port", str(self.port), "a.cl", expect=1)
        self.assertIn(f"port {self.port}", done.stderr.decode())

    def test_only_the_loopback(self):
        others = [i[4][0] for i in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)]
        for address in others:
            if address.startswith("127."):
                continue
            with self.assertRaises(OSError):
                socket.create_connection((address, self.port), timeout=2).close()


if __name__ == "__main__":
    BURIN = os.path.abspath(sys.argv.pop(1))
    unittest.main()
