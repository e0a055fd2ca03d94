"""Speed and peak torque of any number of gaits, each from as many samples as it needs."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rr_opt.physics.dynamics import derive, dynamics_of
from rr_opt.problem import Problem
from rr_opt.robot.ballast import with_inertia_ratio
from rr_opt.robot.parameters import Robot
from rr_opt.verify.resolve import least_S1, resolved
from rr_opt.verify.steady import Speeds
from rr_opt.verify.steady_fourier import SteadyFourier

__all__ = ["Speeds", "least_S1", "model_of", "robot_with", "speeds"]

Array = NDArray[np.float64]


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
    found = resolved(model_of(problem.robot), problem.robot, alpha, phi0, T, which, p, tolerance)
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
