"""Which of the model's own values are wrong?

A parameter that is off by more than its uncertainty allows draws the others with it, as many small
surprises are likelier than a large one. So once the data are explained, the one that is most
certainly off is let go: no more is believed of it beforehand, everything is fitted again, and the
next is looked for.

With u its distance from what was believed, in sigmas, and s the sigma that is left with the data,
u is spread by sqrt(1 - s^2) where all is well, so that is what it is measured in. A value that was
known only to within a factor differs where its interval leaves out the nominal one.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.stats import norm

from rr_opt.diagnose.explanation import FLOOR, Explanation, misfit, rms
from rr_opt.diagnose.fit import Fit, solve
from rr_opt.diagnose.intervals import covariance
from rr_opt.diagnose.model import Array, Model, Quantity
from rr_opt.diagnose.problem import Problem, scaled

FALSE_ALARM = 0.01
"""Chance that any value is called wrong where all are right."""

_MOST = 4
_LET_GO = 30.0
"""So many of its sigmas a value is then believed to be uncertain by."""


def surprises(fit: Fit) -> Array:
    """How far each quantity is from what was believed, as a standard normal where all is well."""
    if not fit.quantities:
        return np.zeros(0)
    spread = np.sqrt(np.maximum(np.diag(covariance(fit)), 1e-300))
    u = scaled(fit.quantities, fit.values)
    usual = np.sqrt(np.maximum(1.0 - np.minimum(spread, 1.0) ** 2, 1e-300))
    seen = spread < 0.999
    own = np.where([q.free for q in fit.quantities], spread, np.where(seen, usual, np.inf))
    return np.where([q.known for q in fit.quantities], u / own, 0.0)


def limit(fit: Fit) -> float:
    """Beyond which a surprise is one, all of them looked at together."""
    known = sum(q.known for q in fit.quantities)
    return float(norm.isf(FALSE_ALARM / (2 * max(known, 1))))


def wrong(fit: Fit) -> list[Quantity]:
    """The parameters whose values are not what was believed."""
    over = np.abs(surprises(fit)) > limit(fit)
    return [q for q, off in zip(fit.quantities, over, strict=True) if off]


def settled(model: Model, best: Explanation) -> Explanation:
    """The explanation with the values let go that are certainly wrong, if it explains the data."""
    fit = best.whole
    for _ in range(_MOST):
        size = np.abs(surprises(fit)) * [not q.free for q in fit.quantities]
        if rms(misfit(fit)) > 2 * FLOOR or not size.size or size.max() <= limit(fit):
            break
        worst = int(np.argmax(size))
        quantities = tuple(
            replace(q, scale=q.scale * _LET_GO, free=True) if k == worst else q
            for k, q in enumerate(fit.quantities)
        )
        problem = Problem(model, tuple(fit.starts), fit.effects, quantities)
        fit = solve(problem, fit.values, fit.starts)
    return replace(best, whole=fit)
