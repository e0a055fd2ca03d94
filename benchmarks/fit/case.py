"""The work: six recordings of 20 s at 100 Hz, with noise, of a robot whose parameters are known.

The gaits have offsets: straight ones leave the inertias nearly unseen. The recordings are made by
an integrator of order 8 that no way of fitting uses.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from benchmarks.fit.equations import H, rates

Array = NDArray[np.float64]

TRUE = np.array([0.05 * H**2, 0.05 * H**2, 0.00386, 0.3 * 0.00386, 0.05, 0.05])
"""The parameters of the robot, in the order of `equations.PARAMETERS`."""

WITHIN, BOX = 3.0, 5.0
"""Starts are within a factor of the truth, and no fit looks outside of another."""

GAITS = ((0.5, 1.0, 0.5), (0.8, 1.6, -0.6), (0.6, 0.8, -0.8), (0.7, 1.4, 0.9),
         (0.9, 0.9, -0.3), (1.0, 1.2, 0.4))  # fmt: skip
"""Amplitude (rad), period (s) and offset (rad) of each recording."""

BEGINS = ((0.0, 0.0, 0.0, 0.05), (0.5, -0.2, 1.0, -0.05), (-0.4, 0.3, 2.0, 0.1),
          (0.2, 0.6, 3.0, 0.0), (0.0, -0.5, -1.0, 0.02), (-0.3, -0.3, -2.0, -0.1))  # fmt: skip
"""x, y (m), psi (rad) and v (m/s) in which each recording begins: none is told of them."""

SIGMA = np.array([1e-3, 1e-3, 3e-3, 3e-3])
SECONDS, RATE = 20.0, 100.0


@dataclass(frozen=True, eq=False)
class Case:
    """What a fit is given: t (n,) s, values (6, n, 4) of x, y, psi, phi, and the gaits."""

    t: Array
    values: Array
    gaits: tuple[tuple[float, float, float], ...] = GAITS
    sigma: tuple[float, ...] = tuple(SIGMA)


def commanded(gait: tuple[float, float, float], t: Array) -> Array:
    """phi, its rate and its acceleration (3, ...) at times t."""
    amplitude, period, offset = gait
    turn = 2 * np.pi / period
    sine, cosine = amplitude * np.sin(turn * t), amplitude * np.cos(turn * t)
    return np.array([sine + offset, turn * cosine, -(turn**2) * sine])


@lru_cache
def clean() -> Array:
    """What a capture system without noise would see, (6, n, 4)."""
    t = np.arange(round(SECONDS * RATE) + 1) / RATE
    out = np.empty((len(GAITS), t.size, 4))
    for k, (gait, start) in enumerate(zip(GAITS, BEGINS, strict=True)):
        moved = solve_ivp(
            lambda at, y, gait=gait: rates(y, commanded(gait, at), TRUE, np.sin, np.cos),
            (0.0, SECONDS), start, "DOP853", t, rtol=1e-11, atol=1e-12,
        )  # fmt: skip
        out[k] = np.column_stack([*moved.y[:3], commanded(gait, t)[0]])
    return out


def case(seed: int = 0) -> Case:
    """The recordings with the noise of a seed."""
    values = clean()
    noise = np.random.default_rng(seed).normal(size=values.shape) * SIGMA
    return Case(np.arange(values.shape[1]) / RATE, values + noise)


def starts(count: int, seed: int = 1) -> Array:
    """Guesses to start from (count, 6): each parameter within a factor of the truth, by its log."""
    spread = np.random.default_rng(seed).uniform(-1, 1, (count, TRUE.size))
    return TRUE * WITHIN**spread


def guessed_start(case: Case, run: int) -> Array:
    """The state that anyone would begin with: as first seen, at the first period's mean speed."""
    seen = case.values[run]
    last = round(case.gaits[run][1] * RATE)
    step = seen[last, :2] - seen[0, :2]
    heading = seen[: last + 1, 2].mean()
    v = (step @ [np.cos(heading), np.sin(heading)]) / (case.t[last] - case.t[0])
    return np.array([*seen[0, :3], v])
