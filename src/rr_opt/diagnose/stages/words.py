"""A curve in words: what it depends on, and where it is largest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from rr_opt.diagnose.diagnosis import Curve
from rr_opt.diagnose.stages.blame import CLEAR

_DOUBTFUL = 1.5
"""What a fault should not depend on explains so much more of it than what it should."""

_NAMES = {
    "phase": "the phase",
    "speed": "the speed",
    "rate": "the commanded rate",
    "heading": "the heading",
    "along": "the place along x",
    "across": "the place along y",
    "time": "the time",
}

_SAYS = {
    "phase": "in the cycle, at phase {at:.2f}",
    "speed": "at {at:.2g} m/s",
    "rate": "where the command turns at {at:.2g} rad/s",
    "heading": "at a heading of {at:.0f} degrees",
    "along": "at x = {at:.2f} m",
    "across": "at y = {at:.2f} m",
    "time": "{at:.0f} s after the start",
}


def where(curves: Sequence[Curve], clear: Sequence[float], others: Mapping[str, float]) -> str:
    """A sentence on the curve that is clearest.

    clear   of each curve, by how much chi-square it beats what noise gives
    others  the same of variables on which the fault should not depend
    """
    if not curves or max(clear) < CLEAR:
        names = [_NAMES[one.variable] for one in curves]
        return f"It does not depend clearly on {_listed(names)}."
    k = int(np.argmax(clear))
    best = curves[k]
    peak = int(np.argmax(np.abs(best.mean) / best.error))
    at = float(best.at[peak]) * (180 / np.pi if best.variable == "heading" else 1.0)
    place = _SAYS[best.variable].format(at=at)
    told = f"It follows {_NAMES[best.variable]} best, and is clearest {place}."
    other = max(others, key=lambda name: others[name], default="")
    if other and others[other] > _DOUBTFUL * clear[k]:
        told += f" It follows {_NAMES[other]} better still, so another cause is possible."
    return told


def _listed(words: Sequence[str]) -> str:
    return " or ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def varies(curve: Curve) -> float:
    """Chi-square of a curve of independent bins against zero, less their number."""
    return float(np.sum((curve.mean / curve.error) ** 2) - curve.at.size)
