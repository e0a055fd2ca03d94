"""Who reached the minimum: one judge for all, in NumPy, that none of them uses.

It steps all trajectories at once by Runge-Kutta at half the time between samples, differentiates by
central differences and comes to the minimum from the truth. The Cramer-Rao bound is the covariance
there with each recording's own start taken out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.fit.case import RATE, TRUE, Array, Case, commanded, guessed_start
from benchmarks.fit.equations import rates

_FINE = 2
_STEP = 1e-4
_SAME = 1e-6
"""Of the cost: what is higher by less is the same minimum."""


@dataclass(frozen=True)
class Minimum:
    """p (6,) at the least cost, and its covariance relative to the truth (6, 6)."""

    p: Array
    cost: float
    covariance: Array


def predicted(case: Case, p: Array, starts: Array) -> Array:
    """x, y, psi (n, 3, runs, many) for p (6, many) and starts (4, runs, many)."""
    h = 1 / (RATE * _FINE)
    turns = 2 * np.arange((case.t.size - 1) * _FINE + 1)
    drives = np.stack([commanded(gait, np.arange(turns[-1] + 1) * h / 2) for gait in case.gaits])
    drives = drives.transpose(2, 1, 0)[..., None]
    state, given = starts.copy(), p[:, None, :]
    out = np.empty((case.t.size, 3, *starts.shape[1:]))
    out[0] = state[:3]
    for k in turns[:-1]:
        begin, middle, end = drives[k : k + 3]
        k1 = _slope(state, begin, given)
        k2 = _slope(state + h / 2 * k1, middle, given)
        k3 = _slope(state + h / 2 * k2, middle, given)
        k4 = _slope(state + h * k3, end, given)
        state = state + h / 6 * (k1 + 2 * (k2 + k3) + k4)
        if (k // 2 + 1) % _FINE == 0:
            out[(k // 2 + 1) // _FINE] = state[:3]
    return out


def minimum(case: Case) -> Minimum:
    """By Gauss-Newton from the truth."""
    p, starts = TRUE.copy(), _guessed(case, 1)
    for _ in range(4):
        starts = _better_starts(case, p[:, None], starts)[1]
    starts, hessian, cost = starts[:, :, 0], np.eye(p.size), np.inf
    for _ in range(4):
        cost, gradient, hessian, starts_now, follow = _linearised(case, p, starts)
        step = -np.linalg.solve(hessian, gradient)
        starts = starts_now + follow @ step
        p = p + TRUE * step
    return Minimum(p, cost, np.linalg.inv(hessian))


def costs(case: Case, p: Array) -> Array:
    """The least chi-square at each p (many, 6), each recording in its best start; inf if none."""
    starts = _guessed(case, len(p))
    cost = np.full(len(p), np.inf)
    with np.errstate(all="ignore"):
        for _ in range(6):
            cost, starts = _better_starts(case, p.T, starts)
    return np.where(np.isfinite(cost), cost, np.inf)


def same(cost: Array, best: float) -> NDArray[np.bool_]:
    """Whether each is the same minimum."""
    return np.asarray(cost) <= best * (1 + _SAME)


def _slope(state: Array, drive: Array, p: Array) -> Array:
    return np.stack(np.broadcast_arrays(*rates(state, drive, p, np.sin, np.cos)))


def _guessed(case: Case, many: int) -> Array:
    guesses = np.array([guessed_start(case, run) for run in range(len(case.gaits))]).T
    return np.repeat(guesses[:, :, None], many, axis=2)


def _residuals(case: Case, p: Array, starts: Array) -> Array:
    """In sigmas (n, 3, runs, many); those of phi no parameter changes."""
    seen = case.values[:, :, :3].transpose(1, 2, 0)[..., None]
    return (predicted(case, p, starts) - seen) / np.array(case.sigma[:3])[:, None, None]


def _angle_cost(case: Case) -> float:
    drives = np.array([commanded(gait, case.t)[0] for gait in case.gaits])
    return float(np.sum(((drives - case.values[:, :, 3]) / case.sigma[3]) ** 2))


def _better_starts(case: Case, p: Array, starts: Array) -> tuple[Array, Array]:
    """The cost at the starts, and better ones; by x, y and psi the motion's slopes are known."""
    many = p.shape[1]
    shifted = starts.copy()
    shifted[3] += _STEP
    both = _residuals(case, np.tile(p, 2), np.concatenate([starts, shifted], axis=2))
    r, by_v = both[..., :many], (both[..., many:] - both[..., :many]) / _STEP
    sigma = np.array(case.sigma[:3])[:, None, None]
    place = r * sigma + case.values[:, :, :3].transpose(1, 2, 0)[..., None]
    J = np.zeros((*r.shape, 4))
    J[:, 0, ..., 0] = J[:, 1, ..., 1] = 1
    J[:, 0, ..., 2] = -(place[:, 1] - starts[1])
    J[:, 1, ..., 2] = place[:, 0] - starts[0]
    J[:, 2, ..., 2] = 1
    J[..., :3] /= sigma[..., None]
    J[..., 3] = by_v
    g = np.einsum("ncrms,ncrm->rms", J, r)
    H = np.einsum("ncrms,ncrmt->rmst", J, J)
    step = -np.linalg.solve(H, g[..., None])[..., 0]
    return np.sum(r**2, axis=(0, 1, 2)) + _angle_cost(case), starts + step.transpose(2, 0, 1)


def _linearised(case: Case, p: Array, starts: Array):
    """Cost, gradient and Hessian by p/TRUE; the best starts now, and how they follow p."""
    columns = p.size + 4
    scale = np.concatenate([TRUE, np.ones(4)])
    every, moved = np.tile(p[:, None], 2 * columns + 1), np.tile(starts[..., None], 2 * columns + 1)
    for k in range(columns):
        for side, sign in enumerate((1, -1)):
            at = 1 + 2 * k + side
            if k < p.size:
                every[k, at] += sign * _STEP * scale[k]
            else:
                moved[k - p.size, :, at] += sign * _STEP
    r = _residuals(case, every, moved)
    J = (r[..., 1::2] - r[..., 2::2]) / (2 * _STEP)
    at, cost = r[..., 0], float(np.sum(r[..., 0] ** 2)) + _angle_cost(case)
    gradient, hessian = np.zeros(p.size), np.zeros((p.size, p.size))
    shift, follow = np.empty_like(starts), np.empty((4, starts.shape[1], p.size))
    for run in range(starts.shape[1]):
        whole = J[:, :, run].reshape(-1, columns)
        by_p, by_start, r_run = whole[:, : p.size], whole[:, p.size :], at[:, :, run].ravel()
        solved = np.linalg.lstsq(by_start, np.column_stack([r_run, by_p]), rcond=None)[0]
        shift[:, run], follow[:, run] = -solved[:, 0], -solved[:, 1:]
        left = by_p - by_start @ solved[:, 1:]
        gradient += left.T @ r_run
        hessian += left.T @ by_p
    return cost, gradient, hessian, starts + shift, follow
