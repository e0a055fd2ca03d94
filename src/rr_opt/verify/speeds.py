"""Speed and peak torque of any number of gaits, each from as many samples as it needs."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rr_opt.physics.dynamics import derive, dynamics_of
from rr_opt.problem import Problem
from rr_opt.robot.ballast import with_inertia_ratio
from rr_opt.robot.parameters import Robot
from rr_opt.verify.steady_fourier import SteadyFourier

Array = NDArray[np.float64]

FEWEST, MOST = 16, 4096
"""Samples of half a period of a straight gait; of a whole period twice as many."""

_MARGIN = {True: 10.0, False: 0.01}
"""The fastest harmonics of the velocity may be so many times as large as the speed's error. It
comes from their products where friction is viscous (True); where it is not, those of the
friction count, which are stronger."""

_CHUNK = 16384
"""Samples of shapes in one go."""


class Speeds(NamedTuple):
    """Arrays of one shape; NaN where not converged.

    speed        signed, m/s
    turn         heading gained per period, rad
    peak_torque  N m
    converged    a steady cycle was found and is resolved
    """

    speed: Array
    turn: Array
    peak_torque: Array
    converged: NDArray[np.bool_]


def robot_with(problem: Problem, ratio: float | None) -> Robot:
    """The problem's robot with this J20/J10; None: as it is.

    Raises InputError for a ratio that cannot be realised.
    """
    if ratio is None:
        return problem.robot
    choice = problem.inertia_ratio
    if choice is None:
        return with_inertia_ratio(problem.robot, ratio)
    return with_inertia_ratio(problem.robot, ratio, choice.about, choice.by, choice.loads)


def model_of(robot: Robot) -> SteadyFourier:
    """The steady-cycle model for robots with the effects of this one."""
    return _model(tuple(use.name for use in robot.physics))


@lru_cache
def _model(effects: tuple[str, ...]) -> SteadyFourier:
    return SteadyFourier(derive(effects))


def speeds(
    problem: Problem,
    amplitude: ArrayLike,
    period: ArrayLike,
    offset: ArrayLike = 0.0,
    ratio: ArrayLike | None = None,
    tolerance: float = 1e-6,
) -> Speeds:
    """Speed and peak torque of gaits that need not keep any limit, in their broadcast shape.

    amplitude, offset in rad, period in s, ratio J20/J10 (None: the robot as it is).
    tolerance: of the speed, relative. Fastest where the last axis is the period's alone. NaN
    where the gait reaches the singular posture, and where the cycle is not resolved.
    """
    ratios = np.asarray(np.nan if ratio is None else ratio, float)
    inputs = [np.asarray(part, float) for part in (amplitude, offset, ratios)]
    common = np.broadcast_shapes(*(part.shape for part in inputs))
    shape = np.broadcast_shapes(common, np.shape(period))
    common = (1,) * (len(shape) - len(common)) + common
    periods = shape[-1] if shape and common[-1] == 1 else 1
    rows = shape[:-1] if periods > 1 else shape
    alpha, phi0, J = (
        np.broadcast_to(part.reshape((1,) * (len(shape) - part.ndim) + part.shape), common)
        for part in inputs
    )
    if periods > 1:
        alpha, phi0, J = (part[..., 0] for part in (alpha, phi0, J))
    alpha, phi0, J = (np.broadcast_to(part, rows).ravel() for part in (alpha, phi0, J))
    T = np.broadcast_to(np.asarray(period, float), shape).reshape(len(alpha), periods)
    which, p = _parameters(problem, None if ratio is None else J)
    found = _adaptive(problem.robot, alpha, phi0, T, which, p, tolerance)
    speed, turn, torque = (part.reshape(shape) for part in found[:3])
    return Speeds(speed, turn, torque, found.converged.reshape(shape))


def _parameters(problem: Problem, ratio: Array | None) -> tuple[NDArray[np.int_] | None, Array]:
    """The robots' parameter vectors as columns, and which of them each ratio has."""
    dynamics = dynamics_of(problem.robot)
    if ratio is None:
        return None, dynamics.values(problem.robot)[:, None]
    values, which = np.unique(ratio, return_inverse=True)
    columns = [dynamics.values(robot_with(problem, value)) for value in values.tolist()]
    p = np.array(columns).T
    return (None, p) if len(values) == 1 else (which, p)


def least_S1(robot: Robot, amplitude: ArrayLike, offset: ArrayLike) -> Array:
    """The least S1 = c1 cos phi + c2 over a gait's cycle, m."""
    reach = np.abs(np.asarray(amplitude, float)) + np.abs(np.asarray(offset, float))
    return robot.platform1.c * np.cos(np.minimum(reach, np.pi)) + robot.platform2.c


def _adaptive(
    robot: Robot,
    alpha: Array,
    phi0: Array,
    T: Array,
    which: NDArray[np.int_] | None,
    p: Array,
    tolerance: float,
) -> Speeds:
    """alpha, phi0 (G,), T (G, B), p (len, R) with column which[g] for row g."""
    model = model_of(robot)
    speed, turn, torque = (np.full(T.shape, np.nan) for _ in range(3))
    converged = np.zeros(T.shape, bool)
    asked = np.isfinite(T) & (T > 0)
    period = np.where(asked, T, 1.0)
    regular = (least_S1(robot, alpha, phi0) > 0) & asked.any(axis=1)
    needed = _samples(robot, np.abs(alpha) + np.abs(phi0))
    for straight in (True, False):
        halves = 1 if straight else 2
        pending = np.flatnonzero(regular & (((phi0 == 0) & model.mirrored) == straight))
        n = FEWEST * halves if model.viscous else 4 * FEWEST
        while len(pending) and n <= MOST * halves:
            now = pending[needed[pending] * halves <= n]
            for block in np.array_split(now, max(1, len(now) * n // _CHUNK)) if len(now) else ():
                robots = p if which is None else p[:, which[block]]
                shapes = alpha[block], phi0[block], period[block]
                found = model.cycles(*shapes, robots, n, straight, tolerance)
                good = (found.error <= _MARGIN[model.viscous] * tolerance) & asked[block]
                converged[block] = good
                for into, values in zip((speed, turn, torque), found, strict=False):
                    into[block] = np.where(good, values, np.nan)
            poor = (asked & ~converged)[pending].any(axis=1)
            pending, n = pending[poor], 2 * n
    return Speeds(speed, turn, torque, converged)


def _samples(robot: Robot, reach: Array) -> Array:
    """Samples of half a period without which a gait that goes so far is not resolved.

    The motion is analytic in the complex phase up to where alpha sin(theta) reaches the singular
    posture, y = arccosh(phi*/reach) off the real axis: its harmonics fall as exp(-k y).
    """
    ratio = robot.singular_angle / np.maximum(reach, 1e-9)
    return 6.0 / np.arccosh(np.maximum(ratio, 1 + 1e-9))
