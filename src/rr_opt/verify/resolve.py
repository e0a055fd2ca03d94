"""Speed and peak torque of gaits, each from as many samples as it needs."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rr_opt.robot.parameters import Robot
from rr_opt.verify.by_machine import MOST as MOST_BY_NEWTON
from rr_opt.verify.by_machine import SAFETY, by_newton, by_series
from rr_opt.verify.compiled_cycles import Points
from rr_opt.verify.doublings import Doublings
from rr_opt.verify.steady import Speeds
from rr_opt.verify.steady_fourier import SteadyFourier

Array = NDArray[np.float64]

FEWEST, MOST = 16, 4096
"""Samples of half a period of a straight gait; of a whole period twice as many."""

_MARGIN = 10.0
"""The fastest harmonics of the velocity may be so many times as large as the speed's error, which
comes from their products where friction is viscous. Where it is not, those of the friction are
stronger, and what doubling the samples changes is the error."""

_CHUNK = 16384
"""Samples of shapes in one go, where NumPy does it."""


def resolved(
    model: SteadyFourier,
    robot: Robot,
    alpha: Array,
    phi0: Array,
    T: Array,
    which: NDArray[np.int_] | None,
    p: Array,
    tolerance: float,
) -> Speeds:
    """alpha, phi0 (G,), rad, T (G, B), s, p (len, R) with column which[g] for row g; (G, B)."""
    speed, turn, torque = (np.full(T.shape, np.nan) for _ in range(3))
    into = Speeds(speed, turn, torque, np.zeros(T.shape, bool))
    asked = np.isfinite(T) & (T > 0)
    period = np.where(asked, T, 1.0)
    regular = (least_S1(robot, alpha, phi0) > 0) & asked.any(axis=1)
    needed = _samples(robot, np.abs(alpha) + np.abs(phi0))
    compiled = model.compiled(T.size)
    for straight in (True, False):
        halves = 1 if straight else 2
        pending = np.flatnonzero(regular & (((phi0 == 0) & model.mirrored) == straight))
        n = FEWEST * halves if model.viscous else 4 * FEWEST
        if compiled and len(pending):
            row, column = np.nonzero(asked[pending])
            at = pending[row], column
            robots = np.zeros(len(row), np.int64) if which is None else which[at[0]]
            points = Points(alpha[at[0]], phi0[at[0]], period[at], robots)
            if not model.viscous:
                by_newton(compiled, points, p, straight, n, tolerance, at, into)
                continue
            worst, fewest = _MARGIN * tolerance, needed[at[0]] * halves
            n = by_series(compiled, points, p, straight, n, fewest, worst, at, into)
            pending = pending[(asked & ~into.converged)[pending].any(axis=1)]
        doublings = Doublings(T.shape)
        most = halves * (MOST if model.viscous else MOST_BY_NEWTON)
        while len(pending) and n <= most:
            now = pending[needed[pending] * halves <= n]
            parts = min(len(now), max(1, len(now) * n // _CHUNK))
            for block in np.array_split(now, parts) if parts else ():
                robots = p if which is None else p[:, which[block]]
                shapes = alpha[block], phi0[block], period[block]
                found = model.cycles(*shapes, robots, n, straight, tolerance)
                if model.viscous:
                    good = found.error <= _MARGIN * tolerance
                else:
                    good = doublings.error(block, found) <= SAFETY * tolerance
                into.keep(block, found, good & asked[block])
            poor = (asked & ~into.converged)[pending].any(axis=1)
            pending, n = pending[poor], 2 * n
    return into


def least_S1(robot: Robot, amplitude: ArrayLike, offset: ArrayLike) -> Array:
    """The least S1 = c1 cos phi + c2 over a gait's cycle, m."""
    reach = np.abs(np.asarray(amplitude, float)) + np.abs(np.asarray(offset, float))
    return robot.platform1.c * np.cos(np.minimum(reach, np.pi)) + robot.platform2.c


def _samples(robot: Robot, reach: Array) -> Array:
    """Samples of half a period without which a gait that goes so far is not resolved.

    The motion is analytic in the complex phase up to where alpha sin(theta) reaches the singular
    posture, y = arccosh(phi*/reach) off the real axis: its harmonics fall as exp(-k y).
    """
    ratio = robot.singular_angle / np.maximum(reach, 1e-9)
    return 6.0 / np.arccosh(np.maximum(ratio, 1 + 1e-9))
