"""The circles of Fig. 6, and the paper's statements on turning."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Problem
from rr_opt.model.robot import Robot
from rr_opt.motion.circle import Circle, circle_of
from rr_opt.motion.rollout import Trajectory, rollout
from rr_opt.motion.steady_cycle import steady_cycle as simulated_cycle
from rr_opt.verify.speeds import speeds
from rr_opt.verify.turn_chart import RadiusClaim, SignClaim, radius_claim, sign_claim, turn_map
from rr_paper.prototype import ABOUT_P
from rr_paper.publication import FIGURE_6

_NEAREST = 0.97
"""How near an angle comes to the singular one."""
_RATE = 50.0
_MAP = (24, 10, 101)
"""Amplitudes, periods and offsets of the map, as in `rr-opt turn-chart`."""
_OFFSETS = 400


@dataclass(frozen=True)
class GaitCircle:
    """A gait of Fig. 6: its steady circle, that of the mirrored gait, and one lap from rest."""

    gait: SineGait
    circle: Circle
    mirrored: Circle
    driven: Trajectory


@dataclass(frozen=True)
class Turning:
    """Fig. 6 and its claims.

    circles     the three of the figure
    offset, curvature  along phi0 > 0 at the figure's amplitude and period, up to the singular
                posture: rad, 1/m (positive to the left)
    sign, radius  the claims over all gaits of the shipped problem that keep its limits
    """

    circles: tuple[GaitCircle, ...]
    offset: Array
    curvature: Array
    sign: SignClaim
    radius: RadiusClaim

    @property
    def sides_hold(self) -> bool:
        """The three turn to one side, and the mirrored gaits to the other."""
        first = np.sign(self.circles[0].circle.heading)
        return all(
            np.sign(one.circle.heading) == first and np.sign(one.mirrored.heading) == -first
            for one in self.circles
        )

    @property
    def radii_hold(self) -> bool:
        """Of the three, a larger offset has a smaller radius."""
        radii = [one.circle.radius for one in self.circles]
        return radii == sorted(radii, reverse=True)

    @property
    def changes_side_at(self) -> float | None:
        """The offset at which the turn first changes sides, rad; None if it never does."""
        changed = np.flatnonzero(np.sign(self.curvature[1:]) != np.sign(self.curvature[0]))
        return float(self.offset[changed[0] + 1]) if len(changed) else None

    @property
    def tightest_at(self) -> float:
        """The offset at which the radius stops falling, rad; the last one if it never does."""
        size = np.abs(self.curvature)
        falls = np.flatnonzero(size[1:] < size[:-1])
        return float(self.offset[falls[0]] if len(falls) else self.offset[-1])


def audit_turning(problem: Problem) -> Turning:
    """Drive the circles of Fig. 6 and test the claims on the shipped problem's gaits."""
    robot = ABOUT_P.build(problem.robot, FIGURE_6.ratio)
    alpha, T = FIGURE_6.amplitude, FIGURE_6.period
    circles = tuple(_circle(robot, SineGait(alpha, T, phi0)) for phi0 in FIGURE_6.offsets)
    end = _NEAREST * robot.singular_angle - alpha
    offset = np.linspace(0.0, end, _OFFSETS + 1)[1:]
    seen = speeds(Problem(robot, problem.limits), alpha, T, offset)
    there = seen.converged
    curvature = seen.turn[there] / (T * np.abs(seen.speed[there]))
    chart = turn_map(problem, _MAP)
    return Turning(circles, offset[there], curvature, sign_claim(chart), radius_claim(chart))


def _circle(robot: Robot, gait: SineGait) -> GaitCircle:
    other = SineGait(gait.amplitude, gait.period, -gait.offset)
    circle, mirrored = (circle_of(simulated_cycle(robot, one).cycle) for one in (gait, other))
    seconds = circle.time_round + 5 * gait.period
    return GaitCircle(gait, circle, mirrored, rollout(robot, gait, seconds, "rest", _RATE))
