"""The steady cycle of one gait of any shape, by the sweep's model."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from rr_opt.physics.dynamics import dynamics_of
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import Robot
from rr_opt.verify.speeds import model_of

_SAMPLES, _MOST = 256, 8192
_SETTLED = 1e-6


class Given(NamedTuple):
    """speed signed, m/s, and heading gained per period, rad; error: how far the speed is known,
    relative."""

    speed: float
    turn: float
    error: float


def speed_of(robot: Robot, gait: Gait) -> Given:
    """The steady speed of a gait, from more and more samples until more change nothing.

    The acceleration of a free gait jumps; a sample at a jump has the mean of both sides, with
    which the error falls with the square of the number of samples. What twice the samples will
    then change is added. NaN where the model finds no steady cycle.
    """
    smooth = gait.pieces == 1
    before, samples = math.nan, _SAMPLES if smooth else 4 * gait.pieces
    while True:
        speed, turn = _cycle(robot, gait, samples)
        rest = 0.0 if smooth else (speed - before) / 3
        error = abs(speed - before) / abs(speed) if speed else math.inf
        if error <= _SETTLED or 2 * samples > _MOST:
            return Given(speed + rest, turn, error if smooth else error / 3)
        before, samples = speed, 2 * samples


def _cycle(robot: Robot, gait: Gait, samples: int) -> tuple[float, float]:
    t = np.arange(samples) / samples * gait.period
    bend = gait.acceleration(t)
    if gait.pieces > 1:
        bend = (bend + gait.acceleration(t - 0.25 * gait.period / samples)) / 2
    omega = 2 * math.pi / gait.period
    angle = gait.angle(t), gait.rate(t) / omega, bend / omega**2
    phi, rate, bend = (part[:, None] for part in angle)
    p = dynamics_of(robot).values(robot)[:, None]
    found = model_of(robot).along((phi, rate, bend), np.array([[gait.period]]), p, False)
    if not np.isfinite(found.error[0, 0]):
        return math.nan, math.nan
    return float(found.speed[0, 0]), float(found.turn[0, 0])
