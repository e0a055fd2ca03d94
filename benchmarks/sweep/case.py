"""What every way is given: a robot, the points of a sweep, and how close the speeds have to be."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rr_opt.model.ballast import inertia_ratio, with_inertia_ratio
from rr_opt.model.problem import Limits, Problem
from rr_opt.model.robot import EffectUse, Platform, Robot

Array = NDArray[np.float64]

ACCURACY = 1e-6
"""Of the average speed, relative; of less than 1 mm/s, in 1 mm/s."""

LEAST_SPEED = 1e-3

ROBOT = Robot(
    Platform(m=0.469, I=0.00386, c=0.236, a=0.05, b=0.05, kappa=0.05 * 0.02**2),
    Platform(m=0.25, I=0.3 * 0.00386, c=0.0941, a=0.05, b=0.05, kappa=0.05 * 0.02**2),
    h=0.02,
)
LIMITS = Limits(angle=2.6, rate=99.0, torque=99.0)
AMPLITUDE, PERIOD, OFFSET, RATIO = (0.05, 1.6), (0.3, 3.0), (-0.25, 0.25), (0.2, 0.6)
"""rad, s, rad, J20/J10 about the joint. All gaits keep S1 >= 20 mm from the singular posture."""

FRICTION = {
    "viscous": {},
    "quadratic": {"quadratic_drag": {"coefficient_total": 0.3}},
    "coulomb": {"coulomb_friction": {"force1": 0.01, "force2": 0.01}},
}


@dataclass(frozen=True, eq=False)
class Work:
    """Gaits of robots with one kind of friction.

    friction   a key of FRICTION
    amplitude, period, offset, ratio  (K,): rad, s, rad, J20/J10 about the joint
    periods    this many points in a row differ in their period alone
    """

    friction: str
    amplitude: Array
    period: Array
    offset: Array
    ratio: Array
    periods: int = 1

    @property
    def size(self) -> int:
        """How many points."""
        return len(self.period)

    @property
    def problem(self) -> Problem:
        """The robot with its friction."""
        uses = tuple(EffectUse(name, v) for name, v in FRICTION[self.friction].items())
        return Problem(replace(ROBOT, physics=uses), LIMITS)

    def part(self, count: int) -> Work:
        """So many of the points, drawn at random; all of them if there are no more."""
        if count >= self.size:
            return self
        return self.only(drawn(self.size, count))

    def only(self, own: NDArray[np.int_]) -> Work:
        """Some of the points."""
        values = (self.amplitude, self.period, self.offset, self.ratio)
        return Work(self.friction, *(value[own] for value in values))

    @cached_property
    def parameters(self) -> Array:
        """(15, K): m1, J1 about the axle's centre, m1 a1, c1, b1, k1, the same of platform 2, and
        what friction has beyond the viscous: force1, force2 (N), of a wheel (N s2/m2)."""
        ratios, which = np.unique(self.ratio, return_inverse=True)
        beyond = FRICTION[self.friction]
        dry = beyond.get("coulomb_friction", {"force1": 0.0, "force2": 0.0})
        drag = beyond.get("quadratic_drag", {"coefficient_total": 0.0})["coefficient_total"] / 4
        columns = []
        for ratio in ratios.tolist():
            robot = with_inertia_ratio(ROBOT, ratio)
            one, two = robot.platform1, robot.platform2
            columns.append([
                *(one.m, one.I + one.m * one.a**2, one.m * one.a, one.c, one.b, robot.k1),
                *(two.m, two.I + two.m * two.a**2, two.m * two.a, two.c, two.b, robot.k2),
                *(dry["force1"], dry["force2"], drag),
            ])  # fmt: skip
        return np.array(columns).T[:, which]


def drawn(size: int, count: int) -> NDArray[np.int_]:
    """A random subset of the given size, the same each time."""
    return np.sort(np.random.default_rng(0).choice(size, count, replace=False))


def plane(friction: str, side: int) -> Work:
    """side x side points over amplitude and period, straight gaits of the robot as it is."""
    alpha, T = np.meshgrid(
        np.linspace(*AMPLITUDE, side), np.geomspace(*PERIOD, side), indexing="ij"
    )
    still, own = np.zeros(side**2), np.full(side**2, inertia_ratio(ROBOT, "joint"))
    return Work(friction, alpha.ravel(), T.ravel(), still, own, side)


def space(friction: str, side: int) -> Work:
    """side^4 points over amplitude, offset, inertia ratio and period."""
    axes = [np.linspace(*box, side) for box in (AMPLITUDE, OFFSET, RATIO)]
    grid = np.meshgrid(*axes, np.geomspace(*PERIOD, side), indexing="ij")
    alpha, phi0, ratio, T = (part.ravel() for part in grid)
    return Work(friction, alpha, T, phi0, ratio, side)


def error(speed: Array, true: Array) -> float:
    """The largest error of |speed|, relative as ACCURACY says."""
    true = np.abs(true)
    return float(np.max(np.abs(np.abs(speed) - true) / np.maximum(true, LEAST_SPEED)))
