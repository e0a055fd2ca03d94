"""The tightest circle that a robot can make within its limits."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from rr_opt.problem import Problem, Turn
from rr_opt.robot.gait import SineGait
from rr_opt.verify.speeds import least_S1
from rr_opt.verify.turn.map import ahead, open_offsets
from rr_opt.verify.turn.points import Care, Points, Turning

Array = NDArray[np.float64]

_SLACK = 1e-8
_CLOSER, _CLIMBS, _RESTARTS = 1e-6, 3, 6
_FIRST, _SETTLED = 0.05, 1e-7
"""Size of the first simplex in the unit box; a gain, relative, that ends the climb."""
_BROKEN = 1e6
"""What counts as the radius of a gait that breaks a limit, m."""


@dataclass(frozen=True)
class Tightest:
    """The smallest circle within the limits: its radius, m, how far two searches from different
    grids differ, m, and the gait with its signed speed, m/s."""

    radius: float
    error: float
    gait: SineGait
    speed: float


def tightest(problem: Problem) -> Tightest | None:
    """The smallest circle, by climbs from two grids; None if no gait of either keeps the limits."""
    limit = open_offsets(problem)
    box = replace(problem.gait, offset=replace(problem.gait.offset, low=0.0, high=limit))
    posed = replace(problem, gait=box, turn=Turn(), inertia_ratio=None)
    turning = Turning(posed, None, Care(_CLOSER, 0, 1.0, 0.0))
    ends = [_climbed(posed, turning, counts) for counts in ((8, 33, 8), (11, 46, 11))]
    there = [end for end in ends if end is not None]
    if not there:
        return None
    points = [turning.at(end) for end in there]
    radii = [-float(_merit(posed, one)[0]) for one in points]
    best = int(np.argmin(radii))
    amplitude, period, offset, _ = (float(value) for value in points[best].gaits[:, 0])
    error = max(radii) - min(radii) if len(radii) > 1 else math.inf
    gait = SineGait(amplitude, period, offset)
    return Tightest(radii[best], error, gait, float(points[best].seen.speed[0]))


def _climbed(problem: Problem, turning: Turning, counts: tuple[int, int, int]) -> Array | None:
    """The best place (4, 1) that climbs from the best points of a grid lead to."""
    box = problem.gait
    free = np.array([not box.period.fixed, True, not box.amplitude.fixed, False])
    axes = [
        np.linspace(0, 1, n) if go else np.zeros(1)
        for n, go in zip((*counts, 1), free, strict=True)
    ]
    unit = np.array(list(itertools.product(*axes))).T
    merit = _merit(problem, turning.at(unit))
    ends: list[tuple[float, Array]] = []
    apart = np.ones(len(merit), bool)
    for _ in range(_CLIMBS):
        top = int(np.where(apart, merit, -np.inf).argmax())
        if not apart[top] or merit[top] == -np.inf:
            break
        ends.append(_closer(problem, turning, unit[:, [top]], free))
        apart &= np.abs(unit - unit[:, [top]]).max(axis=0) > 0.2
    return max(ends, key=lambda end: end[0])[1] if ends else None


def _closer(problem: Problem, turning: Turning, start: Array, free: Array) -> tuple[float, Array]:
    """The best place that the simplex method leads to, begun anew until it gains nothing: the
    radius has kinks where limits begin and a point like a cone's where the robot only spins."""
    which = np.flatnonzero(free)
    value, best = float(_merit(problem, turning.at(start))[0]), start

    def cost(x: Array) -> float:
        place = best.copy()
        place[which, 0] = x
        # A number, or the simplex cannot be ordered.
        return min(-float(_merit(problem, turning.at(place))[0]), _BROKEN)

    for _ in range(_RESTARTS):
        simplex = best[which, 0] + np.vstack([np.zeros(len(which)), _FIRST * np.eye(len(which))])
        simplex = np.where(simplex > 1, 2 * best[which, 0] - simplex, simplex)
        found = minimize(
            cost,
            best[which, 0],
            method="Nelder-Mead",
            bounds=[(0.0, 1.0)] * len(which),
            options={"initial_simplex": simplex, "xatol": 1e-9, "fatol": 1e-10, "maxfev": 400},
        )
        gained = -float(found.fun) - value
        if gained > 0:
            value, best = value + gained, best.copy()
            best[which, 0] = found.x
        if gained <= _SETTLED * abs(value):
            break
    return value, best


def _merit(problem: Problem, points: Points) -> Array:
    """Minus the radius, m, where every limit is kept, else -inf."""
    limits, seen = problem.limits, points.seen
    amplitude, period, offset, _ = points.gaits
    slack = 1 + _SLACK
    kept = (
        points.turns
        & ahead(problem, seen.speed)
        & (seen.peak_torque <= limits.torque * slack)
        & (amplitude * 2 * math.pi <= limits.rate * period * slack)
        & (amplitude + np.abs(offset) <= limits.angle * slack)
        & (least_S1(problem.robot, amplitude, offset) >= limits.singularity / slack)
        & (seen.turn != 0)
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = period * np.abs(seen.speed / seen.turn)
    return np.where(kept, -radius, -np.inf)
