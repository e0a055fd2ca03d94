"""What the shapes of gaits share: bounds and prices of the angle and its rate."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rr_opt.design.decisions import reach_before_singularity
from rr_opt.model.problem import Interval, Problem

Symbols = Mapping[str, Any]
Values = Mapping[str, Any]


@dataclass(frozen=True)
class Bounds:
    """Bounds by name; what has no name is free.

    unknowns  of decisions, integrals, states and controls
    rows      of limits and path rows
    """

    unknowns: Mapping[str, Interval] = field(default_factory=dict)
    rows: Mapping[str, Interval] = field(default_factory=dict)


PATH = ("angle", "swing", "rate")
"""phi, phi - phi0 and dphi/dt."""


def path_bounds(problem: Problem) -> dict[str, Interval]:
    """Bounds of PATH. The singular posture is one of two angles, so its margin is one as well."""
    limits = problem.limits
    reach = min(limits.angle, reach_before_singularity(problem.robot, limits.singularity))
    swing, rate = problem.gait.amplitude.high, limits.rate
    return {
        "angle": Interval(-reach, reach),
        "swing": Interval(-swing, swing),
        "rate": Interval(-rate, rate),
    }


def path_prices(problem: Problem, multipliers: Values) -> dict[str, float]:
    """Speed gained per unit of the limits on rate, angle and singularity."""
    limits, robot = problem.limits, problem.robot
    rate, angle = (float(np.abs(multipliers[name]).sum()) for name in ("rate", "angle"))
    edge = reach_before_singularity(robot, limits.singularity)
    if limits.angle <= edge:
        return {"rate": rate, "angle": angle, "singularity": 0.0}
    # c1 cos(edge) + c2 = margin, so a wider margin brings the edge closer.
    closer = 1 / (robot.platform1.c * math.sin(edge))
    return {"rate": rate, "angle": 0.0, "singularity": -angle * closer}


def amplitude_price(first_harmonic: float, swing: Values) -> float:
    """Speed gained per unit by which the active bound of the amplitude moves up: the largest
    amplitude holds the swing, the least one the first harmonic."""
    most = float(np.abs(swing["swing"]).sum())
    return most if most > abs(first_harmonic) else float(first_harmonic)
