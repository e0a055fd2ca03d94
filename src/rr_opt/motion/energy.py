"""What a steady cycle costs: power, energy per metre of path, and the cost of transport.

The servo's power is torque * dphi/dt. Over a period the kinetic energy returns to what it was, so
the net work of a period is what friction takes. A servo that brakes does not give energy back,
though: what its supply has to provide is the positive part of the power alone, the gross work,
which is never less than the net. The cost of transport is the gross work per metre over the
robot's weight. Losses within the servo are in neither.
"""

from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.mechanics.kinematics import G
from rr_opt.model.robot import Robot
from rr_opt.motion.steady_cycle import SteadyCycle


@dataclass(frozen=True)
class Energy:
    """Per metre of the mean circle's path: gross and net work of the servo, J/m, and the cost of
    transport, dimensionless; power: the gross work per second, W."""

    gross: float
    net: float
    cost_of_transport: float
    power: float


def energy(robot: Robot, steady: SteadyCycle) -> Energy:
    """The energy of a steady cycle."""
    rate = steady.gait.rate(steady.t)
    after, before = steady.torque * rate, steady.torque_before * rate
    net = float(np.sum(after[:-1] + before[1:])) / 2
    gross = float(np.sum(_positive(after[:-1], before[1:])))
    period = steady.gait.period
    path = abs(steady.speed) * period
    step = float(steady.t[1] - steady.t[0])
    per_metre = step / path
    weight = robot.mass * G
    return Energy(
        gross * per_metre, net * per_metre, gross * per_metre / weight, gross * step / period
    )


def _positive(start: Array, end: Array) -> Array:
    """Mean of the positive part of lines from start to end, exactly where one crosses zero."""
    high, low = np.maximum(start, end), np.minimum(start, end)
    crosses = (high > 0) & (low < 0)
    above = np.where(crosses, high**2 / np.where(crosses, 2 * (high - low), 1.0), 0.0)
    return np.where(crosses, above, np.maximum((start + end) / 2, 0.0))
