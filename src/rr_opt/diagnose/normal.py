"""One run's least-squares problem, linearised, with the run's own start taken out.

With r the residuals in sigmas, Jv their derivatives by the shared quantities and Js by the run's
start, the start that fits best for any change d of the quantities is known, and what is left is

    |r|^2 - b'..  + 2 g'd + d'H d,     H = Jv'Jv - Jv'Js (Js'Js)^-1 Js'Jv

so runs add up, can be left out one at a time, and quantities can be taken in or left out, all
without going back to the data.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from rr_opt.diagnose.model import Array

_RIDGE = 1e-9
"""Of the largest diagonal entry: a start that these data do not see stays where it is."""


@dataclass(frozen=True)
class Quadratic:
    """cost + 2 g'd + d'H d at a change d (nv,) of the scaled quantities; g (nv,), H (nv, nv)."""

    cost: float
    g: Array
    H: Array

    def at(self, d: Array) -> float:
        """The cost after a change of the quantities."""
        return float(self.cost + 2 * self.g @ d + d @ self.H @ d)


@dataclass(frozen=True)
class Normal(Quadratic):
    """|residuals|^2 after the best start, which is start + shift + follow @ d."""

    shift: Array
    follow: Array


def total(parts: Iterable[Quadratic], prior: Array, u: Array) -> Quadratic:
    """The parts at u (nv,), and u' prior u of what was known; prior (nv, nv), or its diagonal."""
    prior = np.diag(prior) if prior.ndim == 1 else prior
    known = prior @ u
    every = (*parts, Quadratic(float(u @ known), known, prior))
    return Quadratic(
        sum(one.cost for one in every),
        np.sum([one.g for one in every], axis=0),
        np.sum([one.H for one in every], axis=0),
    )


def normal_of(gram: Array, begun: Array, known: Array) -> Normal:
    """Reduce J'J, J = [Js | Jv | r] in sigmas, with (ns + nv + 1) columns.

    begun  (ns,) the start, in what is known of it; known (ns,) how much a unit of it is in that
    """
    S, ns = gram.copy(), begun.size
    S[np.diag_indices(ns)] += known**2
    S[:ns, -1] += known * begun
    S[-1, :ns] += known * begun
    S[-1, -1] += begun @ begun
    A = S[:ns, :ns]
    size = np.sqrt(np.maximum(np.diag(A), 1e-300))
    scaled = A / np.outer(size, size)
    unseen = np.diag(A) <= _RIDGE * np.diag(A).max()
    scaled[unseen, :] = scaled[:, unseen] = 0.0
    scaled[np.diag_indices(ns)] = np.where(unseen, 1.0, np.diag(scaled) + 1e-12)
    C = S[:ns, ns:] * (~unseen)[:, None]
    solved = np.linalg.solve(scaled, C / size[:, None]) / size[:, None]
    left = S[ns:, ns:] - C.T @ solved
    left = (left + left.T) / 2
    return Normal(
        cost=max(float(left[-1, -1]), 0.0),
        g=left[:-1, -1],
        H=left[:-1, :-1],
        shift=-solved[:, -1],
        follow=-solved[:, :-1],
    )


def bounded_step(H: Array, g: Array, damping: float, u: Array, low: Array, high: Array) -> Array:
    """Minimise 2 g'd + d'Hd inside the box: what would leave it is held at its edge."""
    n = g.size
    d = np.zeros(n)
    free = np.ones(n, bool)
    damped = H + np.diag(damping * np.diag(H) + 1e-10 * (1 + np.diag(H)))
    for _ in range(n + 1):
        if not free.any():
            break
        rhs = -(g[free] + damped[np.ix_(free, ~free)] @ d[~free])
        d[free] = np.linalg.solve(damped[np.ix_(free, free)], rhs)
        over = free & ((u + d < low - 1e-12) | (u + d > high + 1e-12))
        if not over.any():
            break
        d[over] = np.where(u + d < low, low - u, high - u)[over]
        free &= ~over
    return d
