# SPDX-License-Identifier: Apache-2.0
"""Setpoints written by the test program open in numpy, and say the same as the CSV. usage: servo_npy_test.py PROGRAM"""
import csv
import os
import subprocess
import sys
import tempfile

SKIPPED = 77

try:
    import numpy
except ImportError:
    print("numpy is not installed (python3-numpy)")
    sys.exit(SKIPPED)

COLUMNS = "t_s,x_mm,y_mm,z_mm,feed_mm_min,surface,path,u,v".split(",")


def main():
    with tempfile.TemporaryDirectory() as folder:
        name = os.path.join(folder, "setpoints")
        subprocess.run([sys.argv[1], "--gtest_filter=SetpointText.FilesForNumpy"], check=True,
                       env=dict(os.environ, BURIN_SETPOINTS=name), stdout=subprocess.DEVNULL)
        array = numpy.load(name + ".npy", allow_pickle=False)
        with open(name + ".csv", newline="") as file:
            rows = list(csv.reader(file))
    assert rows[0] == COLUMNS, rows[0]
    table = numpy.array([[float(x) if x else numpy.nan for x in row] for row in rows[1:]])
    assert array.dtype == numpy.float64 and array.shape == table.shape and len(array) > 10, (array.dtype, array.shape)
    assert numpy.allclose(array, table, rtol=0, atol=1e-12, equal_nan=True)
    assert numpy.allclose(numpy.diff(array[:, 0]), 0.001, rtol=0, atol=1e-12)
    jerk = numpy.abs(numpy.diff(array[:, 1:4], n=3, axis=0)).max() / 0.001**3
    assert jerk <= 50000 * (1 + 1e-9), jerk
    print(f"{len(array)} setpoints, largest jerk {jerk:.0f} mm/s3")


main()
