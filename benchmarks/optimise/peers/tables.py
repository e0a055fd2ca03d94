"""The race as Markdown and as ratios."""

from __future__ import annotations

import statistics
from collections import Counter
from collections.abc import Iterable

from benchmarks.optimise.peers.race import Runs

_GOAL = 3
"""Times as long as ours the fastest alternative that is always right shall take."""


def lines(runs: list[Runs], first: str) -> list[str]:
    """What is printed; the first of the runs are this project's."""
    problems = list(dict.fromkeys(run.problem for run in runs[0].warm))
    return [
        "## What a user would pick instead",
        "",
        f"The same {len(problems)} problems (all that need only bounds, rate, angle and torque), "
        "from the same random starts within the bounds, in turn. `right`: a start led to the best "
        "known speed within 1e-4, the solver says it is an optimum, and the project's replay "
        "agrees with the claimed speed within 1e-4 and finds no limit broken by more than 1e-3. "
        "`a right answer`: CPU seconds of all warm runs by the number of right ones, what a user "
        "who starts again and again pays. "
        f"`cold`: a new process on `{first}`, imports included. `warm`: what each can keep is "
        "built; where a run takes over 2 s there is one of each problem. Seconds of CPU, medians, "
        "least to most in brackets. One core.",
        "",
        "| | cold | cold, wall | warm | right | always right on | a right answer | of ours |",
        "|---|---|---|---|---|---|---|---|",
        *(_row(seen, runs[0]) for seen in runs),
        "",
        verdict(runs),
        "",
        "Why runs were not right: " + _reasons(runs) + ".",
        "",
        "Medians of warm CPU seconds, and runs that were right:",
        "",
        "| problem | " + " | ".join(seen.name for seen in runs if seen.warm) + " |",
        "|---" * (1 + sum(bool(seen.warm) for seen in runs)) + "|",
        *(_problem(name, [seen for seen in runs if seen.warm]) for name in problems),
    ]


def verdict(runs: list[Runs]) -> str:
    """Whether the goal is reached, in a sentence or two."""
    ours, others = runs[0], runs[1:]
    sure = [one for one in others if one.warm and all(run.judged.right for run in one.warm)]
    missed = sum(not run.judged.right for run in ours.warm)
    said = f"rr_opt was right in {len(ours.warm) - missed} of {len(ours.warm)} runs. "
    if not sure:
        return said + "No alternative was always right."
    fastest = min(sure, key=lambda one: _against(one, ours))
    times = _against(fastest, ours)
    goal = "which is" if times >= _GOAL else "short of"
    return said + (
        f"Always right too: {', '.join(one.name for one in sure)}. The fastest of them, "
        f"{fastest.name}, takes {times:.1f} times as long, {goal} the goal of {_GOAL}."
    )


def ratios(runs: list[Runs]) -> dict[str, float]:
    """CPU seconds of each alternative to ours: cold, warm, and to a right answer."""
    ours, found = runs[0], {}
    for seen in runs[1:]:
        if not seen.warm or not seen.cold:
            continue
        found[f"cold: {seen.name}"] = _cold(seen) / _cold(ours)
        found[f"warm: {seen.name}"] = _against(seen, ours)
        if any(run.judged.right for run in seen.warm):
            found[f"a right answer: {seen.name}"] = _right(seen) / _right(ours)
    return found


def _row(seen: Runs, ours: Runs) -> str:
    if not seen.warm:
        return f"| {seen.name} | not available here: {seen.absent} |" + " |" * 6
    right = [run.judged.right for run in seen.warm]
    by_problem: dict[str, bool] = {}
    for run in seen.warm:
        by_problem[run.problem] = by_problem.get(run.problem, True) and run.judged.right
    paid = f"{_right(seen):.2f} | {_right(seen) / _right(ours):.1f}" if any(right) else "never | "
    return (
        f"| {seen.name} | {_spread(cpu for cpu, _ in seen.cold)} | "
        f"{_spread(wall for _, wall in seen.cold)} | {_spread(run.cpu for run in seen.warm)} | "
        f"{sum(right)}/{len(right)} | {sum(by_problem.values())}/{len(by_problem)} | {paid} |"
    )


def _problem(name: str, runs: list[Runs]) -> str:
    cells = []
    for seen in runs:
        mine = [run for run in seen.warm if run.problem == name]
        right = sum(run.judged.right for run in mine)
        cells.append(f"{_median(seen, name):.3f}, {right}/{len(mine)}")
    return f"| {name} | " + " | ".join(cells) + " |"


def _reasons(runs: list[Runs]) -> str:
    told = []
    for seen in runs:
        why = Counter(run.judged.why for run in seen.warm if not run.judged.right)
        if why:
            told.append(f"{seen.name}: " + ", ".join(f"{n} {one}" for one, n in why.most_common()))
    return "; ".join(told) or "there were none"


def _spread(values: Iterable[float]) -> str:
    numbers = list(values)
    return f"{statistics.median(numbers):.2f} ({min(numbers):.2f} to {max(numbers):.2f})"


def _cold(seen: Runs) -> float:
    return statistics.median(cpu for cpu, _ in seen.cold)


def _right(seen: Runs) -> float:
    return sum(run.cpu for run in seen.warm) / sum(run.judged.right for run in seen.warm)


def _against(seen: Runs, ours: Runs) -> float:
    """The median over the problems of the ratio of the medians."""
    names = dict.fromkeys(run.problem for run in seen.warm)
    return statistics.median(_median(seen, name) / _median(ours, name) for name in names)


def _median(seen: Runs, problem: str) -> float:
    return statistics.median(run.cpu for run in seen.warm if run.problem == problem)
