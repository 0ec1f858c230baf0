#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: readme_test.py BURIN SOURCE_DIR: runs every burin command of README.md and of the demo script as written (the program's
path replaced) in an empty folder and compares what the README says of the result."""
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile

burin, source = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
PROGRAM = "build/release/apps/burin/burin"
work = tempfile.mkdtemp(prefix="burin-readme-")
os.symlink(os.path.join(source, "examples"), os.path.join(work, "examples"))
env = dict(os.environ, XDG_DATA_HOME=os.path.join(work, "data"))

with open(os.path.join(source, "README.md"), encoding="utf-8") as f:
    readme = f.read()
commands = [line.strip() for line in readme.splitlines() if line.startswith("    " + PROGRAM)]
assert len(commands) >= 5, commands
for command in commands:
    words = shlex.split(command)
    assert words[0] == PROGRAM, command
    run = subprocess.run([burin, *words[1:]], cwd=work, env=env, capture_output=True, text=True, timeout=600)
    print(f"exit {run.returncode}: {command}")
    # Places that no axis reaches are said.
    unreached = any(name in command for name in ("keyway.toml", "orient examples/walls", "orient examples/propeller"))
    assert run.returncode == (3 if unreached else 0), run.stderr

# What the programs do, by code that shares nothing with the planners: the small ones of each mill operation (laser: verify_laser_cli_test).
subprocess.run([burin, "orient", "examples/walls/walls.toml", "--cl", "walls.cl", "--quiet"], cwd=work, env=env)
for design, path, code, gouge, excess in (("cam/cam.toml", "cam.ngc", 0, 0.0055, 0.02), ("keys/keys.nc", "keys.ngc", 0, 0.011, 0.025),
                                          ("walls/walls.toml", "walls.cl", 3, 0.024, 5.1)):
    run = subprocess.run([burin, "verify", "examples/" + design, "--path", path, "--samples", "5000", "--max-gouge", str(gouge), "--max-excess",
                          str(excess), "--json", "check.json"], cwd=work, env=env, capture_output=True, text=True, timeout=600)
    print(f"exit {run.returncode}: verify {design}\n{run.stdout}")
    assert run.returncode == code, run.stderr
    with open(os.path.join(work, "check.json")) as f:
        quality = json.load(f)["quality"]
    assert quality["collisions"] == [] and (quality["unmachined_area_mm2"] > 0) == (code == 3), quality

# The listing of k.ngc.
listing = readme.split("`k.ngc` starts with\n\n")[1].split("\n\n")[0]
wanted = [line[4:] for line in listing.splitlines()]
with open(os.path.join(work, "k.ngc")) as f:
    got = f.read().splitlines()[: len(wanted)]
assert got == wanted, (got, wanted)

# The table of arcs.
for tolerance, minimal, bisect in [row.split("|")[1:4] for row in readme.splitlines() if row.startswith("| 0.") and "**" in row]:
    for method, figure in (("minimal", minimal), ("bisect", bisect)):
        subprocess.run([burin, "laser", "examples/k/k.dxf", "--offset", "0.28", "--lead", "none", "--fit", method, "--tolerance",
                        tolerance.split()[0], "-o", "t.ngc", "--json", "t.json", "--quiet"], cwd=work, env=env, check=True)
        with open(os.path.join(work, "t.json")) as f:
            segments = json.load(f)["counts"]["fitted_segments"]
        assert segments == int(figure.strip(" *")), (tolerance, method, segments, figure)
# What it says of the surface programs.
subprocess.run([burin, "cycle", "examples/clock/clock.nc", "--json", "c.json", "-o", "c.ngc", "--quiet"], cwd=work, env=env, check=True)
with open(os.path.join(work, "c.json")) as f:
    report = json.load(f)
said = re.search(r"`G106\.2 I2 E1`: (\d+) bytes that become one surface, (\d+) paths and\s+([\d,]+) setpoints; the same motion in G01 blocks "
                 r"within 0\.01 mm takes ([\d,]+) bytes", readme)
assert said, "the sentence about clock.nc"
figures = [int(x.replace(",", "")) for x in said.groups()]
size, counts = report["program_size"], report["counts"]
assert counts["surfaces_out"] == 1
assert figures == [size["surface_program_bytes"], counts["paths"], counts["setpoints"], size["g01_program_bytes"]], (figures, size, counts)
said = re.search(r"with `G106\.1`: (\d+) bytes\s+instead of (\d+) for six copies", readme)
sizes = [os.path.getsize(os.path.join(source, "examples", "keys", name)) for name in ("keys.nc", "keys_copied.nc")]
assert said and [int(x) for x in said.groups()] == sizes, sizes
# The job file it shows is accepted (on another section).
block = readme.split("```toml\n")[1].split("```")[0]
with open(os.path.join(work, "shown.toml"), "w") as f:
    f.write(block.replace('"section.dxf"', '"examples/cam/section.dxf"').replace("length = 50.0 ", "length = 2.0 ").replace("twist = 180.0", "twist = 5.0"))
assert subprocess.run([burin, "rotary", "shown.toml", "-o", "shown.ngc", "--quiet"], cwd=work, env=env).returncode in (0, 3)
print("README: commands, listing and figures agree")
