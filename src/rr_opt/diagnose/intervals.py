"""How sure the fitted values are: 95 % intervals from the curvature of the cost.

Noise is one part. Another is what no model of the machine has exactly, which is taken in as an
unknown of every run, and what models of an effect do not agree on. And where misfit is left, in the
recordings that were fitted or in those that were not, its samples say the same for a second or two,
and the intervals are wider by the root of `doubt`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from rr_opt.diagnose.diagnosis import Estimate
from rr_opt.diagnose.fit import Fit
from rr_opt.diagnose.model import Array, Model
from rr_opt.diagnose.normal import total
from rr_opt.diagnose.problem import Problem, doubt

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
