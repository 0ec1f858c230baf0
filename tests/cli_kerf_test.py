#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the program from outside: exit codes, messages, output files and JSON of `burin kerf` and of the command line.
usage: cli_kerf_test.py PATH/TO/burin"""
import json
import os
import pty
import resource
import signal
import sqlite3
import subprocess
import sys
import tempfile
import unittest

BURIN = ""
HEADER = ("laser,material,thickness_mm,power_w,speed_mm_min,gas_mpa,kerf_top_mm,kerf_bottom_mm,"
          "dross_area_mm2,straightness_mm\n")
PREDICT = ["kerf", "predict", "--thickness", "2.0", "--power", "1800", "--speed", "4000"]


def runs(extra=""):
    rows = HEADER
    for power in (1000, 1200, 1400):
        for speed in (3000, 4000, 5000):
            kerf = 0.006 * power / speed + 0.5
            rows += f"lab,steel,1.2,{power},{speed},0.1,{kerf + 0.05:.5f},{kerf - 0.05:.5f},0.2,0.005\n"
    return rows + extra


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.env = {k: v for k, v in os.environ.items() if k not in ("NO_COLOR", "HOME", "XDG_DATA_HOME")}
        self.env["XDG_DATA_HOME"] = self.path("data")

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, name, text):
        with open(self.path(name), "w", newline="") as f:
            f.write(text)
        return name

    def burin(self, *args, expect=0, **more):
        done = subprocess.run([BURIN, *args], capture_output=True, text=True, timeout=60, cwd=self.folder.name,
                              env=self.env, **more)
        self.assertEqual(done.returncode, expect, f"burin {' '.join(args)}\n{done.stdout}{done.stderr}")
        return done

    def load(self, name):
        with open(self.path(name)) as f:
            return json.load(f)

    def names(self):
        return sorted(os.listdir(self.folder.name))


class Usage(Case):
    def check(self, args, *messages):
        done = self.burin(*args, expect=2)
        self.assertEqual(done.stdout, "")
        for message in messages:
            self.assertIn(message, done.stderr)
        self.assertEqual(self.names(), [])

    def test_wrong_usage_says_what_would_be_right(self):
        self.check([], "a command is missing")
        self.check(["krf"], 'unknown command "krf"', "did you mean kerf?")
        self.check(["kerf"], "a command is missing", "predict", "learn")
        self.check(["kerf", "predct"], "did you mean predict?")
        self.check(["kerf", "predict", "--thicknes", "2"], "unknown option --thicknes (did you mean --thickness?)")
        self.check([*PREDICT, "--qqqqqqqq"], "unknown option --qqqqqqqq", "--help")
        self.check([*PREDICT, "--speed", "5"], "--speed is given twice")
        self.check([*PREDICT[:-1]], "--speed wants a value")
        self.check([*PREDICT[:-2], "--speed="], "--speed wants a value")
        self.check([*PREDICT[:-2]], "--speed is missing")
        self.check([*PREDICT, "--force=1"], "--force takes no value")
        self.check([*PREDICT, "surplus"], "surplus")

    def test_impossible_values(self):
        for value in ("1,5", "nan", "inf", "abc", "0", "-3", "1e400", "", "0x10", "2 3"):
            self.check(["kerf", "predict", "--thickness", value, "--power", "1", "--speed", "1"], "--thickness", "mm above 0")
            self.check(["kerf", "predict", "--thickness", "2", "--power", value, "--speed", "1"], "--power", "W above 0")
        for value in ("0", "1.5", "-1", "x", "99999999999999999999"):
            self.check([*PREDICT, "--version", value], "--version", "whole number")
        self.check([*PREDICT, "--laser", ""], "--laser", "empty")

    def test_outputs_must_differ(self):
        self.check(["kerf", "export", "--csv", "a.txt", "--json", "./a.txt"], "two outputs")
        self.check(["kerf", "export", "--json", "-"], "standard output")
        self.write("runs.csv", runs())
        done = self.burin("kerf", "learn", "runs.csv", "--db", "my.db", "--json", "runs.csv", expect=2)
        self.assertIn("overwritten", done.stderr)
        done = self.burin("kerf", "learn", "runs.csv", "--db", "my.db", "--json", "my.db", expect=2)
        self.assertIn("overwritten", done.stderr)
        self.assertEqual(self.names(), ["runs.csv"])
        with open(self.path("runs.csv")) as f:
            self.assertEqual(f.read(), runs())

    def test_help_and_version(self):
        for args in (["--help"], ["kerf", "--help"], *(["kerf", c, "-h"] for c in ("list", "predict", "suggest", "learn", "export"))):
            done = self.burin(*args)
            self.assertIn("Usage: burin", done.stdout)
            self.assertEqual(done.stderr, "")
        for command in ("list", "predict", "suggest", "learn", "export"):
            self.assertIn("Examples:\n  burin kerf " + command, self.burin("kerf", command, "--help").stdout)
        self.assertRegex(self.burin("--version").stdout, r"^burin \d+\.\d+\.\d+\n$")


class Predict(Case):
    def test_figures(self):
        done = self.burin(*PREDICT, "--json", "k.json")
        self.assertIn("0.5627 mm", done.stdout)
        self.assertEqual(done.stderr, "")
        j = self.load("k.json")
        self.assertEqual(j["kerf_mm"], 0.0061 * 1800 / 4000 + 0.56)
        self.assertEqual(j["offset_mm"], j["kerf_mm"] / 2)
        self.assertIs(j["permissible"], True)
        self.assertIsNone(j["prediction_interval_mm"])
        for key, value in {"laser": "ndyag-cw", "material": "CSP1N", "thickness_mm": 2.0, "lambda1": 0.0061,
                           "lambda2": 0.56, "r": 0.9, "version": 1}.items():
            self.assertEqual(j["model"][key], value)
        self.assertIn("Park & Ahn 2007", j["model"]["source"])
        for key in ("operation", "version", "input", "inputs_sha256", "parameters", "counts", "lengths_mm", "time_s",
                    "quality", "warnings", "outputs"):
            self.assertIn(key, j)
        self.assertEqual(j["outputs"], ["k.json"])
        self.assertEqual(j["warnings"], [])

    def test_json_on_standard_output_is_alone_there(self):
        self.assertEqual(json.loads(self.burin(*PREDICT, "--json", "-").stdout)["kerf_mm"], 0.562745)

    def test_outside_is_refused_and_leaves_no_file(self):
        done = self.burin(*PREDICT[:-1], "9000", "--json", "k.json", expect=1)
        self.assertIn("nearest permissible setting: 1800 W at 5000 mm/min", done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertEqual(self.names(), [])

    def test_force_is_recorded(self):
        done = self.burin(*PREDICT[:-1], "9000", "--force", "--json", "k.json")
        self.assertIn("kerf_forced", done.stderr)
        j = self.load("k.json")
        self.assertIs(j["permissible"], False)
        self.assertIs(j["forced"], True)
        self.assertIs(j["parameters"]["force"], True)
        self.assertEqual([w["code"] for w in j["warnings"]], ["kerf_forced"])
        self.assertEqual(self.burin(*PREDICT[:-1], "9000", "--force", "--quiet").stderr, "")

    def test_interpolation_between_thicknesses_is_flagged(self):
        setting = ["kerf", "predict", "--thickness", "1.8", "--power", "1800", "--speed", "4000"]
        self.assertIn("--interpolate", self.burin(*setting, expect=1).stderr)
        self.burin(*setting, "--interpolate", "--json", "k.json")
        j = self.load("k.json")
        self.assertIs(j["interpolated"], True)
        self.assertAlmostEqual(j["kerf_mm"], 0.0057 * 0.45 + 0.553, 12)
        self.assertEqual([w["code"] for w in j["warnings"]], ["kerf_interpolated"])

    def test_same_json_twice(self):
        def once():
            self.burin(*PREDICT, "--json", "k.json")
            j = self.load("k.json")
            del j["time_s"]
            return json.dumps(j)
        self.assertEqual(once(), once())

    def test_suggest_list_export(self):
        self.burin("kerf", "suggest", "--thickness", "1.0", "--json", "s.json")
        speeds = [s["speed_max_mm_min"] for s in self.load("s.json")["suggestions"]]
        self.assertEqual(speeds, [7000, 7000, 7000, 6000])
        self.burin("kerf", "list", "--json", "l.json")
        self.assertEqual([m["thickness_mm"] for m in self.load("l.json")["models"]], [0.5, 1.0, 1.6, 2.0])
        self.burin("kerf", "export", "--csv", "e.csv")
        with open(self.path("e.csv")) as f:
            self.assertEqual(f.read(), self.burin("kerf", "export").stdout)


class Learn(Case):
    def test_learn_then_predict(self):
        self.write("runs.csv", runs("lab,steel,1.2,1400,6000,0.1,0.9,0.8,0.7,0.005\n"))
        self.burin("kerf", "learn", "runs.csv", "--db", "sub/my.db", "--json", "fit.json")
        j = self.load("fit.json")
        self.assertEqual(j["input"], "runs.csv")
        self.assertEqual(len(j["inputs_sha256"]["runs.csv"]), 64)
        (m,) = j["models"]
        self.assertAlmostEqual(m["lambda1"], 0.006, 4)
        self.assertAlmostEqual(m["lambda2"], 0.5, 5)
        self.assertEqual((m["runs_accepted"], m["runs_rejected"]), (9, 1))
        self.assertEqual(set(m["standard_errors"]), {"lambda1", "lambda2"})
        self.assertEqual(m["source"], "runs.csv")
        self.assertEqual(j["rejected"][0]["line"], 11)
        self.assertIn("dross", j["rejected"][0]["reason"])
        setting = ["kerf", "predict", "--laser", "lab", "--material", "steel", "--thickness", "1.2", "--power", "1200",
                   "--speed", "4000", "--db", "sub/my.db"]
        self.burin(*setting, "--json", "k.json")
        k = self.load("k.json")
        self.assertAlmostEqual(k["kerf_mm"], 0.5018, 5)
        low, high = k["prediction_interval_mm"]
        self.assertTrue(low <= k["kerf_mm"] <= high)
        self.burin("kerf", "learn", "runs.csv", "--db", "sub/my.db", "--json", "fit.json")
        self.assertEqual(self.load("fit.json")["models"][0]["version"], 2)
        self.burin(*setting, "--version", "1")
        self.burin(*setting, "--version", "3", expect=1)

    def test_without_db_the_users_database_serves(self):
        self.write("runs.csv", runs())
        self.burin("kerf", "learn", "runs.csv")
        self.assertTrue(os.path.exists(self.path("data/burin/kerf.db")))
        self.assertIn("lab", self.burin("kerf", "list").stdout)
        del self.env["XDG_DATA_HOME"]
        self.assertNotIn("lab", self.burin("kerf", "list").stdout)
        self.burin("kerf", "learn", "runs.csv", expect=2)

    def test_a_bad_line_is_named_and_nothing_changes(self):
        self.write("runs.csv", runs("lab,steel,1.2,1400,fast,0.1,0.9,0.8,0.7,0.005\n"))
        done = self.burin("kerf", "learn", "runs.csv", "--db", "my.db", "--json", "j.json", expect=1)
        self.assertTrue(done.stderr.startswith("runs.csv:11: "), done.stderr)
        self.assertEqual(self.names(), ["runs.csv"])
        self.write("few.csv", HEADER + runs()[len(HEADER):].split("\n")[0] + "\n")
        self.assertIn("too few", self.burin("kerf", "learn", "few.csv", "--db", "my.db", expect=1).stderr)
        self.assertIn("none.csv", self.burin("kerf", "learn", "none.csv", "--db", "my.db", expect=1).stderr)
        self.assertFalse(os.path.exists(self.path("my.db")))

    def test_many_rejected_runs_are_grouped(self):
        self.write("runs.csv", runs("lab,steel,1.2,1400,6000,0.1,0.9,0.8,0.7,0.005\n" * 42))
        done = self.burin("kerf", "learn", "runs.csv", "--db", "my.db")
        self.assertEqual(done.stderr.count("dross"), 5)
        self.assertIn("... and 37 more [run_rejected] (see --json)", done.stderr)

    def test_damaged_locked_and_foreign_databases(self):
        self.write("runs.csv", runs())
        learn = ["kerf", "learn", "runs.csv", "--db", "my.db"]
        predict = [*PREDICT, "--db", "my.db"]
        self.write("my.db", "not a database at all, but long enough to look at" * 20)
        for command in (predict, learn):
            self.assertIn("my.db: is not a database", self.burin(*command, expect=1).stderr)
        os.remove(self.path("my.db"))
        self.assertIn("my.db: cannot be opened", self.burin(*predict, expect=1).stderr)
        self.burin(*learn)
        lock = sqlite3.connect(self.path("my.db"), isolation_level=None)
        lock.execute("BEGIN EXCLUSIVE")
        for command in (predict, learn):
            self.assertIn("locked", self.burin(*command, expect=1).stderr)
        lock.execute("ROLLBACK")
        lock.execute("PRAGMA user_version = 9")
        lock.close()
        self.assertIn("newer burin", self.burin(*predict, expect=1).stderr)

    def test_no_space_for_the_database(self):
        self.write("runs.csv", runs())
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        done = self.burin("kerf", "learn", "runs.csv", "--db", "my.db", expect=1, preexec_fn=limit)
        self.assertIn("my.db", done.stderr)
        self.assertEqual(self.names(), ["runs.csv"])


class Outputs(Case):
    def test_a_failing_output_takes_the_others_back(self):
        self.burin("kerf", "export", "--csv", "e.csv", "--json", "none/j.json", expect=1)
        self.assertEqual(self.names(), [])
        done = self.burin("kerf", "export", "--csv", "/dev/full", "--json", "j.json", expect=1)
        self.assertIn("/dev/full", done.stderr)
        self.assertEqual(self.names(), [])
        with open("/dev/full", "w") as full:
            done = subprocess.run([BURIN, "kerf", "export", "--json", "j.json"], stdout=full, stderr=subprocess.PIPE,
                                  text=True, cwd=self.folder.name, env=self.env)
        self.assertEqual(done.returncode, 1)
        self.assertIn("standard output cannot be written", done.stderr)
        self.assertEqual(self.names(), [])

    def test_a_reader_that_goes_away(self):
        read, write = os.pipe()
        os.close(read)
        restore = lambda: signal.signal(signal.SIGPIPE, signal.SIG_DFL)
        done = subprocess.run([BURIN, "kerf", "list"], stdout=write, stderr=subprocess.PIPE, text=True, env=self.env,
                              preexec_fn=restore)
        os.close(write)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr.count("\n"), 1)

    def test_little_memory_is_an_error_not_a_crash(self):
        limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (400 << 20, 400 << 20))
        self.write("runs.csv", HEADER + "lab,steel,1.2,1400,6000,0.1,0.9,0.8,0.7,0.005\n" * 4000000)
        done = subprocess.run([BURIN, "kerf", "learn", "runs.csv", "--db", "my.db"], capture_output=True, text=True,
                              cwd=self.folder.name, env=self.env, preexec_fn=limit, timeout=60)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("out of memory", done.stderr)
        self.assertFalse(os.path.exists(self.path("my.db")))

    def test_colours_only_on_a_terminal_without_no_color(self):
        def on_terminal(**env):
            try:
                parent, child = pty.openpty()
            except OSError as error:
                print(f"skipped: no terminal can be opened here ({error})", file=sys.stderr)
                self.skipTest(str(error))
            subprocess.run([BURIN, "kerf", "nothing"], stderr=child, stdout=subprocess.DEVNULL,
                           env={**self.env, "TERM": "xterm", **env})
            os.close(child)
            text = os.read(parent, 10000).decode()
            os.close(parent)
            return text
        self.assertIn("\033[", on_terminal())
        self.assertNotIn("\033[", on_terminal(NO_COLOR="1"))
        self.assertNotIn("\033[", on_terminal(TERM="dumb"))
        self.assertNotIn("\033[", self.burin("kerf", "nothing", expect=2).stderr)


if __name__ == "__main__":
    BURIN = os.path.abspath(sys.argv.pop(1))
    unittest.main()
