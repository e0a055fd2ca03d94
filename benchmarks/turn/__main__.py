"""Hold the optimiser against the best known turns: `python -m benchmarks.turn`."""

from __future__ import annotations

import json
import time

from benchmarks.turn.brute_force import STORE
from benchmarks.turn.problems import PROBLEMS
from rr_opt.design.maximize_speed import maximize_speed


def main() -> None:
    known = json.loads(STORE.read_text())
    print("| turn | speed, m/s | best known, m/s | difference | CPU, s |")
    print("|---|---|---|---|---|")
    for name, problem in PROBLEMS.items():
        begin = time.process_time()
        best = maximize_speed(problem).best
        seconds = time.process_time() - begin
        speed, other = (best.speed if best else 0.0), known[name]["speed"]
        gap = abs(speed) / abs(other) - 1
        print(f"| {name} | {speed:+.6f} | {other:+.6f} | {gap:+.1e} | {seconds:.2f} |")


if __name__ == "__main__":
    main()
