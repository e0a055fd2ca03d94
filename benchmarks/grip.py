"""Where grip binds: `python -m benchmarks.grip` writes results/bench/grip.md.

The prototype and the problems of `benchmarks.optimise`, without a limit on grip and with two. The
answers are not checked by a sweep here.
"""

from __future__ import annotations

import math
from dataclasses import replace

from benchmarks.optimise.problems import PROBLEMS
from benchmarks.results import FOLDER
from rr_opt.design.maximize_speed import Optimum, maximize_speed
from rr_opt.documents.archive import write_text
from rr_opt.files.problem_file import read_problem
from rr_opt.model.problem import Problem
from rr_opt.motion.steady_cycle import grip_needed, reference_cycle

GRIPS = (0.6, 0.3)


def solved(problem: Problem, grip: float) -> tuple[Optimum, tuple[float, float]]:
    """The optimum with this limit and the grip of both axles that it needs."""
    found = maximize_speed(replace(problem, limits=replace(problem.limits, grip=grip)))
    if found.best is None or found.robot is None:
        return found, (math.nan, math.nan)
    return found, grip_needed(reference_cycle(found.robot, found.best.gait), found.robot)


def main() -> None:
    prototype = read_problem()
    problems = {
        "prototype": prototype,
        "prototype, as built": replace(prototype, inertia_ratio=None),
        **{name: one for name, one in PROBLEMS.items() if one.gait.shape == "sine"},
    }
    lines = [
        "# Where grip binds",
        "",
        "Written by `python -m benchmarks.grip`. Speed without a limit, and the side force over",
        "load that it takes on each axle; then the speed with `limits.grip`, a dash where it does",
        "not bind, and its shadow price in mm/s per 0.01.",
        "",
        "| problem | speed, mm/s | axle 1 | axle 2 | at 0.6 | price | at 0.3 | price |",
        "|---|---|---|---|---|---|---|---|",
    ]
    counts = dict.fromkeys(GRIPS, 0)
    for name, problem in problems.items():
        found, needed = solved(problem, math.inf)
        if found.best is None:
            continue
        cells = [f"{1e3 * found.best.speed:+.1f}", *(f"{one:.3f}" for one in needed)]
        for grip in GRIPS:
            if max(needed) <= grip:
                cells += ["–", "–"]
                continue
            counts[grip] += 1
            held = solved(problem, grip)[0]
            if held.best is None:
                cells += [held.status.words, "–"]
                continue
            cells += [f"{1e3 * held.best.speed:+.1f}", f"{10 * held.best.prices['grip']:+.2f}"]
        lines.append(f"| {name} | {' | '.join(cells)} |")
        print(lines[-1], flush=True)
    total = len(lines) - 8
    told = ", ".join(f"at {grip:g} in {count}" for grip, count in counts.items())
    lines += ["", f"It binds {told} of {total} problems."]
    write_text(FOLDER / "grip.md", "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
