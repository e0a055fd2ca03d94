"""The circle of a gait, and the transient by which a start from rest approaches it.

A small deviation dv from the steady cycle obeys d(dv)/dt = (d vdot/dv) dv, so each period
multiplies it by the same factor dv(T)/dv(0); with viscous friction a large one too.

The distance lost is measured along the mean path. Over one period P moves, in the frame that turns
steadily with that period, by T times its mean velocity V; in the steady cycle |V| is the speed
along the circle. So a period from rest falls behind by T (|V| - V_rest . V/|V|), which is summed
until the deviation has died out; the rest is a geometric series.
"""

import math
import sys
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.model.robot import Robot
from rr_opt.motion.integrators import fixed_steps
from rr_opt.motion.steady_cycle import Cycle, SteadyCycle
from rr_opt.outcome import InputError

STRAIGHT = 1e-12
"""Heading per period, rad, up to which it is rounding and the gait straight."""

_STILL = 1e-12  # m/s


@dataclass(frozen=True)
class Circle:
    """The mean circle of a gait. Positive is to the left, whichever way the robot drives.

    speed      along the mean circle, m/s, positive along platform 1
    curvature  heading per metre of the mean circle, 1/m
    heading    per period, rad
    period     s
    centre     in platform 1's axes at phase 0 with P at the origin, m; None for a straight gait
    """

    speed: float
    curvature: float
    heading: float
    period: float
    centre: tuple[float, float] | None

    @property
    def straight(self) -> bool:
        """It turns by no more than STRAIGHT per period."""
        return self.centre is None

    @property
    def radius(self) -> float:
        """m, positive; inf for a straight gait."""
        return math.inf if self.straight else abs(1 / self.curvature)

    @property
    def yaw_rate(self) -> float:
        """Heading per second, rad/s."""
        return self.heading / self.period

    @property
    def periods_round(self) -> float:
        """Periods that a full turn takes; inf for a straight gait."""
        return math.inf if self.straight else abs(2 * math.pi / self.heading)

    @property
    def time_round(self) -> float:
        """Time that a full turn takes, s; inf for a straight gait."""
        return self.periods_round * self.period


def circle_of(cycle: Cycle) -> Circle:
    """The circle that repeating a cycle makes. Raises InputError if the robot stands still."""
    if abs(cycle.speed) <= _STILL:
        raise InputError(
            f"The gait moves the robot at {cycle.speed:.1e} m/s. Expected a gait that moves it: "
            "without motion there is no circle. Give an amplitude above 0."
        )
    centre = None
    if abs(cycle.dpsi) > STRAIGHT:
        # C = dx + i dy + exp(i dpsi) C
        half = cycle.dpsi / 2
        C = complex(cycle.dx, cycle.dy) * 1j * np.exp(-1j * half) / (2 * math.sin(half))
        centre = float(C.real), float(C.imag)
    return Circle(
        speed=cycle.speed,
        # Finite and accurate however straight: only the centre goes to infinity.
        curvature=cycle.dpsi / (cycle.period * abs(cycle.speed)),
        heading=cycle.dpsi,
        period=cycle.period,
        centre=centre,
    )


_STEPS, _FEWER = 512, 128
"""Of a period: for the factor, and for each of the periods of a start from rest, whose distance
is then known to 1e-5."""
_NEGLIGIBLE = 1e-4
"""A period that adds less to the lost distance, relative, is the last that is simulated."""
_MOST_PERIODS = 1000
"""The geometric series continues from wherever the simulation ends."""


@dataclass(frozen=True)
class Transient:
    """How a start from rest, with the command beginning at phase 0, approaches the steady cycle.

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
        """Number of periods after which a deviation is down to this share of itself."""
        return max(math.ceil(math.log(share) / math.log(self.factor)), 0)


def transient(robot: Robot, steady: SteadyCycle) -> Transient:
    """The transient from rest to a known steady cycle."""
    period = steady.gait.period
    path = fixed_steps(robot, steady.gait, float(steady.v[0]), steps=_STEPS)
    # Friction that stops the robot within a small part of a period makes the factor underflow.
    factor = max(float(path[4, -1]), sys.float_info.min)
    path = fixed_steps(robot, steady.gait, float(steady.v[0]), steps=_FEWER)
    V = _mean_velocity(path, period)
    speed = abs(V)
    lost = shortfall = v0 = 0.0
    for _ in range(_MOST_PERIODS):
        path = fixed_steps(robot, steady.gait, v0, steps=_FEWER)
        along = (_mean_velocity(path, period) * V.conjugate()).real / speed
        shortfall = period * (speed - along)
        lost += shortfall
        v0 = float(path[0, -1])
        if abs(shortfall) <= _NEGLIGIBLE * abs(lost):
            break
    lost += shortfall * factor / (1 - factor)
    return Transient(factor, -period / math.log(factor), lost, lost / speed)


def _mean_velocity(path: Array, period: float) -> complex:
    """Mean velocity of P, m/s, in the frame that turns steadily through this period from the
    heading at its start. path (5, N + 1): states at equal steps."""
    from scipy.integrate import simpson  # half a second that few commands need

    _, psi, x, y, _ = path
    turn = psi[-1] - psi[0]
    theta = np.linspace(0.0, 1.0, path.shape[1])
    P = np.exp(-1j * (turn * theta + psi[0])) * (x - x[0] + 1j * (y - y[0]))
    # By parts: exp(-i turned) dP integrates to the end value of P in the turning frame plus
    # i turn times its mean.
    mean = simpson(P.real, x=theta) + 1j * simpson(P.imag, x=theta)
    return complex((P[-1] + 1j * turn * mean) / period)
