"""Which of the model's own values are wrong, and how sure the fitted ones are.

How sure the fitted values are: 95 % intervals from the curvature of the cost.

Noise is one part. Another is what no model of the machine has exactly, which is taken in as an
unknown of every run, and what models of an effect do not agree on. And where misfit is left, in the
recordings that were fitted or in those that were not, its samples say the same for a second or two,
and the intervals are wider by the root of `doubt`.

Which of the model's own values are wrong?

A parameter that is off by more than its uncertainty allows draws the others with it, as many small
surprises are likelier than a large one. So once the data are explained, the one that is most
certainly off is let go: no more is believed of it beforehand, everything is fitted again, and the
next is looked for.

With u its distance from what was believed, in sigmas, and s the sigma that is left with the data,
u is spread by sqrt(1 - s^2) where all is well, so that is what it is measured in. A value that was
known only to within a factor differs where its interval leaves out the nominal one.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from scipy.stats import norm

from rr_opt.array import Array
from rr_opt.sysid.candidate import FLOOR, Explanation, misfit, rms
from rr_opt.sysid.diagnosis import Estimate
from rr_opt.sysid.least_squares import Fit, Problem, doubt, scaled, solve, total
from rr_opt.sysid.model import Model, Quantity

_Z = 1.959963984540054


def covariance(fit: Fit) -> Array:
    """Of the scaled quantities (nq, nq), from noise and misfit alone."""
    wider = doubt(fit.cost, fit.count)
    return np.asarray(wider * np.linalg.pinv(fit.total().H, hermitian=True), float)


def estimates(model: Model, fit: Fit, held: float = 0.0) -> Mapping[str, Estimate]:
    """Every fitted quantity with its interval; `held` is the misfit of recordings held out."""
    problem = Problem(model, tuple(fit.starts), fit.effects, fit.quantities)
    normals = problem.normals(fit.values, fit.starts, stray=True).values()
    wider = max(doubt(fit.cost, fit.count), doubt(1.0 + held, 1))
    prior = wider * np.array([float(q.known) for q in fit.quantities])
    H = total(normals, prior, fit.scaled).H
    spread = np.sqrt(np.maximum(wider * np.diag(np.linalg.pinv(H, hermitian=True)), 0.0))
    out = {}
    for q, s in zip(fit.quantities, spread, strict=True):
        value, half = fit.values[q.name], _Z * float(s) * q.scale
        half = math.hypot(half, _Z * model.vague.get(q.name, 0.0) * value)
        half = half if math.isfinite(half) else math.inf
        out[q.name] = Estimate(value, max(value - half, q.low), min(value + half, q.high), q.unit)
    return out


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
