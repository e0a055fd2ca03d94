"""All alternatives on the same problems from the same random starts, in turn."""

from __future__ import annotations

import json
import math
import os
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path

from benchmarks.optimise.peers.judged import Judged, judged
from benchmarks.optimise.peers.once import FOLDER, cold
from benchmarks.optimise.peers.posed import Array, Claim, Posed, eligible, posed
from benchmarks.optimise.problems import PROBLEMS

ALTERNATIVES = (
    "package",
    "evolution",
    "yapss_lgl",
    "opti",
    "rockit_collocation",
    "dymos_lobatto",
    "slsqp_ivp",
)
_KNOWN = Path(__file__).parents[1] / "best_known.json"
_COLD_ROUNDS = 2
_LONG = 2.0
"""CPU seconds of a run after which no more are made of that problem."""


@dataclass(frozen=True)
class Run:
    """One run: CPU and wall seconds, and what came of it."""

    problem: str
    cpu: float
    wall: float
    judged: Judged


@dataclass
class Runs:
    """What was seen of one alternative.

    absent  why it cannot be used here, empty if it can
    cold    CPU and wall seconds of new processes; warm: the runs
    """

    name: str
    absent: str = ""
    cold: list[tuple[float, float]] = field(default_factory=list)
    warm: list[Run] = field(default_factory=list)


def race(starts: int, first: str, names: list[str] | None = None) -> list[Runs]:
    """Run all from `starts` random starts each, on `names` or every problem that can be posed.

    first: the problem on which new processes are timed, a few rounds in turn.
    """
    runs = {one: Runs(import_module(f"{FOLDER}.{one}").NAME) for one in ALTERNATIVES}
    for _ in range(_COLD_ROUNDS):
        for one, seen in runs.items():
            took = cold(one, first)
            if took:
                seen.cold.append(took)
    known = json.loads(_KNOWN.read_text(encoding="utf-8"))
    for problem in eligible() if names is None else names:
        _warm(problem, starts, known[problem]["speed"], runs)
        print(problem, {one: _told(seen, problem) for one, seen in runs.items()}, flush=True)
    return list(runs.values())


def _warm(problem: str, starts: int, best: float, runs: dict[str, Runs]) -> None:
    stated = posed(PROBLEMS[problem], problem)
    # Each has one start that does not count, in which it builds what it needs; it does where it
    # took so long that what was built is no matter.
    first, *given = stated.starts(1 + starts, 1)
    ready = {}
    for one, seen in runs.items():
        try:
            ready[one] = import_module(f"{FOLDER}.{one}").prepare(stated)
        except ImportError as error:
            seen.absent = str(error)
            continue
        run = _timed(ready[one], stated, first, best)
        if run.cpu > _LONG:
            seen.warm.append(run)
            del ready[one]
    for start in given:
        for one, solve in ready.items():
            runs[one].warm.append(_timed(solve, stated, start, best))


def _timed(solve: Callable[[Array], Claim], stated: Posed, start: Array, best: float) -> Run:
    cpu, wall = time.process_time(), time.perf_counter()
    claim = _claim(solve, start)
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    nothing = Judged(math.nan, math.nan, math.nan, False, "no answer")
    return Run(stated.name, cpu, wall, judged(stated, claim, best) if claim else nothing)


def _claim(solve: Callable[[Array], Claim], start: Array) -> Claim | None:
    """The claim; None where the alternative breaks off. What it prints is not wanted."""
    quiet, out = os.open(os.devnull, os.O_WRONLY), os.dup(1)
    os.dup2(quiet, 1)
    try:
        return solve(start)
    except Exception:
        return None
    finally:
        os.dup2(out, 1)
        os.close(out)
        os.close(quiet)


def _told(seen: Runs, problem: str) -> str:
    mine = [run for run in seen.warm if run.problem == problem]
    right = sum(run.judged.right for run in mine)
    return f"{right}/{len(mine)} {sum(run.cpu for run in mine) / max(len(mine), 1):.3f}"
