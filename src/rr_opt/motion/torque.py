"""The servo's torque along a motion, before and after each jump of its acceleration."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rr_opt.physics.dynamics import dynamics_of
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import Robot

Array = NDArray[np.float64]

_JUST = 1e-6
"""How far before a jump its left side is looked at, in lengths of a piece."""


def torque_after(robot: Robot, gait: Gait, t: Array, v: Array) -> Array:
    """Torque on platform 2, N m, at times t (N,) in s with speeds v (N,) in m/s."""
    return _torque(robot, gait, t, v, gait.acceleration(t))


def torque_before(robot: Robot, gait: Gait, t: Array, v: Array) -> Array:
    """The same with the acceleration just before t, which differs where it jumps at t."""
    just_before = t - _JUST * gait.period / gait.pieces
    return _torque(robot, gait, t, v, gait.acceleration(just_before))


def _torque(robot: Robot, gait: Gait, t: Array, v: Array, acceleration: Array) -> Array:
    dynamics = dynamics_of(robot)
    values = np.tile(dynamics.values(robot)[:, None], len(t))
    inputs = (v[None], gait.angle(t)[None], gait.rate(t)[None], acceleration[None], values)
    return np.asarray(dynamics.motion(*inputs)[3]).ravel()
