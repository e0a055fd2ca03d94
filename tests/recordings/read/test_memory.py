"""An hour of eight markers at 100 Hz is read in less than 1 GiB of memory.

In a process of its own, whose largest memory is asked for.
"""

from __future__ import annotations

import subprocess
import sys

import numpy as np

MARKERS = 8
READ = """
import resource, sys
from pathlib import Path
from rr_opt.recordings.readers import read_file
data = read_file(sys.argv[1])
status = Path("/proc/self/status")
if status.exists():
    # A child's ru_maxrss starts, on Linux, at its parent's: this one is its own.
    row = next(row for row in status.read_text().splitlines() if row.startswith("VmHWM"))
    most = 1024 * int(row.split()[1])
else:
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print(len(data), most)
"""


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


def measured(path):
    run = subprocess.run(
        [sys.executable, "-c", READ, str(path)], capture_output=True, text=True, check=True
    )
    count, memory = run.stdout.split()
    return int(count), int(memory)


def test_an_hour(tmp_path):
    vicon(tmp_path / "run.csv", 360_000)
    count, memory = measured(tmp_path / "run.csv")
    assert count == 360_000
    assert memory < 2**30
