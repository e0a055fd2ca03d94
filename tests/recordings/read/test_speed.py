"""Ten minutes of eight markers at 100 Hz are read in 2 s, and an hour in less than 1 GiB of memory.

Each is read in a process of its own, whose CPU time and largest memory are asked for.
"""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

MARKERS = 8
READ = """
import resource, sys, time
from rr_opt.recordings.readers import read_file
start = time.process_time()
data = read_file(sys.argv[1])
took = time.process_time() - start
print(len(data), took, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""
KILO = 1 if sys.platform == "darwin" else 1024
"""Bytes in the unit of ru_maxrss."""


def vicon(path, frames):
    """As Nexus would write it, a marker missing now and then."""
    rng = np.random.default_rng(0)
    cells = [f"{value:.6g}" for value in rng.normal(0, 1000, 3 * MARKERS * 500)]
    rows = [",".join(cells[at : at + 3 * MARKERS]) for at in range(0, len(cells), 3 * MARKERS)]
    rows[::7] = [",,," + row.split(",", 3)[3] for row in rows[::7]]
    with path.open("w", newline="") as file:
        names = ",,,".join(f"RR:M{n}" for n in range(MARKERS))
        file.write(f"Trajectories\r\n100\r\n,,{names},,\r\n")
        file.write(f"Frame,Sub Frame{',X,Y,Z' * MARKERS}\r\n,{',mm,mm,mm' * MARKERS}\r\n")
        file.writelines(f"{n},0,{rows[n % 500]}\r\n" for n in range(1, frames + 1))


def plain(path, rows):
    with path.open("w") as file:
        file.write("t,x,y,psi,phi\n")
        file.writelines(
            f"{n / 100:.3f},0.123456,-0.234567,1.345678,0.456789\n" for n in range(rows)
        )


def measured(path):
    run = subprocess.run(
        [sys.executable, "-c", READ, str(path)], capture_output=True, text=True, check=True
    )
    count, took, memory = run.stdout.split()
    return int(count), float(took), float(memory) * KILO


@pytest.mark.parametrize("write", [vicon, plain])
def test_ten_minutes(tmp_path, write):
    write(tmp_path / "run.csv", 60_000)
    count, took, _ = measured(tmp_path / "run.csv")
    assert count == 60_000
    assert took < 2.0


def test_an_hour(tmp_path):
    vicon(tmp_path / "run.csv", 360_000)
    count, _, memory = measured(tmp_path / "run.csv")
    assert count == 360_000
    assert memory < 2**30
