"""The circles of a robot's gaits: curvature and speed over offset, the tightest circle, and the
paper's claim that the offset alone determines the circle."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Problem
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.verify.evaluate import Found, Mask, evaluate, evaluated, within
from rr_opt.verify.grid import grid_of, reach
from rr_opt.verify.speeds import speeds
from rr_opt.verify.sweep import climbed, tops

_TOLERANCE = 1e-6


@dataclass(frozen=True)
class TurnMap:
    """Gaits at offsets phi0 >= 0; those at -phi0 are mirror images, if the robot is symmetric.

    amplitude (A,), offset (F,) in rad, period (T,) in s; all others (A, T, F): speed (m/s, signed),
    heading per period (rad, positive to the left), peak torque (N m), keeps: feasible
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
    allow, rad; a fixed offset counts as free."""
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
    inside = np.logical_and.reduce(list(within(problem, alpha, phi0).values()))
    seen = speeds(
        problem,
        np.where(inside, alpha, 0.0)[..., :1],
        period,
        np.where(inside, phi0, 0.0)[..., :1],
        None,
        _TOLERANCE,
    )
    parts = (seen.speed, seen.peak_torque, seen.turn)
    made = [np.where(inside, part, np.nan) for part in parts]
    gaits = np.array([alpha, T, phi0, np.full_like(T, np.nan), *made])
    posed = replace(problem, turn=None, inertia_ratio=None)
    feasible = evaluated(posed, gaits.reshape(len(gaits), -1)).feasible.reshape(alpha.shape)
    keeps = np.swapaxes(seen.converged & (alpha > 0) & feasible, 1, 2)
    speed, torque, heading = (np.swapaxes(part, 1, 2) for part in made)
    alike = dynamics_of(problem.robot).mirrored
    return TurnMap(amplitude, period, offset, speed, heading, torque, keeps, alike)


_COUNTS = ((8, 8, 33), (11, 11, 46))
"""Amplitudes, periods and offsets of the grids."""
_CLIMBS = 3


@dataclass(frozen=True)
class Tightest:
    """The smallest feasible circle: its radius, m, the difference between two searches from
    different grids, m, and the gait with its signed speed, m/s."""

    radius: float
    error: float
    gait: SineGait
    speed: float


def tightest(problem: Problem) -> Tightest | None:
    """The smallest circle, by climbs from two grids; None if neither has a feasible gait."""
    limit = open_offsets(problem)
    box = replace(problem.gait, offset=replace(problem.gait.offset, low=0.0, high=limit))
    posed = replace(problem, gait=box, turn=None, inertia_ratio=None)
    ends = [end for end in (_climbed(posed, counts) for counts in _COUNTS) if end]
    if not ends:
        return None
    best = min(ends, key=lambda end: end.radius)
    radii = [end.radius for end in ends]
    error = max(radii) - min(radii) if len(radii) > 1 else math.inf
    return Tightest(best.radius, error, best.gait, best.speed)


def _climbed(problem: Problem, counts: tuple[int, int, int]) -> Found | None:
    """The tightest circle found by climbs from the tightest ones of a grid."""
    grid = grid_of(problem, dict(zip(("amplitude", "period", "offset"), counts, strict=True)))
    found = evaluate(problem, grid, _TOLERANCE)
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = found.decisions[1] * np.abs(found.speed / found.turn)
    merit = np.where(found.feasible & np.isfinite(radius), -radius, -np.inf)
    return climbed(problem, found.decisions[:, tops(found, merit, grid, _CLIMBS)], "radius")[0]


_LEVEL = 1e-5
"""Relative increase of a radius that counts as growth."""


@dataclass(frozen=True)
class SignClaim:
    """Of the feasible gaits at phi0 > 0: how many there are, and how many of them drive forward and
    turn left, and so on. The claim holds if all turn to one side.

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
        """For each direction of travel, every offset of one sign turns to one side."""
        return not (
            (self.forward_left and self.forward_right)
            or (self.backward_left and self.backward_right)
        )


@dataclass(frozen=True)
class RadiusClaim:
    """For the curves of one amplitude and period: on how many the radius grows somewhere with the
    offset.

    first    the least offset from which one grows, and its gait; None if none does
    factor   the most by which a radius exceeds the smallest at a lesser offset; inf where the
             turn changes sides in between
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
        # Passing through straight, the radius grows without bound before the turn changes sides.
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
