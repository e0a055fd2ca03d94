"""The shape of a curve in words: "resists motion, and falls with speed below 0.05 m/s"."""

from __future__ import annotations

import numpy as np

from rr_opt.diagnose.model import Array

_OPPOSITES = {
    "resists motion": "helps motion",
    "resists motion in proportion to speed": "helps motion in proportion to speed",
    "pushes forward": "pushes backward",
    "drifts to the left": "drifts to the right",
    "is more than was told": "is less than was told",
}
_MOST = 0.8
"""Of all ups and downs has to go one way, or happen on one side of a value, for it to be named."""


def shape(says: str, variable: str, unit: str, at: Array, mean: Array, error: Array) -> str:
    """What a curve (mean (k,) with standard errors, over `at` (k,)) does, in words.

    says  what a positive value does; where the curve is negative throughout, its opposite is said
    """
    weight = 1 / np.maximum(error, 1e-300) ** 2
    level = float(np.sum(weight * mean) / np.sum(weight))
    sure = np.abs(mean) > 2 * error
    signs = set(np.sign(mean[sure]))
    does = says
    if signs == {-1.0}:
        does, mean, level = _OPPOSITES[says], -mean, -level
    elif signs == {-1.0, 1.0}:
        does = f"{says} at some values of the {variable} and {_OPPOSITES[says]} at others"
    return f"{does}{_trend(variable, unit, at, mean, error, level)}"


def _trend(variable: str, unit: str, at: Array, mean: Array, error: Array, level: float) -> str:
    change = float(np.ptp(mean))
    if change < 0.15 * abs(level) or np.all(np.abs(mean - level) < 2 * error):
        return f", the same at every {variable}"
    steps = np.diff(mean)
    total = float(np.abs(steps).sum())
    for word, along in (("rises", steps), ("falls", -steps)):
        if float(np.maximum(along, 0).sum()) > _MOST * total:
            return f", and {word} with {variable}{_where(unit, at, along, total)}"
    most, least = at[np.argmax(mean)], at[np.argmin(mean)]
    return f", most at a {variable} of {most:.2g} {unit} and least at {least:.2g} {unit}"


def _where(unit: str, at: Array, along: Array, total: float) -> str:
    """Below or above what most of a change happens, if it is not all over the range."""
    done = np.cumsum(np.maximum(along, 0)) / total
    middle = (at[0] + at[-1]) / 2
    below = at[1:][np.argmax(done >= _MOST)]
    if below <= middle:
        return f" below {below:.2g} {unit}"
    above = at[:-1][done - np.maximum(along, 0) / total <= 1 - _MOST][-1]
    return f" above {above:.2g} {unit}" if above >= middle else ""
