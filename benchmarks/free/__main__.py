"""`python -m benchmarks.free [--random 10] [--seed TEXT]` writes results/bench/free.md.

Every answer is climbed on from, by sequential linear programs on a hand-written model. The seed is
the hash of the commit unless one is given.
"""

from __future__ import annotations

import argparse
import subprocess
import time
import warnings
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import rr_opt as rr
from benchmarks.free.climb import climb
from benchmarks.free.problems import BEATEN
from benchmarks.optimise.problems import PROBLEMS
from benchmarks.random.problems import draw, problem
from benchmarks.results import machine, write
from rr_opt.files.problem_file import read_problem
from rr_opt.model.gait import FreeGait
from rr_opt.model.problem import Problem

_MOST = 1e-4
"""A climb that gains more, relative, says that the answer is no optimum."""
_FILES = "loads", "robust", "turning"


def posed(count: int, seed: str) -> Iterator[tuple[str, Problem]]:
    """Problems with a free gait: those of the files, of other benchmarks, and random ones that have
    an answer."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        files = {name: rr.load(Path("problems") / name / "problem.yaml") for name in _FILES}
    known = {"prototype": read_problem(), **files, **BEATEN, **PROBLEMS}
    for name, one in known.items():
        if one.gait.shape == "sine":
            yield name, replace(one, gait=replace(one.gait, shape="free"))
        elif one.gait.shape == "free":
            yield name, one
    for number in range(count):
        one = problem(draw(seed, number))
        yield f"random {number}", replace(one, gait=replace(one.gait, shape="free"))


def main() -> None:
    """Solve, climb, and write the page."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--random", type=int, default=10)
    parser.add_argument("--seed")
    asked = parser.parse_args()
    head = ["git", "rev-parse", "--short=12", "HEAD"]
    seed = asked.seed or subprocess.run(head, check=True, capture_output=True, text=True).stdout
    seed, gains, rows, others = seed.strip(), [], [], []
    for name, one in posed(asked.random, seed):
        begun = time.process_time()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            answer = rr.maximize_speed(one)
        seconds, best = time.process_time() - begun, answer.optimum.best
        if best is None or not isinstance(best.gait, FreeGait) or not answer.speed:
            others.append(f"- {name}: {answer.status.words}. {answer.message[:160]}")
            print(others[-1], flush=True)
            continue
        ratio = answer.optimum.ratio if one.inertia_ratio else None
        end = climb(answer.optimum.problem, best.gait, ratio)
        gained = end.speed / abs(answer.speed) - 1
        sine = answer.optimum.sine
        gains.append(gained)
        cells = f"{answer.speed:+.6g}", f"{sine or 0:.6g}", f"{gained:.1e}", f"{end.excess:.0e}"
        rows.append(f"| {name} | {' | '.join(cells)} | {seconds:.1f} |")
        print(rows[-1], end.programs, flush=True)
    kept = sum(gained <= _MOST for gained in gains)
    if others:
        others = [
            "No start led to a gait of these; where no sine has the direction asked for, nothing "
            "proves that no gait has it, so they are told as not converged, exit code 4.",
            "",
            *others,
        ]
    lines = [
        "# Free gaits: does a climb by another method go on from the answer?",
        "",
        f"{machine()}. Seed `{seed}`. Sequential linear programs over period, offset, inertia "
        "ratio and all accelerations, on a hand-written model with exact slopes, until one "
        "promises less than 1e-9. CPU seconds of the whole command.",
        "",
        "| problem | speed, m/s | sine, m/s | climb gains | breaks a limit by | CPU, s |",
        "|---|---|---|---|---|---|",
        *rows,
        "",
        f"{kept} of {len(rows)} gain no more than {_MOST:.0e}; the most is {max(gains):.1e}.",
        "",
        *others,
    ]
    write("free", lines, {"free gaits that are optima": kept / len(rows)})


if __name__ == "__main__":
    main()
