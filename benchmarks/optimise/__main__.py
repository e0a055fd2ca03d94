"""The package and differential evolution on every problem, interleaved, in one process; then what a
user would pick instead, on the problems that these can be told (`peers`).

`python -m benchmarks.optimise [--runs N] [--starts N] [PROBLEM ...]` writes
results/bench/optimise.md and .json. CPU seconds of a whole answer: all starts, ranking and
refinement. `cold` is the package's first call in a new process for that problem, programs built;
`warm` the median of later calls, with what the package compiles once it is used often compiled
before; `no cc` the same where there is no compiler.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

from benchmarks.optimise import differential_evolution
from benchmarks.optimise.peers import tables
from benchmarks.optimise.peers.posed import eligible
from benchmarks.optimise.peers.race import race
from benchmarks.optimise.problems import PROBLEMS
from benchmarks.optimise.profiled import shares
from benchmarks.results import machine, write
from rr_opt.design.maximize_speed import maximize_speed

HERE = Path(__file__).parent
_FIRST = "reference"
"""The problem on which new processes are timed."""
_WARM_UP = {"reference": 60, "loads_centre": 60}
"""Runs after which the package has compiled what it compiles."""
_FOUND = 1e-5
"""By so much less than the best known, relative, a gait counts as found."""
COLD = (
    "import time, sys; from benchmarks.optimise.problems import PROBLEMS;"
    "from rr_opt.design.maximize_speed import maximize_speed; t = time.process_time();"
    "maximize_speed(PROBLEMS[sys.argv[1]]); print(time.process_time() - t)"
)
NO_COMPILER = (
    "import statistics, time, sys; from benchmarks.optimise.__main__ import timed;"
    "from benchmarks.optimise.problems import PROBLEMS as P;"
    "from rr_opt.design.maximize_speed import maximize_speed as call; call(P[sys.argv[1]]);"
    "print(statistics.median(timed(lambda: call(P[sys.argv[1]]))[0] for _ in range(3)))"
)


def timed(call):
    start = time.process_time()
    answer = call()
    return time.process_time() - start, answer


def alone(code: str, name: str, **environment: str) -> float:
    """What a new process prints, a number."""
    command, around = [sys.executable, "-c", code, name], {**os.environ, **environment}
    ended = subprocess.run(command, check=True, capture_output=True, text=True, env=around)
    return float(ended.stdout)


def measure(name: str, runs: int, known: float) -> dict[str, float]:
    """Medians over interleaved runs, and how far each answer is from the best known speed."""
    problem = PROBLEMS[name]
    cold = alone(COLD, name)
    uncompiled = alone(NO_COMPILER, name, CC="no-compiler")
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
        "cold": cold,
        "uncompiled": uncompiled,
        "warm": statistics.median(ours),
        "peer": statistics.median(theirs),
        "ratio": statistics.median(ratios),
        "gap": min(gaps),
        "peer_missed": sum(gap < -1e-4 for gap in peer_gaps),
        "optima": len(optimum.optima),
        "starts": optimum.starts,
    }


def table(rows: dict[str, dict[str, float]], runs: int) -> list[str]:
    """The measurements as Markdown."""
    lines = [
        "# Optimise: CPU seconds to an answer",
        "",
        f"{machine()}; {runs} interleaved runs, medians. "
        "`gap`: speed against the best known, relative (negative: slower). "
        "`DE missed`: runs of differential evolution more than 1e-4 short. `cold` and `warm` "
        "with what was compiled before; `no cc`: warm, without a C compiler.",
        "",
        "| problem | cold | no cc | warm | DE | warm/DE | gap | DE missed | starts | optima |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for name, row in rows.items():
        lines.append(
            f"| {name} | {row['cold']:.2f} | {row['uncompiled']:.3f} | {row['warm']:.3f} | "
            f"{row['peer']:.3f} | "
            f"{row['ratio']:.2f} | {row['gap']:+.0e} | {row['peer_missed']}/{runs} | "
            f"{row['starts']} | {row['optima']} |"
        )
    ratio = statistics.median(row["ratio"] for row in rows.values())
    return [*lines, "", f"Median ratio warm/DE: {ratio:.2f}.", "", *costs(list(rows)), ""]


def costs(names: list[str]) -> list[str]:
    """Where warm time goes."""
    spent = ", ".join(f"{part} {share:.0%}" for part, share in shares(names).items())
    return [f"Where warm time goes (cycles are part of the others): {spent}."]


def main() -> None:
    """Measure and store."""
    parser = argparse.ArgumentParser()
    parser.add_argument("problems", nargs="*", default=list(PROBLEMS))
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--starts", type=int, default=3)
    asked = parser.parse_args()
    known = json.loads((HERE / "best_known.json").read_text())
    for name, count in _WARM_UP.items():
        for _ in range(count):
            maximize_speed(PROBLEMS[name])
    rows = {}
    for name in asked.problems:
        rows[name] = measure(name, asked.runs, known[name]["speed"])
        print(name, {key: round(value, 8) for key, value in rows[name].items()}, flush=True)
    raced = race(asked.starts, _FIRST, [name for name in eligible() if name in asked.problems])
    lines = [*table(rows, asked.runs), *tables.lines(raced, _FIRST)]
    ratios = {
        "best known found": sum(row["gap"] > -_FOUND for row in rows.values()) / len(rows),
        "DE/warm": statistics.median(1 / row["ratio"] for row in rows.values()),
        **tables.ratios(raced),
    }
    write("optimise", lines, ratios)
    print("\n".join(lines))


if __name__ == "__main__":
    main()
