"""Replay: the winner, simulated by cvodes at tight tolerance, as if nothing were known of it.

The steady cycle is found anew, the speed measured from P's path, and every limit looked at
between the optimiser's nodes too, and on both sides of every jump of the torque.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rr_opt.model.gait import Gait
from rr_opt.model.problem import Limits
from rr_opt.model.robot import Robot
from rr_opt.motion.steady_cycle import BETWEEN, SteadyCycle, peak_torque, reference_cycle


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
    dense = np.linspace(0.0, gait.period, BETWEEN * (len(steady.t) - 1) + 1)
    phi = gait.angle(dense)
    S1 = robot.platform1.c * np.cos(phi) + robot.platform2.c
    reached = {
        "rate": float(np.abs(gait.rate(dense)).max()),
        "angle": float(np.abs(phi).max()),
        "torque": peak_torque(steady),
        "singularity": float(S1.min()),
    }
    _, excess = limits.worst(reached)
    return Replay(steady.speed, abs(steady.speed - claimed) / abs(claimed), reached, excess, steady)
