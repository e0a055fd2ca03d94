"""Replay: the winner, simulated by CVODES at tight tolerance, independently of the optimiser.

The steady cycle is recomputed, the speed measured from P's path, and every limit checked between
the optimiser's nodes too, and on both sides of every torque jump. A turn is replayed for many
periods on its circle, and from rest.
"""

import math
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.model.gait import Gait
from rr_opt.model.problem import CANCELLED, Limits
from rr_opt.model.robot import Robot
from rr_opt.motion.circle import Transient, circle_of, transient
from rr_opt.motion.integrators import cvodes
from rr_opt.motion.steady_cycle import (
    BETWEEN,
    Cycle,
    SteadyCycle,
    cycle_of,
    energy,
    grip_needed,
    peak_torque,
    reference_cycle,
    steady_cycle,
)


@dataclass(frozen=True)
class Replay:
    """The result of the simulation.

    speed      m/s, signed
    error      |speed - claimed| / |claimed|
    allowance  factor on the tolerance of the error: CANCELLED times the largest speed along the
               cycle over |claimed|, at least 1
    reached    extreme of each limited quantity over the cycle: rate (rad/s), angle (rad),
               torque (N m), singularity (least S1, m), grip (largest of both axles), and, where
               one of them is limited, power (W), cost_of_transport and speed (m/s)
    grip       of each axle: largest side force over the load on it
    excess     largest relative violation of a limit; negative if all are satisfied
    """

    speed: float
    error: float
    allowance: float
    reached: dict[str, float]
    excess: float
    steady: SteadyCycle
    grip: tuple[float, float]


def replay(robot: Robot, gait: Gait, limits: Limits, claimed: float) -> Replay:
    """Simulate the steady cycle of a gait and compare it with the claim and the limits.

    Raises NotConvergedError if the gait has no steady cycle.
    """
    steady = reference_cycle(robot, gait)
    dense = np.linspace(0.0, gait.period, BETWEEN * (len(steady.t) - 1) + 1)
    phi = gait.angle(dense)
    S1 = robot.platform1.c * np.cos(phi) + robot.platform2.c
    grip = grip_needed(steady, robot)
    reached = {
        "rate": float(np.abs(gait.rate(dense)).max()),
        "angle": float(np.abs(phi).max()),
        "torque": peak_torque(steady),
        "singularity": float(S1.min()),
        "grip": max(grip),
    }
    if limits.economy:
        spent = energy(robot, steady)
        reached |= {"power": spent.power, "cost_of_transport": spent.cost_of_transport}
        reached["speed"] = abs(steady.speed)
    _, excess = limits.worst(reached)
    error = abs(steady.speed - claimed) / abs(claimed)
    allowance = max(1.0, CANCELLED * float(np.abs(steady.v).max()) / abs(claimed))
    return Replay(steady.speed, error, allowance, reached, excess, steady, grip)


PERIODS = 50
LARGEST = 1e-4
"""Largest distance from the circle, relative to its radius."""

_SAMPLES = 128
_TIGHT, _LOOSE = 1e-12, 1e-9
"""Integration tolerances: on the circle, errors of place and heading accumulate from period to
period; in the approach from rest they do not."""
_SETTLED, _LONGEST = 1e-8, 2000
"""Residual deviation from the steady cycle at which the circle is evaluated, and most periods until
then. Where a robot turns on the spot, or hardly advances per period, a deviation changes its circle
a hundred times as much."""


@dataclass(frozen=True)
class CircleCheck:
    """The result of the simulation. Distances are relative to the claimed radius, or to the
    distance driven if shorter.

    ends       largest distance of P, at the end of a period, from its expected place
    mean       largest difference between a period's mean circle and the claimed one
    rest       the same for the last of `periods` periods from rest
    curvature  claimed, 1/m
    transient  how a start from rest approaches the circle
    """

    ends: float
    mean: float
    rest: float
    periods: int
    curvature: float
    transient: Transient

    @property
    def passed(self) -> bool:
        """It stays on the circle, and converges to it from rest."""
        return max(self.ends, self.mean, self.rest) <= LARGEST


def check_circle(robot: Robot, gait: Gait, curvature: float) -> CircleCheck:
    """Compare a claimed curvature, 1/m, with a simulation.

    Raises NotConvergedError if the gait has no steady cycle.
    """
    steady = steady_cycle(robot, gait)
    start = transient(robot, steady)
    length = abs(steady.speed) * gait.period
    radius = 1 / max(abs(curvature), 1e-300)
    x, y, psi = _driven(robot, gait, float(steady.v[0]), PERIODS, _TIGHT)
    ends = np.array([x[::_SAMPLES], y[::_SAMPLES]])
    k = np.arange(PERIODS + 1)
    off = np.hypot(*(ends - _predicted(steady.cycle, PERIODS))) / np.minimum(
        radius, length * np.maximum(k, 1)
    )
    mean = max(_off(_period(gait, x, y, psi, i), curvature) for i in range(PERIODS))
    last = min(max(PERIODS, start.periods_to(_SETTLED)), _LONGEST)
    end = _period(gait, *_driven(robot, gait, 0.0, last, _LOOSE), last - 1)
    return CircleCheck(
        ends=float(off.max()),
        mean=mean,
        rest=_off(end, curvature),
        periods=last,
        curvature=curvature,
        transient=start,
    )


def _driven(
    robot: Robot, gait: Gait, v0: float, periods: int, tolerance: float
) -> tuple[Array, Array, Array]:
    """x, y (m) and psi (rad) at _SAMPLES + 1 times a period, ends shared."""
    times = np.linspace(0.0, periods * gait.period, periods * _SAMPLES + 1)
    _, psi, x, y, _ = cvodes(robot, gait, v0, times, tolerance)
    return x, y, psi


def _period(gait: Gait, x: Array, y: Array, psi: Array, i: int) -> Cycle:
    part = slice(i * _SAMPLES, (i + 1) * _SAMPLES + 1)
    return cycle_of(gait.period, x[part], y[part], psi[part])


def _off(cycle: Cycle, curvature: float) -> float:
    """Relative difference of the radii; if the radius exceeds the distance of 50 periods,
    difference of the curvatures times that distance."""
    made = circle_of(cycle).curvature
    scale = max(abs(curvature), 1 / (PERIODS * abs(cycle.speed) * cycle.period))
    return abs(made - curvature) / scale


def _predicted(cycle: Cycle, periods: int) -> Array:
    """P at the ends of periods, (2, periods + 1): the rigid motion of one period, repeated."""
    at, heading, points = 0j, 0.0, [0j]
    for _ in range(periods):
        at += complex(cycle.dx, cycle.dy) * complex(math.cos(heading), math.sin(heading))
        heading += cycle.dpsi
        points.append(at)
    return np.array([np.real(points), np.imag(points)])
