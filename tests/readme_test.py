#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: readme_test.py BURIN SOURCE_DIR: runs every burin command of README.md and of the demo script as written (the program's
path replaced) in an empty folder and compares what the README says of the result."""
import json
import os
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
    run = subprocess.run([burin, *words[1:]], cwd=work, env=env, capture_output=True, text=True, timeout=60)
    print(f"exit {run.returncode}: {command}")
    assert run.returncode == 0, run.stderr

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
print("README: commands, listing and figures agree")
