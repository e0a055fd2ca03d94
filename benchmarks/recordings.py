"""Marker files of ten minutes and of an hour: read, fitted and cleaned in a fresh process.

`python -m benchmarks.recordings` writes results/bench/recordings.md. Eight markers at 100 Hz on a
simulated robot, 0.3 mm of noise on each coordinate, every seventh row without its first marker, as
a Vicon CSV in millimetres. Wall-clock and CPU seconds from the start of Python to the clean
recording, three times, the median; the peak of the memory.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.results import machine, write, yardstick
from rr_opt.files.problem_file import read_problem
from rr_opt.model.gait import SineGait
from rr_opt.motion.rollout import rollout

PLACES = {
    "L1": (1, 0.05, 0.03),
    "R1": (1, 0.05, -0.035),
    "L2": (1, 0.20, 0.06),
    "R2": (1, 0.21, -0.05),
    "T1": (2, -0.02, 0.03),
    "T2": (2, -0.03, -0.04),
    "T3": (2, -0.08, 0.045),
    "T4": (2, -0.07, -0.03),
}
WORK = f"""
import sys, time
began = time.perf_counter()
from rr_opt.model.experiment import Layout
from rr_opt.recordings.markers.pose import fit_markers
from rr_opt.recordings.readers import read_file
places = {PLACES!r}
layout = Layout(*({{n: p[1:] for n, p in places.items() if p[0] == i}} for i in (1, 2)))
recording = fit_markers(read_file(sys.argv[1]), layout).recording
wall = time.perf_counter() - began
import resource
kilo = 1 if sys.platform == "darwin" else 1024
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * kilo
print(len(recording), wall, time.process_time(), peak)
"""


def main() -> None:
    lines = [
        "# Marker files: read, fitted and cleaned",
        "",
        f"Written by `python -m benchmarks.recordings`. {machine()}. "
        "Fresh processes, imports included; median of three.",
        "",
        "| file | wall, s | CPU, s | peak memory, MiB |",
        "|---|---|---|---|",
    ]
    yard, ratios = yardstick(), {}
    with tempfile.TemporaryDirectory() as folder:
        for name, minutes in (("10 minutes", 10), ("1 hour", 60)):
            path = Path(folder) / f"{minutes}.csv"
            vicon(path, minutes)
            walls, cpus, peaks = zip(*(measured(path) for _ in range(3)), strict=True)
            lines.append(
                f"| {name}, {path.stat().st_size / 2**20:.0f} MiB | {statistics.median(walls):.2f} "
                f"| {statistics.median(cpus):.2f} | {max(peaks) / 2**20:.0f} |"
            )
            ratios[f"{name}, yardstick/CPU"] = yard / statistics.median(cpus)
            print(lines[-1], flush=True)
    write("recordings", lines, ratios)


def vicon(path: Path, minutes: int) -> None:
    """A minute of motion, again and again, as Nexus would write it."""
    moved = rollout(read_problem(None).robot, SineGait(0.7, 1.0, 0.1), 60.0, "steady", 100.0)
    rng = np.random.default_rng(0)
    joint = moved.x + 1j * moved.y
    columns = []
    for number, forward, left in PLACES.values():
        heading = moved.psi + (number - 1) * moved.phi
        place = joint + (forward + 1j * left) * np.exp(1j * heading)
        columns += [place.real, place.imag, np.full(len(joint), 0.08)]
    table = 1000 * (np.stack(columns, 1) + rng.normal(0, 3e-4, (len(joint), len(columns))))
    # There and back, so that nothing jumps where the minute ends.
    there = [",".join(f"{value:.4f}" for value in row) for row in table]
    there[::7] = [",,," + row.split(",", 3)[3] for row in there[::7]]
    both = there + there[::-1]
    with path.open("w", newline="") as file:
        names = ",,,".join(f"RR:{name}" for name in PLACES)
        file.write(f"Trajectories\r\n100\r\n,,{names},,\r\n")
        file.write(f"Frame,Sub Frame{',X,Y,Z' * 8}\r\n,{',mm,mm,mm' * 8}\r\n")
        file.writelines(
            f"{n},0,{both[(n - 1) % len(both)]}\r\n" for n in range(1, 6000 * minutes + 1)
        )


def measured(path: Path) -> tuple[float, float, float]:
    """Wall and CPU seconds, and bytes at the peak."""
    run = subprocess.run(
        [sys.executable, "-c", WORK, str(path)], capture_output=True, text=True, check=True
    )
    _, wall, cpu, peak = map(float, run.stdout.split())
    return wall, cpu, peak


if __name__ == "__main__":
    main()
