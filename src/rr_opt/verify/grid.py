"""The points of a sweep: a product grid of the decisions, and the lines where limits are active.

Optima tend to lie on limits, where an evenly spaced grid has hardly a point. So every grid also
contains the largest amplitude that angle and singularity allow at each offset, and the shortest
period that the rate allows at each amplitude.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.array import Array
from rr_opt.model.ballast import inertia_ratio, load_count, with_load_count
from rr_opt.model.problem import Interval, Problem, RatioChoice
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import dynamics_of

_ROUNDING = 1e-8

DECISIONS = ("amplitude", "period", "offset", "ratio")


@dataclass(frozen=True)
class Grid:
    """Values of each decision, increasing: amplitude and offset in rad, period in s, ratio
    J20/J10; ratio None: the robot as it is."""

    amplitude: Array
    period: Array
    offset: Array
    ratio: Array | None = None

    def axis(self, name: str) -> Array:
        """Values of a decision by name; one NaN for the robot as it is."""
        values = getattr(self, name)
        return np.array([math.nan]) if values is None else values

    @property
    def free(self) -> tuple[str, ...]:
        """The decisions with more than one value."""
        return tuple(name for name in DECISIONS if len(self.axis(name)) > 1)


def mirrored(problem: Problem) -> bool:
    """Whether each gait's mirror image, phi0 and -phi0, is within bounds and equivalent."""
    offset = problem.gait.offset
    symmetric = offset.low == -offset.high and problem.turn is None
    return symmetric and dynamics_of(problem.robot).mirrored


def boxes(problem: Problem) -> dict[str, Interval]:
    """The bounds of each decision. Where gaits at -phi0 are mirror images, one half of the offsets
    suffices. Ratios that cannot be realised are left out; low > high if none can."""
    gait, choice = problem.gait, problem.inertia_ratio
    offset = gait.offset
    if mirrored(problem):
        offset = Interval(0.0, offset.high)
    ratio = Interval(math.nan, math.nan)
    if choice is not None:
        ratio = _realisable(problem.robot, choice)
    return {"amplitude": gait.amplitude, "period": gait.period, "offset": offset, "ratio": ratio}


def grid_of(problem: Problem, counts: Mapping[str, int]) -> Grid:
    """The grid over the problem's own bounds, ends included.

    counts: values of each decision that is not fixed, at least 2; where only whole loads exist,
    these determine the number.
    """
    inside = boxes(problem)

    def spread(name: str) -> Array:
        box, count = inside[name], max(counts.get(name, 2), 2)
        if not box.low < box.high:
            return np.array([box.low] if box.fixed else [])
        if name == "period":
            # Ends exactly as given: rounding must not take a grid outside its bounds.
            inner = np.geomspace(box.low, box.high, count)[1:-1]
            return np.array([box.low, *inner, box.high])
        return np.linspace(box.low, box.high, count)

    ratio = None
    choice = problem.inertia_ratio
    if choice is not None:
        ratio = whole_loads(problem) if loads_are_whole(problem) else spread("ratio")
    return Grid(spread("amplitude"), spread("period"), spread("offset"), ratio)


def whole_loads(problem: Problem) -> Array:
    """The ratios within bounds that a whole number of loads gives; empty if none does."""
    choice = problem.inertia_ratio
    if choice is None:
        return np.array([])
    robot, about, loads = problem.robot, choice.about, choice.loads
    ends = (choice.bounds.low, choice.bounds.high)
    low, high = (load_count(robot, ratio, about, loads) for ratio in ends)
    count = range(math.ceil(max(low, 0.0) - 1e-9), math.floor(high + 1e-9) + 1)
    return np.array([inertia_ratio(_loaded(robot, choice, k), about) for k in count])


def free_decisions(problem: Problem) -> tuple[str, ...]:
    """The decisions whose number of values can be chosen."""
    inside = boxes(problem)
    free = [name for name in DECISIONS if inside[name].low < inside[name].high]
    if loads_are_whole(problem) and "ratio" in free:
        free.remove("ratio")
    return tuple(free)


def loads_are_whole(problem: Problem) -> bool:
    """Whether only whole loads exist."""
    choice = problem.inertia_ratio
    return choice is not None and choice.by == "loads" and choice.loads.whole


def reach(problem: Problem) -> float:
    """Largest |phi| that the limits on angle and singularity allow, rad; -inf if none."""
    robot, limits = problem.robot, problem.limits
    cosine = (limits.singularity - robot.platform2.c) / robot.platform1.c
    if cosine > 1:
        return -math.inf
    return min(limits.angle, math.acos(cosine) if cosine > -1 else math.inf)


def points(problem: Problem, grid: Grid) -> tuple[Array, Array, Array, Array]:
    """Amplitude, period, offset and ratio of all points: (A, F, R, B) each, by amplitude, offset,
    ratio and period; amplitudes and periods increase, and NaN marks a missing point.

    The lines where limits are active are added as far as they lie between the grid's ends.
    """
    far, rate = reach(problem), problem.limits.rate
    alpha, phi0, T = grid.amplitude, grid.offset, grid.period
    if len(phi0) > 1:
        edges = [sign * (far - one) for one in alpha[[0, -1]] for sign in (-1, 1)]
        phi0 = np.union1d(phi0, _between(np.array(edges), phi0))
    if len(alpha) > 1:
        corners = _between(rate * T[[0, -1]] / (2 * math.pi), alpha)
        alpha = np.union1d(alpha, corners)
        edge = _between_or_nan(far - np.abs(phi0), alpha)
        alphas = np.sort(np.concatenate([np.tile(alpha[:, None], len(phi0)), edge[None]]), axis=0)
    else:
        alphas = np.tile(alpha[:, None], len(phi0))
    shape = (len(alphas), len(phi0), len(grid.axis("ratio")))
    amplitude = np.broadcast_to(alphas[:, :, None, None], (*shape, 1))
    period = np.broadcast_to(T, (*shape, len(T)))
    if len(T) > 1 and rate < math.inf:
        line = _between_or_nan(2 * math.pi * amplitude / rate, T)
        period = np.sort(np.concatenate([period, line], axis=-1), axis=-1)
    offset = phi0[:, None, None]
    ratio = grid.axis("ratio")[:, None]
    amplitude, period, offset, ratio = np.broadcast_arrays(amplitude, period, offset, ratio)
    there = ~np.isnan(amplitude)
    if problem.command and problem.bounds_command:
        low, high = problem.command.joint_amplitude(period)
        there &= (amplitude >= low * (1 - _ROUNDING)) & (amplitude <= high * (1 + _ROUNDING))
    return amplitude, np.where(there, period, np.nan), offset, ratio


def _between_or_nan(values: Array, axis: Array) -> Array:
    return np.where((values > axis[0]) & (values < axis[-1]), values, np.nan)


def _between(values: Array, axis: Array) -> Array:
    return values[(values > axis[0]) & (values < axis[-1])]


def _loaded(robot: Robot, choice: RatioChoice, count: int) -> Robot:
    return replace(robot, platform2=with_load_count(robot.platform2, choice.loads, count))


def _realisable(robot: Robot, choice: RatioChoice) -> Interval:
    """The part of the ratio's bounds that loads, or an inertia I2 > 0, can realise."""
    if choice.by == "loads":
        least = inertia_ratio(robot, choice.about)
    else:
        # I2 > 0 by a margin far below any real platform.
        weightless = replace(robot, platform2=replace(robot.platform2, I=0.0))
        least = inertia_ratio(weightless, choice.about) + 1e-6
    return Interval(max(choice.bounds.low, least), choice.bounds.high)
