"""The circles of a robot's gaits: curvature and speed over offset, the tightest of them, and the
paper's claim that the offset alone decides on the circle."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from rr_opt.array import Array
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Problem, Turn
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.verify.evaluate import Mask, kept_limits, within
from rr_opt.verify.grid import reach
from rr_opt.verify.speeds import speeds
from rr_opt.verify.turn_points import Care, Turning, TurnPoints

_SLACK = 1e-8
_TOLERANCE = 1e-6


@dataclass(frozen=True)
class TurnMap:
    """Gaits at offsets phi0 >= 0; those at -phi0 are mirror images, if the robot is two-sided.

    amplitude (A,), offset (F,) in rad, period (T,) in s; all others (A, T, F): speed (m/s, signed),
    heading per period (rad, positive to the left), peak torque (N m), keeps: every limit is kept
    """

    amplitude: Array
    period: Array
    offset: Array
    speed: Array
    heading: Array
    peak_torque: Array
    keeps: Mask
    two_sided: bool = True

    @property
    def curvature(self) -> Array:
        """Heading per metre of the mean circle, 1/m; NaN where there is no steady cycle."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return self.heading / (self.period[:, None] * np.abs(self.speed))


def open_offsets(problem: Problem) -> float:
    """The largest offset that the limits, the least amplitude and the problem's own bounds on it
    allow, rad; bounds of one value count as open."""
    box = problem.gait.offset
    own = math.inf if box.fixed else max(abs(box.low), abs(box.high))
    return min(reach(problem) - problem.gait.amplitude.low, own, math.pi)


def turn_map(problem: Problem, counts: tuple[int, int, int]) -> TurnMap:
    """The map of the robot as it is; counts: of amplitudes, periods and offsets within bounds."""
    box, limits = problem.gait, problem.limits
    most = min(box.amplitude.high, reach(problem), limits.rate * box.period.high / (2 * math.pi))
    amplitude = np.linspace(box.amplitude.low, most, counts[0] if most > box.amplitude.low else 1)
    ends = (box.period.low, box.period.high)
    period = np.geomspace(*ends, counts[1]) if ends[0] < ends[1] else np.array(ends[:1])
    offset = np.linspace(0.0, open_offsets(problem), counts[2])
    alpha, phi0, T = np.meshgrid(amplitude, offset, period, indexing="ij")
    inside = _every(within(problem, alpha, phi0))
    seen = speeds(
        problem,
        np.where(inside, alpha, 0.0)[..., :1],
        period,
        np.where(inside, phi0, 0.0)[..., :1],
        None,
        _TOLERANCE,
    )
    gaits = np.array([alpha, T, phi0])
    keeps = seen.converged & (alpha > 0) & _every(kept_limits(problem, gaits, seen, _SLACK))
    parts = (np.where(inside, part, np.nan) for part in (seen.speed, seen.turn, seen.peak_torque))
    speed, heading, torque = (np.swapaxes(part, 1, 2) for part in parts)
    keeps, alike = np.swapaxes(keeps, 1, 2), dynamics_of(problem.robot).mirrored
    return TurnMap(amplitude, period, offset, speed, heading, torque, keeps, alike)


def _every(kept: Mapping[str, Mask]) -> Mask:
    return np.logical_and.reduce(list(kept.values()))


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


def _merit(problem: Problem, points: TurnPoints) -> Array:
    """Minus the radius, m, where every limit is kept, else -inf."""
    seen, gaits = points.seen, points.gaits
    kept = points.turns & (seen.turn != 0) & _every(kept_limits(problem, gaits, seen, _SLACK))
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = gaits[1] * np.abs(seen.speed / seen.turn)
    return np.where(kept, -radius, -np.inf)


_LEVEL = 1e-5
"""A radius has to grow by this much, relative, to count as growing."""


@dataclass(frozen=True)
class SignClaim:
    """Of the gaits at phi0 > 0 that keep every limit: how many there are, and how many of them
    drive forward and turn left, and so on. The claim holds if all turn to one side.

    exception   of the rarer side, the gait with the least offset; None if there is none
    """

    gaits: int
    forward_left: int
    forward_right: int
    backward_left: int
    backward_right: int
    exception: SineGait | None

    @property
    def holds(self) -> bool:
        """Every offset of one sign turns to one side."""
        return self.exception is None

    @property
    def rarer(self) -> int:
        """Gaits that turn to the rarer side."""
        left = self.forward_left + self.backward_left
        return min(left, self.gaits - left)

    @property
    def holds_each_way(self) -> bool:
        """Every offset of one sign turns to one side among the gaits that drive the same way."""
        return not (
            (self.forward_left and self.forward_right)
            or (self.backward_left and self.backward_right)
        )


@dataclass(frozen=True)
class RadiusClaim:
    """Of the curves of one amplitude and period: on how many the radius grows somewhere as the
    offset does.

    first    the least offset from which one grows, and its gait; None if none does
    factor   the most by which a radius exceeds the smallest at a lesser offset; inf where the
             turn changes sides on the way
    worst    the gait there
    """

    curves: int
    growing: int
    first: SineGait | None
    factor: float
    worst: SineGait | None

    @property
    def holds(self) -> bool:
        """No radius grows."""
        return self.growing == 0


def sign_claim(seen: TurnMap) -> SignClaim:
    """Test the first half of the claim on a map."""
    kept = seen.keeps & (seen.offset > 0) & (seen.heading != 0)
    left, ahead = seen.heading > 0, seen.speed > 0
    count = [int((kept & way & turn).sum()) for way in (ahead, ~ahead) for turn in (left, ~left)]
    rarer = kept & (left if count[0] + count[2] <= count[1] + count[3] else ~left)
    first = None
    if rarer.any():
        where = np.argwhere(rarer)
        first = _gait(seen, where[np.argmin(where[:, 2])])
    return SignClaim(int(kept.sum()), count[0], count[1], count[2], count[3], first)


def radius_claim(seen: TurnMap) -> RadiusClaim:
    """Test the second half of the claim on a map."""
    curvature = np.where(seen.keeps & (seen.offset > 0), seen.curvature, np.nan)
    curves = growing = 0
    first: SineGait | None = None
    worst: SineGait | None = None
    factor = 1.0
    for i, j in np.ndindex(curvature.shape[:2]):
        along = curvature[i, j]
        at = np.flatnonzero(np.isfinite(along))
        if len(at) < 2:
            continue
        curves += 1
        # Through straight the radius grows without bound before the turn changes sides.
        sides = np.sign(along[at])
        size = np.abs(along[at])
        grown = np.maximum.accumulate(size) / size
        changed = np.flatnonzero(sides[1:] != sides[:-1])
        grows = np.flatnonzero(size[1:] < size[:-1] * (1 - _LEVEL))
        begins = min([*grows, *changed], default=None)
        if begins is None:
            continue
        growing += 1
        start = _gait(seen, np.array([i, j, at[begins]]))
        if first is None or start.offset < first.offset:
            first = start
        most = np.inf if len(changed) else float(grown.max())
        if most > factor:
            where = at[changed[0] + 1] if len(changed) else at[int(grown.argmax())]
            factor, worst = most, _gait(seen, np.array([i, j, where]))
    return RadiusClaim(curves, growing, first, factor, worst)


def _gait(seen: TurnMap, index: NDArray[np.int_]) -> SineGait:
    i, j, k = (int(part) for part in index)
    return SineGait(float(seen.amplitude[i]), float(seen.period[j]), float(seen.offset[k]))
