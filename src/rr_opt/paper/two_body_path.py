"""The two bodies driven for some time: their index-reduced equations, integrated by scipy."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from rr_opt.paper.two_bodies import accelerate, axes, constraints, placed
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import Robot

Array = NDArray[np.float64]

_TIGHT = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-11}


class Path(NamedTuple):
    """A motion at times t (s): x, y of P (m), psi (rad), v (m/s, along platform 1); and what the
    integration let the constraints drift by: m of the joint, m/s of the axles, rad of the servo."""

    t: Array
    x: Array
    y: Array
    psi: Array
    v: Array
    drift: float


def path(robot: Robot, gait: Gait, v0: float, times: Array) -> Path:
    """The motion from v(0) = v0 at the times (s, increasing from 0)."""
    q, qd = placed(robot, float(gait.angle(0.0)), float(gait.rate(0.0)), v0)

    def slope(t: float, state: Array) -> Array:
        found = accelerate(robot, state[:6], state[6:], float(gait.acceleration(t)))
        return np.concatenate([state[6:], found.acceleration])

    start = np.concatenate([q, qd])
    states = solve_ivp(slope, times[[0, -1]], start, t_eval=times, **_TIGHT).y
    one, two = robot.platform1, robot.platform2
    (e1, _), (e2, _) = axes(states[2]), axes(states[5])
    joint = states[:2] - (one.c - one.a) * e1
    drift = [
        np.abs(joint - states[3:5] - (two.c - two.a) * e2).max(),
        np.abs(states[5] - states[2] - gait.angle(times)).max(),
        max(np.abs(constraints(robot, q) @ qd)[2:4].max() for q, qd in
            zip(states[:6].T, states[6:].T, strict=True)),
    ]  # fmt: skip
    v = (e1 * states[6:8]).sum(axis=0)
    return Path(times, joint[0], joint[1], states[2], v, float(max(drift)))
