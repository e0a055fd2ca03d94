"""What results/bench/fit.md says."""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence

import numpy as np

from benchmarks.fit.case import BOX, WITHIN
from benchmarks.fit.equations import PARAMETERS
from benchmarks.fit.referee import Minimum
from benchmarks.fit.ways import EXAMPLE, OURS, PATIENCE, WAYS, Tried
from benchmarks.results import installed, machine, spread

_GOAL, _SHARE = 10.0, 38 / 40


def text(
    tried: Mapping[str, Tried], missing: Sequence[str], best: Minimum, at_bound: float
) -> list[str]:
    """The page as lines."""
    known = np.sqrt(np.diag(best.covariance))
    told = ", ".join(f"{name} {100 * one:.2g}" for name, one in zip(PARAMETERS, known, strict=True))
    lines = [
        "# Fit: six parameters, six recordings of 20 s at 100 Hz",
        "",
        f"Written by `python -m benchmarks.fit`. {machine()}. Noise 1 mm and 3 mrad; each "
        "recording begins in a state of its own, which is fitted too. CPU seconds on one core, "
        "median (least to most). `warm`: from starts 5 % off, taking turns, with everything "
        "imported, built and compiled. `cold`: a process of its own, imports and compiling "
        "included. `far`: of starts within a factor of "
        f"{WITHIN:g} of the truth, how many led to the minimum, and the CPU seconds of each; no "
        f"way that takes bounds looks beyond a factor of {BOX:g}, and CasADi's may take "
        f"{PATIENCE:g} s. The minimum is the same if its "
        "chi-square, by an integrator that no way uses, is within 1e-6 of the least.",
        "",
        "| way | warm | times ours | cold | far | CPU, far | cost above the least |",
        "|---|---|---|---|---|---|---|",
    ]
    mine = statistics.median(tried[OURS].warm)
    for module, one in tried.items():
        version = installed(WAYS[module].needs)
        name = WAYS[module].name + ("" if module == OURS else f" ({WAYS[module].needs} {version})")
        cells = (
            name,
            _warm(one),
            _times(one, mine),
            f"{one.cold:.1f}" if one.cold else "not run",
            f"{one.reached} of {len(one.far)}" if one.far else "not run",
            spread(one.far) if one.far else "",
            f"{one.worst:.0e}" if one.warm else "",
        )
        lines.append(f"| {' | '.join(cells)} |")
    lines += [f"| {WAYS[one].name} | not available here ||||||" for one in missing]
    return [
        *lines,
        "",
        *_said(tried),
        "",
        f"The bound of Cramer and Rao is, in % of each value: {told}. Over draws of the noise the "
        f"mean square of our errors is {at_bound:.2f} of it (1 is on the bound).",
    ]


def _warm(one: Tried) -> str:
    missed = f"{one.missed} elsewhere" if one.missed else ""
    stopped = f"not done in {one.stopped:g}" if one.stopped else ""
    return ", ".join(
        part for part in (spread(one.warm) if one.warm else "", missed, stopped) if part
    )


def _times(one: Tried, mine: float) -> str:
    if one.warm:
        return f"{statistics.median(one.warm) / mine:.1f}"
    return f"over {one.stopped / mine:.0f}" if one.stopped else ""


def _said(tried: Mapping[str, Tried]) -> list[str]:
    own, other = tried[OURS], tried.get(EXAMPLE)
    if not other or not other.warm:
        return ["CasADi's example was not run."]
    ratio = statistics.median(other.warm) / statistics.median(own.warm)
    share = own.reached / max(len(own.far), 1)
    return [
        f"The goal was {_GOAL:g} times as fast as CasADi's example: "
        f"{'reached' if ratio >= _GOAL else 'missed'}, with {ratio:.1f}. And 38 of 40 far starts: "
        f"{'reached' if share >= _SHARE else 'missed'}, with {own.reached} of {len(own.far)}."
    ]
