"""How far an optimum goes: the extremes that limits bound, seen between samples too."""

from __future__ import annotations

import math

from rr_opt.motion.peaks import peak_torque
from rr_opt.motion.steady_cycle import SteadyCycle
from rr_opt.robot.parameters import Robot

UNITS = {"angle": "rad", "rate": "rad/s", "torque": "N m", "singularity": "m"}
"""Of each limit, by its name in the problem."""


def reached(robot: Robot, steady: SteadyCycle) -> dict[str, float]:
    """The extreme of what each limit bounds, SI: largest |phi|, |dphi/dt|, |torque|, least S1."""
    gait = steady.gait
    return {
        "angle": gait.peak_angle,
        "rate": gait.peak_rate,
        "torque": peak_torque(steady),
        "singularity": robot.platform1.c * math.cos(gait.peak_angle) + robot.platform2.c,
    }
