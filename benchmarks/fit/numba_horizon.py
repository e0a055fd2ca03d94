"""Machine code by hand: Numba, this problem's own structure, a growing horizon.

No tool but what a specialist would write in a day: Runge-Kutta with forward differences by the
parameters and by the first speed; how a path moves with its place and heading is known.
Gauss-Newton inside the box over 2.5, 5, 10 and then all 20 s of the recordings.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from benchmarks.fit.case import BOX, RATE, TRUE, Array, Case, commanded, guessed_start
from benchmarks.fit.equations import rates

_HORIZONS = (2.5, 5.0, 10.0, 20.0)
_STEP = 1e-6
_TRIES, _LEAST = 30, 1e-9


def fit(case: Case, start: Array) -> Array:
    """The six parameters, from a start."""
    u = np.log(start / TRUE)
    starts = np.array([guessed_start(case, run) for run in range(len(case.gaits))])
    for horizon in _HORIZONS:
        u, starts = _fitted(case, u, starts, round(horizon * RATE))
    return TRUE * np.exp(u)


def _fitted(case: Case, u: Array, starts: Array, last: int) -> tuple[Array, Array]:
    cost, g, H, now, follow = _normal(case, u, starts, last)
    damping = 1e-3
    for _ in range(_TRIES):
        d = -np.linalg.solve(H + damping * np.diag(np.diag(H)), g)
        tried = np.clip(u + np.clip(d, -0.7, 0.7), -np.log(BOX), np.log(BOX))
        moved = now + np.einsum("rsk,k->rs", follow, tried - u)
        found = _normal(case, tried, moved, last)
        gained = cost - found[0]
        if not gained > 0:
            damping *= 10
            if damping > 1e6:
                break
            continue
        u, starts, damping = tried, moved, damping / 10
        cost, g, H, now, follow = found
        if gained < _LEAST * cost:
            break
    return u, starts


def _normal(case: Case, u: Array, starts: Array, last: int):
    """Cost, gradient and Hessian by u with the starts taken out; the best starts, how they move."""
    p, many = TRUE * np.exp(u), u.size
    every = np.tile(p, (many + 2, 1))
    every[1 : many + 1][np.diag_indices(many)] *= 1 + _STEP
    sigma = np.array(case.sigma[:3])
    cost, g, H = 0.0, np.zeros(many), np.zeros((many, many))
    now, follow = starts.copy(), np.empty((len(starts), 4, many))
    for run, begin in enumerate(starts):
        begins = np.tile(begin, (many + 2, 1))
        begins[-1, 3] += _STEP
        path = _compiled()(begins, every, _drives(case)[run][: 2 * last + 1], 1 / RATE)
        J = np.zeros((last + 1, 3, many + 5))
        J[..., :many] = (path[1:-1] - path[0]).transpose(1, 2, 0) / _STEP
        J[:, 0, many] = J[:, 1, many + 1] = J[:, 2, many + 2] = 1
        J[:, 0, many + 2] = -(path[0, :, 1] - begin[1])
        J[:, 1, many + 2] = path[0, :, 0] - begin[0]
        J[..., many + 3] = (path[-1] - path[0]) / _STEP
        J[..., many + 4] = path[0] - case.values[run, : last + 1, :3]
        flat = (J / sigma[:, None]).reshape(-1, many + 5)
        S = flat.T @ flat
        keep, out = np.r_[:many, many + 4], slice(many, many + 4)
        solved = np.linalg.solve(S[out, out], S[out][:, keep])
        left = S[np.ix_(keep, keep)] - S[keep][:, out] @ solved
        cost, g, H = cost + left[-1, -1], g + left[:-1, -1], H + left[:-1, :-1]
        now[run] -= solved[:, -1]
        follow[run] = -solved[:, :-1]
    return cost, g, H, now, follow


@lru_cache(maxsize=1)
def _drives(case: Case) -> tuple[Array, ...]:
    half = np.arange(2 * case.t.size - 1) / (2 * RATE)
    return tuple(np.ascontiguousarray(commanded(gait, half).T) for gait in case.gaits)


@lru_cache(maxsize=1)
def _compiled():
    import numba  # pyright: ignore[reportMissingImports]

    slope = numba.njit(rates)

    @numba.njit
    def paths(begins, every, drives, h):
        """x, y, psi (many, n, 3) from begins (many, 4), p (many, 6), drives (2n - 1, 3)."""
        many, n = len(begins), (len(drives) + 1) // 2
        out = np.empty((many, n, 3))
        s, ends = np.empty(4), np.empty(4)
        for k in range(many):
            s[:] = begins[k]
            out[k, 0] = s[:3]
            for i in range(n - 1):
                k1 = slope(s, drives[2 * i], every[k], np.sin, np.cos)
                for j in range(4):
                    ends[j] = s[j] + h / 2 * k1[j]
                k2 = slope(ends, drives[2 * i + 1], every[k], np.sin, np.cos)
                for j in range(4):
                    ends[j] = s[j] + h / 2 * k2[j]
                k3 = slope(ends, drives[2 * i + 1], every[k], np.sin, np.cos)
                for j in range(4):
                    ends[j] = s[j] + h * k3[j]
                k4 = slope(ends, drives[2 * i + 2], every[k], np.sin, np.cos)
                for j in range(4):
                    s[j] += h / 6 * (k1[j] + 2 * (k2[j] + k3[j]) + k4[j])
                out[k, i + 1] = s[:3]
        return out

    return paths
