"""The package and differential evolution on every problem, interleaved, in one process.

`python -m benchmarks.optimise [--runs N] [PROBLEM ...]` writes results/bench/optimise.md.
CPU seconds of a whole answer: all starts, ranking and refinement. `cold` is the package's first
call in a new process for that problem, programs built; `warm` the median of later calls.
"""

from __future__ import annotations

import argparse
import json
import platform
import statistics
import subprocess
import sys
import time
from pathlib import Path

from benchmarks.optimise import differential_evolution
from benchmarks.optimise.problems import PROBLEMS
from rr_opt.design.maximize_speed import maximize_speed

HERE = Path(__file__).parent
RESULT = HERE.parents[1] / "results" / "bench" / "optimise.md"
COLD = (
    "import time, sys; from benchmarks.optimise.problems import PROBLEMS;"
    "from rr_opt.design.maximize_speed import maximize_speed; t = time.process_time();"
    "maximize_speed(PROBLEMS[sys.argv[1]]); print(time.process_time() - t)"
)


def timed(call):
    start = time.process_time()
    answer = call()
    return time.process_time() - start, answer


def measure(name: str, runs: int, known: float) -> dict[str, float]:
    """Medians over interleaved runs, and how far each answer is from the best known speed."""
    problem = PROBLEMS[name]
    cold = subprocess.run(
        [sys.executable, "-c", COLD, name], check=True, capture_output=True, text=True
    )
    maximize_speed(problem)
    ours, theirs, ratios, gaps, peer_gaps = [], [], [], [], []
    for seed in range(runs):
        own, optimum = timed(lambda: maximize_speed(problem))
        peer, answer = timed(lambda seed=seed: differential_evolution.solve(problem, seed=seed))
        ours.append(own)
        theirs.append(peer)
        ratios.append(own / peer)
        gaps.append(abs(optimum.best.speed) / abs(known) - 1)
        peer_gaps.append(abs(answer.gait.speed) / abs(known) - 1)
    return {
        "cold": float(cold.stdout),
        "warm": statistics.median(ours),
        "peer": statistics.median(theirs),
        "ratio": statistics.median(ratios),
        "gap": min(gaps),
        "peer_missed": sum(gap < -1e-4 for gap in peer_gaps),
        "optima": len(optimum.optima),
        "starts": optimum.starts,
    }


def table(rows: dict[str, dict[str, float]], runs: int) -> str:
    """The measurements as Markdown."""
    lines = [
        "# Optimise: CPU seconds to an answer",
        "",
        f"{platform.machine()}, {platform.system()}, Python {platform.python_version()}; "
        f"{runs} interleaved runs, medians. `gap`: speed against the best known, relative "
        "(negative: slower). `DE missed`: runs of differential evolution more than 1e-4 short.",
        "",
        "| problem | cold | warm | DE | warm/DE | gap | DE missed | starts | optima |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for name, row in rows.items():
        lines.append(
            f"| {name} | {row['cold']:.2f} | {row['warm']:.3f} | {row['peer']:.3f} | "
            f"{row['ratio']:.2f} | {row['gap']:+.0e} | {row['peer_missed']}/{runs} | "
            f"{row['starts']} | {row['optima']} |"
        )
    ratio = statistics.median(row["ratio"] for row in rows.values())
    lines += ["", f"Median ratio warm/DE: {ratio:.2f}."]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Measure and store."""
    parser = argparse.ArgumentParser()
    parser.add_argument("problems", nargs="*", default=list(PROBLEMS))
    parser.add_argument("--runs", type=int, default=5)
    asked = parser.parse_args()
    known = json.loads((HERE / "best_known.json").read_text())
    rows = {}
    for name in asked.problems:
        rows[name] = measure(name, asked.runs, known[name]["speed"])
        print(name, {key: round(value, 8) for key, value in rows[name].items()}, flush=True)
    text = table(rows, asked.runs)
    RESULT.parent.mkdir(parents=True, exist_ok=True)
    RESULT.write_text(text)
    print(text)


if __name__ == "__main__":
    main()
