"""The page of the sweep's rates."""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence

from benchmarks.results import installed
from benchmarks.sweep.case import Work
from benchmarks.sweep.measure import Rate
from benchmarks.sweep.ways import LIMIT, NUMBA, OURS, PLAIN

GOALS = {OURS.name: 500_000, PLAIN.name: 120_000}
"""Points a second and core, viscous."""

_FLOOR = (
    "An operation here is NumPy's pass over arrays: it reads one or two and writes one, 16 to 24 "
    "bytes a value, at this rate about what the processor's cache delivers. So the "
    "evaluations, half of the time, are at their floor, and fewer of them, or several operations "
    "on a value while it is in a register, would be needed to get to Numba's rate. The second is "
    "what a compiler does: with one the same method is ahead of Numba in all four cases. Numba "
    "brings its own."
)

_PACKAGES = ("numba", "jax", "diffrax", "scipy", "casadi", "numpy")


def written(
    machine: str,
    cases: Mapping[str, Work],
    found: Mapping[str, Sequence[Rate]],
    cold: Mapping[str, Mapping[str, float]],
    busy: Sequence[str],
    uncompiled: Sequence[str],
) -> tuple[list[str], dict[str, float]]:
    """The page's lines, and the ratios of which bigger is better for this project."""
    versions = ", ".join(f"{name} {installed(name)}" for name in _PACKAGES if installed(name))
    lines = [
        "# How many steady speeds a second",
        "",
        f"Written by `python -m benchmarks.sweep`. {machine}; {versions}.",
        "",
        "Points per CPU second on one core, median (least to most) of the rounds, the ways in "
        "turns. Every way has to give the average speed to 1e-6, relative (of less than 1 mm/s: "
        "of 1 mm/s); the largest error is what it gave; one that gives less is not compared. "
        "Ways with a fixed step get, for each point, the fewest steps (a power of two) that are "
        "enough for it, found beforehand and not counted. rr-opt gives turn and peak torque too, "
        "the others the speed alone. A way is run on as many points as take some tenths of a "
        "second, drawn at random from the case's.",
    ]
    ratios: dict[str, float] = {}
    for label, rates in found.items():
        lines += ["", f"## {label[0].upper()}{label[1:]} ({cases[label].size:,} points)", ""]
        lines += ["| | points/s a core | rr-opt is so many times as fast | largest error | of |"]
        lines += ["|---|---|---|---|---|"]
        ours = next(_middle(rate) for rate in rates if rate.name == OURS.name)
        for rate in rates:
            if rate.why:
                lines.append(f"| {rate.name} | {rate.why} | | | |")
                continue
            own = _middle(rate)
            told = f"{own:,.0f} ({min(rate.cpu):,.0f} to {max(rate.cpu):,.0f})"
            missed = "" if rate.close else " (too large)"
            factor = "" if rate.name == OURS.name or not rate.close else f"{ours / own:.3g}"
            lines.append(
                f"| {rate.name} | {told} | {factor} | {rate.error:.1e}{missed} | {rate.points} |"
            )
            if rate.name in GOALS and cases[label].friction == "viscous":
                ratios[f"{label}: {rate.name} / {GOALS[rate.name]}"] = own / GOALS[rate.name]
            if rate.name not in GOALS and rate.close:
                ratios[f"{label}: rr-opt / {rate.name}"] = ours / own
    lines += ["", "## Cold", ""]
    lines += ["CPU seconds of a fresh process with nothing in a cache until it has 64 points, "]
    lines[-1] += "imports and compilers included; run once."
    kinds = sorted({kind for seconds in cold.values() for kind in seconds}, reverse=True)
    lines += ["", f"| | {' | '.join(kinds)} |", f"|---|{'---|' * len(kinds)}"]
    for name, seconds in cold.items():
        cells = [f"{seconds[one]:.1f}" if one in seconds else "" for one in kinds]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    lines += ["", "## More than one core", "", *busy, "", "## What it says", "", *_said(found)]
    lines += ["", "## Where the time goes without a compiler", "", *uncompiled, "", _FLOOR]
    return lines, ratios


def _middle(rate: Rate) -> float:
    return statistics.median(rate.cpu)


def _said(found: Mapping[str, Sequence[Rate]]) -> list[str]:
    lines = []
    for label, rates in found.items():
        by_name = {rate.name: _middle(rate) for rate in rates if not rate.why}
        ours, plain = by_name[OURS.name], by_name[PLAIN.name]
        if label.startswith("viscous"):
            goals = (ours >= GOALS[OURS.name], plain >= GOALS[PLAIN.name])
            kept = ["missed", "reached"]
            told = (
                f"{ours:,.0f} points/s with a compiler (goal 500,000: {kept[goals[0]]}) and "
                f"{plain:,.0f} without (goal 120,000: {kept[goals[1]]})"
            )
            if LIMIT.name in by_name:
                told += f"; C by hand for the speed alone does {by_name[LIMIT.name]:,.0f}"
        else:
            told = f"{ours:,.0f} points/s with a compiler, {plain:,.0f} without"
            if NUMBA.name in by_name:
                other = by_name[NUMBA.name]
                told += f"; Numba RK4 does {other:,.0f}, {ours / other:.2g} and {plain / other:.2g}"
                told += " times as many by rr-opt"
        lines.append(f"- {label[0].upper()}{label[1:]}: {told}.")
    return lines
