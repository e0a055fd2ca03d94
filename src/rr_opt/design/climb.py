"""Climb from many points of the unit box at once, along smooth slopes and along kinks.

Each iteration lays a small stencil around every climber, evaluates all stencils in one call, and
fits one quadratic to the speed and one to each row: the torque, and the turn if one is asked for.
What is maximised is the speed less a penalty for rows outside their intervals: that has a kink
where an interval ends, often right where the optimum is, so it is formed from the quadratics and
not fitted itself.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

import numpy as np

from rr_opt.array import Array
from rr_opt.model.problem import Interval

_LARGEST, _SMALLEST = 0.2, 2e-3
_NEXT_TO = 0.06
_SAMPLES = 256


Terrain = Callable[[Array], Array]
"""What is climbed: points (K, 4) -> speed and R rows, (1 + R, K)."""


@dataclass(frozen=True)
class Effort:
    """How long to climb: at most `iterations`, with stencils of the `first` size until
    nothing is gained with stencils of the `last`."""

    iterations: int
    first: float
    last: float


@dataclass(frozen=True)
class Merit:
    """What is climbed: the speed less a penalty for each row outside its interval.

    rows       the interval of each row
    penalties  for an excess of 1 of each row, m/s
    """

    rows: tuple[Interval, ...]
    penalties: tuple[float, ...]

    def __call__(self, values: Array) -> Array:
        """values: speed and rows, (1 + R, ...)."""
        merit = values[0]
        for row, asked, penalty in zip(values[1:], self.rows, self.penalties, strict=True):
            excess = np.maximum(row - asked.high, asked.low - row)
            merit = merit - penalty * np.maximum(excess, 0.0)
        return merit


def climb(
    x: Array, free: list[int], terrain: Terrain, merit: Merit, effort: Effort
) -> tuple[Array, Array]:
    """Climb from x (K, 4) along the free coordinates; the tops and their merit, best first.

    A climber that comes next to a better one gives up: both are on their way to the same top.
    """
    best = merit(terrain(x))
    d = len(free)
    if not d:
        return x, best
    stencil, design = _stencil(d)
    size = np.full(len(x), effort.first)
    for _ in range(effort.iterations):
        # Near a face the stencil moves inside; its quadratic still serves up to the face.
        centre = np.clip(x[:, free], size[:, None], 1 - size[:, None])
        trial = np.repeat(x[:, None, :], len(stencil) + 1, axis=1)
        trial[:, :-1, free] = centre[:, None, :] + size[:, None, None] * stencil
        around = _each(terrain, trial[:, :-1])
        models = around @ design.T
        trial[:, -1, free] = centre + size[:, None] * _best_step(models, centre, size, merit)
        last = _each(terrain, trial[:, -1:])
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


def _each(terrain: Terrain, trial: Array) -> Array:
    """Speed and rows of (K, M, 4) points, (1 + R, K, M)."""
    values = terrain(trial.reshape(-1, 4))
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
    """Just enough points for a quadratic in d variables, and what turns values at them into its
    coefficients."""
    pairs = list(combinations(range(d), 2))
    points = np.zeros((1 + 2 * d + len(pairs), d))
    for i in range(d):
        points[1 + 2 * i, i], points[2 + 2 * i, i] = 1.0, -1.0
    for row, (i, j) in enumerate(pairs, start=1 + 2 * d):
        points[row, [i, j]] = 1.0
    design: Array = np.linalg.inv(_monomials(points)).astype(float)
    return points, design


def _best_step(models: Array, centre: Array, size: Array, merit: Merit) -> Array:
    """The best step (K, d), in stencils, of a cloud within two stencils and the unit box, then
    of smaller clouds around that. A cloud serves kinks and slopes alike."""
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
    """Indices of climbers that are not next to a better one."""
    kept: list[int] = []
    for i in np.argsort(-values):
        if all(np.abs(x[i] - x[j]).max() > _NEXT_TO for j in kept):
            kept.append(int(i))
    return kept
