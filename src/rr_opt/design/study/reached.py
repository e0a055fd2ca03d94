"""How far an optimum goes: the extremes that limits bound, seen between samples too."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from scipy.interpolate import CubicSpline

from rr_opt.motion.steady_cycle import SteadyCycle
from rr_opt.problem import Limits
from rr_opt.robot.parameters import Robot

_BETWEEN = 16
"""Points among which a peak is looked for, for each sample of the cycle."""

UNITS = {"angle": "rad", "rate": "rad/s", "torque": "N m", "singularity": "m"}
"""Of each limit, by its name in the problem."""


def reached(robot: Robot, steady: SteadyCycle) -> dict[str, float]:
    """The extreme of what each limit bounds, SI: largest |phi|, |dphi/dt|, |torque|, least S1."""
    gait = steady.gait
    return {
        "angle": gait.peak_angle,
        "rate": gait.peak_rate,
        "torque": _peak_torque(steady),
        "singularity": robot.platform1.c * math.cos(gait.peak_angle) + robot.platform2.c,
    }


def worst(limits: Limits, extremes: Mapping[str, float]) -> tuple[str, float]:
    """The limit that is broken most, or kept most narrowly, and its excess relative to it."""
    excess = {
        name: limits.singularity - value if name == "singularity" else value - limit
        for name, value in extremes.items()
        if math.isfinite(limit := getattr(limits, name))
    }
    relative = {name: over / abs(getattr(limits, name)) for name, over in excess.items()}
    name = max(relative, key=lambda one: relative[one])
    return name, relative[name]


def _peak_torque(steady: SteadyCycle) -> float:
    """Largest |torque|: a spline on each piece, from just after a jump to just before the next."""
    pieces = steady.gait.pieces
    each = (len(steady.t) - 1) // pieces
    inside = steady.torque[:-1].reshape(pieces, each)
    spline = CubicSpline(
        np.arange(each + 1), np.hstack([inside, steady.torque_before[each::each, None]]), axis=1
    )
    return float(np.abs(spline(np.linspace(0, each, _BETWEEN * each + 1))).max())
