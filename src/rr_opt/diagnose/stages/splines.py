"""Smooth functions of time and of the cycle, as columns."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import BSpline
from scipy.linalg import eigh
from scipy.sparse import csr_array

from rr_opt.diagnose.model import Array

_DEGREE = 3


def columns(t: Array, spacing: float) -> tuple[Array, Array]:
    """Cubic B-splines (n, m) over t (n,), knots about `spacing` s apart; and their rates."""
    count = max(int(np.ceil((t[-1] - t[0]) / spacing)), 1)
    inner = np.linspace(t[0], t[-1], count + 1)
    knots = np.concatenate([[inner[0]] * _DEGREE, inner, [inner[-1]] * _DEGREE])
    spline = BSpline(knots, np.eye(count + _DEGREE), _DEGREE)
    return spline(t), spline.derivative()(t)


def smooth(B: Array, y: Array) -> Array:
    """Coefficients (m, k) of cubic B-splines B (n, m) that follow y (n, k), in sigmas, NaN: none.

    They bend as much as is likeliest for data with unit noise: where y is noise alone, straight
    lines come out, and where it is not, they follow it.
    """
    seen = np.isfinite(y).all(axis=1)
    sparse = csr_array(B[seen])
    A = (sparse.T @ sparse).toarray()
    A[np.diag_indices_from(A)] += 1e-6 * np.trace(A) / len(A)
    bend = np.diff(np.eye(len(A)), 2, axis=0)
    stiff, vectors = eigh(bend.T @ bend, A)
    bends = stiff > 1e-9 * stiff[-1]
    c = vectors.T @ (sparse.T @ y[seen])
    # A bending mode of stiffness s has the variance 1/(weight s) beside the noise's 1.
    weights = 10.0 ** np.arange(-4, 14, 0.5)
    variance = 1 + 1 / (weights[:, None] * stiff[bends])
    fit = np.log(variance).sum(axis=1)[:, None] + 1 / variance @ c[bends] ** 2
    best = weights[np.argmin(fit, axis=0)]
    return vectors @ (c / (1 + np.where(bends, stiff, 0.0)[:, None] * best))


def hats(x: Array, nodes: Array) -> Array:
    """Piecewise linear functions (n, m) of x (n,): each 1 at its node, 0 at the others."""
    return np.column_stack([np.interp(x, nodes, e) for e in np.eye(len(nodes))])
