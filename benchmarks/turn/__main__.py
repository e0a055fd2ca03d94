"""Hold the optimiser against the best known turns: `python -m benchmarks.turn`.

It writes results/bench/turn.md. The CPU seconds hold the programs that are built on the way.
"""

from __future__ import annotations

import json
import statistics
import time

from benchmarks.results import machine, write, yardstick
from benchmarks.turn.brute_force import STORE
from benchmarks.turn.problems import PROBLEMS
from rr_opt.design.maximize_speed import maximize_speed

_FOUND = 1e-5
"""By so much less than the best known, relative, a turn counts as found."""


def main() -> None:
    known = json.loads(STORE.read_text())
    lines = [
        "# Turns: against the best known",
        "",
        f"{machine()}; one run. `gap`: speed against the best known, relative (negative: slower).",
        "",
        "| turn | speed, m/s | best known, m/s | gap | CPU, s |",
        "|---|---|---|---|---|",
    ]
    yard, gaps, took = yardstick(), [], []
    for name, problem in PROBLEMS.items():
        begin = time.process_time()
        best = maximize_speed(problem).best
        seconds = time.process_time() - begin
        speed, other = (best.speed if best else 0.0), known[name]["speed"]
        gap = abs(speed) / abs(other) - 1
        gaps.append(gap)
        took.append(seconds)
        lines.append(f"| {name} | {speed:+.6f} | {other:+.6f} | {gap:+.1e} | {seconds:.2f} |")
        print(lines[-1])
    found = sum(gap > -_FOUND for gap in gaps) / len(gaps)
    ratios = {"best known found": found, "yardstick/CPU": yard / statistics.median(took)}
    write("turn", lines, ratios)


if __name__ == "__main__":
    main()
