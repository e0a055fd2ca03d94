"""How sure the fitted values are: 95 % intervals from the curvature of the cost.

At the noise the curvature is the whole story. Where misfit is left, its samples say the same for a
second or two, and the intervals are wider by the root of `doubt`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from rr_opt.diagnose.diagnosis import Estimate
from rr_opt.diagnose.fit import Fit, doubt
from rr_opt.diagnose.model import Array

_Z = 1.959963984540054


def covariance(fit: Fit) -> Array:
    """Of the scaled quantities (nq, nq)."""
    wider = doubt(fit.cost, fit.count)
    return np.asarray(wider * np.linalg.pinv(fit.total().H, hermitian=True), float)


def estimates(fit: Fit) -> Mapping[str, Estimate]:
    """Every fitted quantity with its interval."""
    spread = np.sqrt(np.maximum(np.diag(covariance(fit)), 0.0)) if fit.quantities else ()
    out = {}
    for q, s in zip(fit.quantities, spread, strict=True):
        value, half = fit.values[q.name], _Z * float(s) * q.scale
        half = half if math.isfinite(half) else math.inf
        out[q.name] = Estimate(value, max(value - half, q.low), min(value + half, q.high), q.unit)
    return out
