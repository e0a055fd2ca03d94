"""Multistart: scan the whole box coarsely, climb from every promising point.

Gaits that make a requested turn are a thin layer of the box, which scattered points miss. So along
lines in the offset, the points are sought where a row crosses an end of its interval. Climbs from
there penalise the turn twice: lightly first, as a strict penalty turns the layer into a ridge along
which climbers hardly move; then strictly, as a light one lets them go fast off the turn.

Each iteration of a climb places a small stencil around every climber, evaluates all stencils in one
call, and fits one quadratic to the speed and one to each row: the torque, and the turn if one is
requested. The objective is the speed less a penalty for rows outside their intervals. It has a kink
at an interval's end, often right at the optimum, so it is computed from the fitted quadratics
rather than fitted itself.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import combinations

import numpy as np

from rr_opt.array import Array
from rr_opt.design.decisions import Decisions
from rr_opt.design.terrain import Merit, Terrain
from rr_opt.sqp import stencil


@dataclass(frozen=True)
class Effort:
    """How long to climb: at most `iterations`, with stencils from the `first` size down to the
    `last`."""

    iterations: int
    first: float
    last: float


_NODES, _FINER_NODES = 24, 48
"""Phases of the scan and its climb, then of the climb that continues from their tops: near the
singular posture the coarse landscape has spurious local optima."""
_POINTS = {0: 1, 1: 128, 2: 512, 3: 1500, 4: 3000}
_CLIMBERS = {0: 1, 1: 6, 2: 10, 3: 16, 4: 20}
"""Climbers by number of free decisions."""
_APART = 0.2
_ROUGH = Effort(iterations=8, first=0.08, last=0.02)
_THOROUGH = Effort(iterations=25, first=0.04, last=0.006)
_LIGHT, _STRICT = 3.0, 30.0
"""Penalties for an excess of 1, in units of the largest speed."""
_LINES, _LINE, _BISECTIONS = 300, 17, 5
_OFF = 0.05
"""Excess beyond which a top is not near a feasible gait."""
_WORTH = 0.5
"""Tops slower than this fraction of the best are not used as starts."""
_MOST = 12


_PATIENT = 16, 4
"""Factors on the numbers of points and of climbers for a thorough search."""


def tops(terrain: Terrain, *, thorough: bool = False) -> tuple[Array, int]:
    """Points (K, 4) of the unit box, best first, each a local optimum of the coarse landscape; and
    how many points were scanned."""
    box, free = terrain.box, terrain.box.free
    coarse, finer = (partial(terrain.over, nodes=n) for n in (_NODES, _FINER_NODES))
    more, wider = _PATIENT if thorough else (1, 1)
    points = scan(box, more * _POINTS[len(free)])
    count = len(points)
    if box.turn and "turn" in terrain.rows:
        points = np.concatenate([points, _crossings(points[: _LINES * wider], terrain)])
    seen = coarse(points)
    unit = _unit(terrain, seen)
    light, strict = (terrain.merit(unit, _LIGHT, turn) for turn in (_LIGHT, _STRICT))
    most = wider * _CLIMBERS[len(free)]
    rough = []
    for merit in (light, strict) if "turn" in terrain.rows and box.turn else (strict,):
        chosen = _peaks(points[:, free], merit(seen), most)
        rough.append(climb(points[chosen], free, coarse, merit, _ROUGH)[0])
    ends, values = climb(np.concatenate(rough), free, finer, strict, _THOROUGH)
    off = -terrain.merit(1.0, 1.0, 1.0)(_still(finer(ends)))
    near = off <= max(_OFF, 2 * off.min(initial=math.inf))
    worth = near & (values >= share_of(values[near].max(initial=-math.inf), _WORTH))
    return ends[worth][:_MOST], count


def share_of(best: float, share: float) -> float:
    """This share of the best value; as far below it where that is negative."""
    return best - (1 - share) * abs(best)


def _unit(terrain: Terrain, seen: Array) -> float:
    """The largest speed of nearly feasible gaits, m/s: infeasible ones can be a hundred times
    faster, too coarse a scale."""
    if terrain.aim != "speed":
        return 1.0
    near = terrain.merit(1.0, 1.0, 1.0)(_still(seen)) >= -_OFF
    return float(seen[0, near].max(initial=0.0) or seen[0].max() or 1.0)


def _still(seen: Array) -> Array:
    """The same rows with zero speed."""
    return np.array([np.zeros_like(seen[0]), *seen[1:]])


def scan(decisions: Decisions, count: int) -> Array:
    """Points of the unit box along the free coordinates, stretched so that a sixth of them lies on
    each pair of faces, where optima tend to be. Gaits at phi0 and -phi0 are mirror images, so half
    of a symmetric range suffices unless the side of the turn matters."""
    free = decisions.free
    points = np.zeros((count, 4))
    if free:
        points[:, free] = np.clip(spread(len(points), len(free)) * 1.2 - 0.1, 0.0, 1.0)
    if decisions.mirrored:
        points[:, 1] = 0.5 + points[:, 1] / 2
    return points


def _peaks(points: Array, values: Array, most: int) -> list[int]:
    """Indices of the best points that are not close to better ones, best first."""
    open_ = np.isfinite(values)
    chosen: list[int] = []
    while open_.any() and len(chosen) < most:
        best = int(np.argmax(np.where(open_, values, -np.inf)))
        chosen.append(best)
        open_ &= np.abs(points - points[best]).max(axis=1, initial=0.0) > _APART
    return chosen


def _crossings(points: Array, terrain: Terrain) -> Array:
    """Points where a row of the turn crosses an end of its interval, on lines through these."""
    box = terrain.box
    asked = box.turn.intervals if box.turn else ()
    first = len(terrain.kept) - len(asked) + 1
    along = next((i for i in (1, 2, 0, 3) if i in box.free), None)
    if along is None:
        return np.empty((0, 4))
    lines = np.repeat(points[:, None], _LINE, axis=1)
    lines[:, :, along] = np.linspace(0.0, 1.0, _LINE)
    seen = terrain.over(lines.reshape(-1, 4), _NODES)[first:].reshape(
        len(asked), len(points), _LINE
    )
    found = [np.empty((0, 4))]
    for row, (values, interval) in enumerate(zip(seen, asked, strict=True), start=first):
        for end in {interval.low, interval.high}:
            if not math.isfinite(end):
                continue
            above = values > end
            line, left = np.nonzero(above[:, 1:] != above[:, :-1])
            low, high = lines[line, left], lines[line, left + 1]
            rising = above[line, left + 1]
            for _ in range(_BISECTIONS if len(line) else 0):
                middle = (low + high) / 2
                beyond = terrain.over(middle, _NODES)[row] > end
                upper = (beyond == rising)[:, None]
                low, high = np.where(upper, low, middle), np.where(upper, middle, high)
            found.append((low + high) / 2)
    return np.concatenate(found)


_LARGEST, _SMALLEST = 0.2, 2e-3
_NEXT_TO = 0.06
_SAMPLES = 256

Surface = Callable[[Array], Array]
"""The function to climb: points (K, 4) -> speed and R rows, (1 + R, K)."""


def climb(
    x: Array, free: list[int], surface: Surface, merit: Merit, effort: Effort
) -> tuple[Array, Array]:
    """Climb from x (K, 4) along the free coordinates; the tops and their merit, best first.

    A climber that comes close to a better one stops: both are heading for the same optimum.
    """
    best = merit(surface(x))
    d = len(free)
    if not d:
        return x, best
    around_it, design = _stencil(d)
    size = np.full(len(x), effort.first)
    for _ in range(effort.iterations):
        # Near a face the stencil is shifted inside; its quadratic is still valid up to the face.
        centre = np.clip(x[:, free], size[:, None], 1 - size[:, None])
        trial = np.repeat(x[:, None, :], len(around_it) + 1, axis=1)
        trial[:, :-1, free] = centre[:, None, :] + size[:, None, None] * around_it
        around = _each(surface, trial[:, :-1])
        models = around @ design.T
        trial[:, -1, free] = centre + size[:, None] * _best_step(models, centre, size, merit)
        last = _each(surface, trial[:, -1:])
        values = merit(np.concatenate([around, last], axis=-1))
        rows, top = np.arange(len(x)), values.argmax(axis=1)
        gain = np.maximum(values[rows, top] - best, 0.0)
        aim = np.where((gain > 0)[:, None], trial[rows, top], x)
        moved = np.abs(aim - x).max(axis=1)
        done = (gain <= 1e-5 * np.abs(best)) & (size <= effort.last)
        size = np.where(moved > 1.5 * size, 1.4 * size, np.maximum(moved / 1.5, size / 4))
        size = np.clip(size, _SMALLEST, _LARGEST)
        x, best = aim, best + gain
        kept = _apart(x, best)
        x, best, size = x[kept], best[kept], size[kept]
        if done.all():
            break
    order = np.argsort(-best)
    return x[order], best[order]


def _each(surface: Surface, trial: Array) -> Array:
    """Speed and rows of (K, M, 4) points, (1 + R, K, M)."""
    values = surface(trial.reshape(-1, 4))
    return values.reshape(-1, *trial.shape[:2])


def _monomials(s: Array) -> Array:
    """1, s_i, s_i^2 and s_i s_j of steps (..., d), (..., M)."""
    d = s.shape[-1]
    parts = np.empty((*s.shape[:-1], 1 + 2 * d + d * (d - 1) // 2))
    parts[..., 0] = 1.0
    parts[..., 1 : d + 1] = s
    np.square(s, out=parts[..., d + 1 : 2 * d + 1])
    for at, (i, j) in enumerate(combinations(range(d), 2), start=2 * d + 1):
        np.multiply(s[..., i], s[..., j], out=parts[..., at])
    return parts


@lru_cache
def _stencil(d: int) -> tuple[Array, Array]:
    """A minimal set of points for a quadratic in d variables, and the matrix from values there to
    its coefficients."""
    points = stencil(d)
    design: Array = np.linalg.inv(_monomials(points)).astype(float)
    return points, design


def _best_step(models: Array, centre: Array, size: Array, merit: Merit) -> Array:
    """The best step (K, d), in stencils, from a cloud within two stencils and the unit box, then
    from smaller clouds around it. A cloud copes with kinks and slopes alike."""
    low = np.maximum(-2.0, -centre / size[:, None])
    high = np.minimum(2.0, (1 - centre) / size[:, None])
    cloud = _cloud(centre.shape[1])
    middle, reach = np.zeros_like(centre), 2.0
    for _ in range(4):
        steps = np.clip(middle[:, None] + reach * cloud, low[:, None], high[:, None])
        seen = _monomials(steps) @ models.transpose(1, 2, 0)
        top = merit(seen.transpose(2, 0, 1)).argmax(axis=1)
        middle, reach = steps[np.arange(len(steps)), top], reach / 3
    return middle


@lru_cache
def _cloud(d: int) -> Array:
    """The origin and low-discrepancy points of [-1.2, 1.2]^d."""
    return np.concatenate([np.zeros((1, d)), 2.4 * (spread(_SAMPLES, d) - 0.5)])


def spread(count: int, d: int) -> Array:
    """Low-discrepancy points of the unit box, (count, d): Roberts' additive recurrence."""
    golden = 2.0
    for _ in range(40):
        golden = (1 + golden) ** (1 / (d + 1))
    steps = golden ** -np.arange(1.0, d + 1)
    return (0.5 + np.outer(np.arange(1, count + 1), steps)) % 1.0


def _apart(x: Array, values: Array) -> list[int]:
    """Indices of climbers that are not close to a better one."""
    kept: list[int] = []
    for i in np.argsort(-values):
        if all(np.abs(x[i] - x[j]).max() > _NEXT_TO for j in kept):
            kept.append(int(i))
    return kept
