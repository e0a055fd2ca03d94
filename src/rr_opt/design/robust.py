"""The gait that is fast across the robot's uncertainty: by second-order expansion.

The logarithms of the uncertain parameters are normal and independent. Along each of them the speed
is the parabola through its values at the nominal robot and at +-1 standard deviation, which gives
mean, variance and skewness; the Cornish-Fisher expansion turns these into a quantile of the
speed. The torque limit is kept by the same share of robots: the torque is scaled by the quantile of
a high-power mean of it. Interactions between parameters are neglected. So the speed is a smooth
function of the gait, and is climbed as the nominal one is. Robots drawn at random show how accurate
the expansion is.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.array import Array
from rr_opt.design.candidate import Finds, distinct
from rr_opt.design.decisions import Setting, decisions, robot_of, scanned, settings_of
from rr_opt.design.landscape import Cycles, Landscape
from rr_opt.design.maximize_speed import Optimum
from rr_opt.design.seeds import tops
from rr_opt.design.sines import WAYS, refine_sine, solve_sine
from rr_opt.design.terrain import Terrain
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Problem, Spreads
from rr_opt.model.robot import Robot
from rr_opt.motion.steady_cycle import steady_cycle

RELIABLE, _NORMAL = 0.95, 1.6448536269514722
"""The share of robots that reach a speed, and the corresponding number of standard deviations of a
normal distribution."""
_POWER = 16
"""Power of the mean that stands for the peak torque."""


@dataclass(frozen=True)
class RobustGait:
    """The gait of greatest 5 % quantile of speed over the robots.

    speed     reached by 95 % of the robots, m/s, negative backward, by the expansion
    nominal   its speed on the nominal robot
    robot     the nominal robot, with the ratio that goes with the gait
    """

    gait: SineGait
    speed: float
    nominal: float
    robot: Robot


class _Spread(Landscape):
    """The gaits of uncertain robots: 95 % of them reach the speed, which is 0 where they differ in
    direction; 95 % of them stay below the torque."""

    def __init__(self, setting: Setting, spreads: Spreads):
        problem, choice = setting.problem, setting.problem.inertia_ratio
        by = choice.by if choice else "inertia"
        super().__init__(
            setting.dynamics, problem.robot, by, setting.landscape.loads, setting.ballast
        )
        self._spreads = spreads.of(setting.dynamics.parameters)
        self._off: tuple[int, float] | None = None

    def _parameters(self, share: Array) -> list:
        values = super()._parameters(share)
        if self._off:
            which, factor = self._off
            values[which] = values[which] * factor
        return values

    def _shifted(self, gaits: Array, nodes: int, off: tuple[int, float] | None) -> Cycles:
        self._off = off
        try:
            return super().cycles(gaits, nodes)
        finally:
            self._off = None

    def cycles(self, gaits: Array, nodes: int) -> Cycles:
        """As for a Landscape, but quantiles."""
        middle = self._shifted(gaits, nodes, None)
        pairs = [
            [self._shifted(gaits, nodes, (which, math.exp(sign * spread))) for sign in (-1, 1)]
            for which, spread in self._spreads.items()
        ]
        way = np.sign(middle.speed)
        speeds = way * np.array([[one.speed for one in pair] for pair in pairs])
        loads = np.array([[_load(one) for one in pair] for pair in pairs])
        speed, load = _quantile(way * middle.speed, speeds, -1), _quantile(_load(middle), loads, 1)
        torque = middle.torque * (load / _load(middle))
        return replace(middle, speed=way * np.maximum(speed, 0.0), torque=torque)


def _load(cycles: Cycles) -> Array:
    """A smooth measure of the peak torque, without kinks where one peak overtakes another."""
    return ((cycles.torque**_POWER).mean(axis=0) + 1e-300) ** (1 / _POWER)


def _quantile(middle: Array, ends: Array, side: int) -> Array:
    """The value that 95 % are above (side -1) or below (1), (K,), from the nominal value and those
    at +-1 standard deviation, (n, 2, K)."""
    low, high = ends[:, 0], ends[:, 1]
    slopes, bends = (high - low) / 2, high + low - 2 * middle
    variance = (slopes**2 + bends**2 / 2).sum(axis=0)
    deviation = np.sqrt(np.maximum(variance, 1e-300))
    skewness = (3 * slopes**2 * bends + bends**3).sum(axis=0) / deviation**3
    quantile = side * _NORMAL + (_NORMAL**2 - 1) / 6 * skewness
    return middle + bends.sum(axis=0) / 2 + deviation * quantile


def robust_gait(optimum: Optimum, spreads: Spreads) -> RobustGait | None:
    """The robust gait of the problem that an optimum solves; None if no gait was found that most of
    the robots can perform."""
    problem: Problem = optimum.problem
    box, way = decisions(problem), WAYS[problem.direction]
    pairs = []
    for known in settings_of(problem, box):
        setting = replace(known, landscape=_Spread(known, spreads))
        inside = scanned(setting, box)
        starts = inside.physical(tops(Terrain(setting, inside, way))[0]).T.tolist()
        starts += [
            [one.gait.amplitude, one.gait.period, one.gait.offset, one.share]
            for one in optimum.optima
        ]
        for start in starts:
            pairs.append((setting, solve_sine(setting, way, np.array(start))))
    for setting, coarse in distinct(Finds(pairs).good):
        found = refine_sine(setting, coarse)
        gait, robot = found.gait, robot_of(setting, found.share)
        if isinstance(gait, SineGait) and found.feasible and found.success and found.speed:
            return RobustGait(gait, found.speed, steady_cycle(robot, gait).speed, robot)
    return None
