"""From rest to the steady cycle: how fast the deviation dies, and what it costs.

A deviation dv from the steady cycle obeys d(dv)/dt = (d vdot/dv) dv, so each period multiplies
it by the same factor s = dv(T)/dv(0). Where friction is not viscous this is so once dv is small.

What is lost is told along the mean path. Over one period P moves, in the frame that turns
steadily with that period, by the mean velocity V times T; in the steady cycle |V| is the speed
along the circle. So a period from rest falls behind by T (|V| - V_rest . V/|V|), which is summed
until it has died; what is left then is a geometric series.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import simpson

from rr_opt.motion.integrator import fixed_steps
from rr_opt.motion.steady_cycle import SteadyCycle
from rr_opt.robot.parameters import Robot

Array = NDArray[np.float64]

_STEPS = 512
_DEAD = 1e-4
_MOST = 2000
"""Periods summed at most: the geometric series takes over wherever the sum ends."""


@dataclass(frozen=True)
class Transient:
    """How a start from rest, with the command running from phase 0, comes to the steady cycle.

    factor    by which a period multiplies a small deviation; 0 < factor < 1
    constant  time in which it falls to 1/e, s
    lost      distance by which the robot falls behind one that is steady from t = 0, m
    delay     the same in time, s: lost over the steady speed
    """

    factor: float
    constant: float
    lost: float
    delay: float

    def periods_to(self, share: float) -> int:
        """After how many periods a deviation is down to this share of itself."""
        return max(math.ceil(math.log(share) / math.log(self.factor)), 0)


def transient(robot: Robot, steady: SteadyCycle) -> Transient:
    """The start from rest of a gait whose steady cycle is known."""
    period = steady.gait.period
    goal = fixed_steps(robot, steady.gait, float(steady.v[0]), steps=_STEPS)
    factor = float(goal[4, -1])
    along = _mean_velocity(goal, period)
    speed = float(np.hypot(*along))
    lost = shortfall = 0.0
    v0 = 0.0
    for _ in range(_MOST):
        path = fixed_steps(robot, steady.gait, v0, steps=_STEPS)
        shortfall = period * float(speed - _mean_velocity(path, period) @ along / speed)
        lost += shortfall
        v0 = float(path[0, -1])
        if abs(shortfall) <= _DEAD * abs(lost):
            break
    lost += shortfall * factor / (1 - factor)
    return Transient(factor, -period / math.log(factor), lost, lost / speed)


def _mean_velocity(path: Array, period: float) -> Array:
    """Mean velocity of P (2,), m/s, in the frame that turns steadily through this period, from
    the heading at its start. path (5, N + 1): the states, at equal steps."""
    _, psi, x, y, _ = path
    turn = psi[-1] - psi[0]
    theta = np.linspace(0.0, 1.0, path.shape[1])
    turned = turn * theta + psi[0]
    x, y = x - x[0], y - y[0]
    cos, sin = np.cos(turned), np.sin(turned)
    # By parts: Rot(-turned) dP integrates to its end value plus turn times a quarter turn of
    # the mean of Rot(-turned) P.
    seen = np.array([cos * x + sin * y, cos * y - sin * x])
    mean_x, mean_y = (simpson(part, x=theta) for part in seen)
    return (seen[:, -1] + turn * np.array([-mean_y, mean_x])) / period
