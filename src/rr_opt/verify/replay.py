"""Replay: the winner, simulated by cvodes at tight tolerance, as if nothing were known of it.

The steady cycle is found anew, the speed measured from P's path, and every limit looked at
between the optimiser's nodes too, and on both sides of every jump of the torque.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from rr_opt.motion.steady_cycle import SteadyCycle, reference_cycle
from rr_opt.problem import Limits
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import Robot

_BETWEEN = 16
"""Points among which a peak is looked for, for each sample of the cycle."""


@dataclass(frozen=True)
class Replay:
    """What the simulation says.

    speed      m/s, signed
    error      |speed - claimed| / |claimed|
    reached    extreme of each limited quantity over the cycle: rate (rad/s), angle (rad),
               torque (N m), singularity (least S1, m)
    excess     by how much the worst limit is broken, relative to it; negative if all are kept
    """

    speed: float
    error: float
    reached: dict[str, float]
    excess: float
    steady: SteadyCycle


def replay(robot: Robot, gait: Gait, limits: Limits, claimed: float) -> Replay:
    """Simulate the steady cycle of a gait and hold it against the claim and the limits.

    Raises NotConvergedError if the gait has no steady cycle.
    """
    steady = reference_cycle(robot, gait)
    dense = np.linspace(0.0, gait.period, _BETWEEN * (len(steady.t) - 1) + 1)
    phi = gait.angle(dense)
    S1 = robot.platform1.c * np.cos(phi) + robot.platform2.c
    reached = {
        "rate": float(np.abs(gait.rate(dense)).max()),
        "angle": float(np.abs(phi).max()),
        "torque": _peak_torque(steady),
        "singularity": float(S1.min()),
    }
    excess = max(
        *(reached[name] / getattr(limits, name) - 1 for name in ("rate", "angle", "torque")),
        1 - reached["singularity"] / limits.singularity,
    )
    return Replay(steady.speed, abs(steady.speed - claimed) / abs(claimed), reached, excess, steady)


def _peak_torque(steady: SteadyCycle) -> float:
    """Largest |torque|: a spline on each piece, from just after a jump to just before the next."""
    pieces = steady.gait.pieces
    each = (len(steady.t) - 1) // pieces
    inside = steady.torque[:-1].reshape(pieces, each)
    ends = steady.torque_before[each::each, None]
    at = np.arange(each + 1)
    spline = CubicSpline(at, np.hstack([inside, ends]), axis=1)
    return float(np.abs(spline(np.linspace(0, each, _BETWEEN * each + 1))).max())
