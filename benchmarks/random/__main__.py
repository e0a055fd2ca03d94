"""Random problems and turns, the whole command held against brute force.

`python -m benchmarks.random [--problems 400] [--turns 200] [--seed TEXT] [--folder DIR]` writes
results/bench/random.md. Cases are appended to a journal as they are done, and a run goes on from
there. The seed is the hash of the commit unless one is given: nobody chooses it. The page has the
journals of all seeds in the folder.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import time
import warnings
from collections import Counter
from dataclasses import replace
from pathlib import Path

import rr_opt as rr
from benchmarks.random.brute_force import best
from benchmarks.random.problems import draw, problem, turning
from benchmarks.results import FOLDER, machine, write
from rr_opt.design.decisions import decisions
from rr_opt.design.infeasible import nearest_turn, posture_clashes
from rr_opt.design.turn import LARGEST_RADIUS
from rr_opt.model.problem import Interval, Problem, Turn

_SHORT = 1e-4
"""An answer that is slower than brute force by more, relative, is wrong."""
_STANDS = 1e-6
"""m/s. A robot of this speed moves 1 mm, what a capture system tells of a place, in a quarter of an
hour: what is slower stands, and speeds that differ by less are the same."""
_WIDEST = 20.0
_TIGHTEST = 0.01
"""m; no robot is asked for a tighter circle."""
VERDICTS = {
    "right": "an answer no slower than brute force",
    "right, none": "infeasible, and brute force found no gait either",
    "slower": "an answer, but brute force is faster",
    "false refusal": "infeasible, but brute force has a gait",
    "not converged": "no answer",
}

_RIGHT = ("right", "right, none")
_DRAWS = 1000


def turn(number: int, seed: str) -> tuple[Problem, float, float]:
    """A problem, the radius to ask for, m, and how many times the tightest it is: of the draws for
    this number the first that has a gait and turns to the side that is asked for."""
    for k in range(_DRAWS):
        rng = draw(seed, 10_000 + _DRAWS * number + k)
        posed = turning(rng)
        box = decisions(posed)
        if posture_clashes(posed, box):
            continue
        side = 1.0 if rng.random() < 0.5 else -1.0
        asked = Turn(curvature=Interval(side / _TIGHTEST, side / _TIGHTEST))
        tight = replace(posed, turn=asked)
        nearest = nearest_turn(tight, decisions(tight))
        way = {"forward": 1.0, "backward": -1.0, "either": nearest.speed}[posed.direction]
        kept = nearest.torque <= posed.limits.torque * (1 + 1e-6) and nearest.speed * way > 0
        if not kept or nearest.curvature * side <= 0:
            continue
        times = 1.0 if number % 8 == 0 else float(_WIDEST ** rng.random())
        radius = max(1 / abs(nearest.curvature), _TIGHTEST) * times * (1 + 1e-5)
        if radius <= LARGEST_RADIUS:
            return posed, side * float(f"{radius:.6g}"), times
    raise ValueError(f"No turn for number {number}.")


def held(kind: str, number: int, seed: str) -> dict:
    """One case: what was answered, and what brute force has."""
    times, radius = math.nan, None
    if kind == "turn":
        posed, radius, times = turn(number, seed)
        asked = replace(posed, turn=Turn(curvature=Interval(1 / radius, 1 / radius)))
    else:
        posed = asked = problem(draw(seed, number))
    begun = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        answer = rr.turn(posed, radius=radius) if radius else rr.maximize_speed(posed)
    seconds = time.process_time() - begun
    known = best(asked)
    speed = abs(answer.speed) if answer.speed and answer.status.name == "OPTIMAL" else 0.0
    return {
        "kind": kind,
        "number": number,
        "verdict": verdict(answer.status.name, speed, known),
        "speed": speed,
        "known": known,
        "seconds": round(seconds, 3),
        "search": answer.optimum.iterations,
        "radius": radius,
        "times": times,
        "message": "" if speed else answer.message,
    }


def verdict(status: str, speed: float, known: float) -> str:
    """One of VERDICTS."""
    if status == "OPTIMAL":
        return "right" if speed >= known * (1 - _SHORT) - _STANDS else "slower"
    if status == "INFEASIBLE":
        return "false refusal" if known > _STANDS else "right, none"
    return "not converged"


def page(rows: list[dict], asked: dict[tuple[str, str], int]) -> tuple[list[str], dict[str, float]]:
    """The page and its ratios; asked: how many cases of a kind and a seed."""
    lines = [
        "# Random problems and turns: against brute force",
        "",
        f"{machine()}. The whole command with its checks, from default settings; "
        "brute force: 2^13 quasi-random gaits on a hand-written model, the best of 12 regions "
        "polished by SLSQP. An answer counts as right if it is confirmed by every check and no "
        f"more than {_SHORT:.0e} slower, relative, or {_STANDS:.0e} m/s: a robot of that speed "
        "moves 1 mm, what a capture system tells of a place, in a quarter of an hour. What is "
        "slower counts as standing: no refusal misses it.",
        "",
        "| | seed | commits | cases | "
        + " | ".join(VERDICTS)
        + " | brute force slower | CPU, s, median (most) |",
        "|" + "---|" * (len(VERDICTS) + 6),
    ]
    ratios = {}
    for kind, seed in sorted({(row["kind"], row["seed"]) for row in rows}):
        own = [row for row in rows if (row["kind"], row["seed"]) == (kind, seed)]
        counts = Counter(row["verdict"] for row in own)
        behind = sum(row["speed"] > row["known"] * (1 + _SHORT) + _STANDS for row in own)
        took = sorted(row["seconds"] for row in own)
        commits = ", ".join(dict.fromkeys(row["commit"] for row in own))
        of = asked.get((kind, seed), len(own))
        cases = str(len(own)) if len(own) >= of else f"{len(own)} of {of}"
        lines.append(
            f"| {kind}s | `{seed}` | {commits} | {cases} | "
            + " | ".join(str(counts[name]) for name in VERDICTS)
            + f" | {behind} | {took[len(took) // 2]:.2f} ({took[-1]:.2f}) |"
        )
    bad = [row for row in rows if row["verdict"] not in _RIGHT]
    for kind in sorted({row["kind"] for row in rows}):
        own = [row["verdict"] in _RIGHT for row in rows if row["kind"] == kind]
        ratios[f"{kind}s right"] = sum(own) / len(own)
    lines += ["", *(f"`{name}`: {what}." for name, what in VERDICTS.items()), ""]
    for row in bad:
        lines.append(
            f"- {row['kind']} {row['number']} of `{row['seed']}`: {row['verdict']}; "
            f"answer {row['speed']:.6g} m/s, brute force {row['known']:.6g} m/s. "
            f"{row['message'][:160]}"
        )
    return lines, ratios


def main() -> None:
    """Run what is missing, and write the page."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--problems", type=int, default=400)
    parser.add_argument("--turns", type=int, default=200)
    parser.add_argument("--seed")
    parser.add_argument("--folder", type=Path, default=FOLDER)
    parser.add_argument("--only", nargs="*", type=int, help="these numbers alone, printed")
    asked = parser.parse_args()
    head = ["git", "rev-parse", "--short=12", "HEAD"]
    commit = subprocess.run(head, check=True, capture_output=True, text=True).stdout.strip()
    seed = asked.seed or commit
    journal = asked.folder / f"random-{seed}.jsonl"
    rows = [
        json.loads(line) | {"seed": one.stem.removeprefix("random-")}
        for one in sorted(asked.folder.glob("random-*.jsonl"))
        for line in one.read_text().splitlines()
    ]
    done = {(row["kind"], row["number"]) for row in rows if row["seed"] == seed}
    counts = {"problem": asked.problems, "turn": asked.turns}
    for kind, count in counts.items():
        for number in asked.only or range(count):
            if (kind, number) in done and not asked.only:
                continue
            row = held(kind, number, seed) | {"commit": commit[:7]}
            print(json.dumps(row), flush=True)
            if not asked.only:
                rows.append(row | {"seed": seed})
                with journal.open("a") as file:
                    file.write(json.dumps(row) + "\n")
    if not asked.only:
        lines, ratios = page(rows, {(kind, seed): count for kind, count in counts.items()})
        write("random", lines, ratios)
        print("\n".join(lines))


if __name__ == "__main__":
    main()
