"""Hold the optimiser against the best known turns: `python -m benchmarks.turn`.

It writes results/bench/turn.md. The CPU seconds hold the programs that are built on the way.
"""

from __future__ import annotations

import json
import platform
import time
from pathlib import Path

from benchmarks.turn.brute_force import STORE
from benchmarks.turn.problems import PROBLEMS
from rr_opt.design.maximize_speed import maximize_speed

RESULT = Path(__file__).parents[2] / "results" / "bench" / "turn.md"


def main() -> None:
    known = json.loads(STORE.read_text())
    lines = [
        "# Turns: against the best known",
        "",
        f"{platform.machine()}, {platform.system()}, Python {platform.python_version()}; one run. "
        "`gap`: speed against the best known, relative (negative: slower).",
        "",
        "| turn | speed, m/s | best known, m/s | gap | CPU, s |",
        "|---|---|---|---|---|",
    ]
    for name, problem in PROBLEMS.items():
        begin = time.process_time()
        best = maximize_speed(problem).best
        seconds = time.process_time() - begin
        speed, other = (best.speed if best else 0.0), known[name]["speed"]
        gap = abs(speed) / abs(other) - 1
        lines.append(f"| {name} | {speed:+.6f} | {other:+.6f} | {gap:+.1e} | {seconds:.2f} |")
        print(lines[-1])
    RESULT.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
