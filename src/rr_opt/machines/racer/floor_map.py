"""The gain of a floor patch, wherever it lies, without a fit.

Every segment of a recording is cut into moments. The drag of one wheel in one moment is an input of
its own, and one linearised pass gives the effect of each on the motion. A patch brakes some wheels
in some moments, so its gain, with parameters and initial states refitted, is a sum over these.

Places and speeds are the recorded ones: with them a drag is right however strong it is, whereas a
predicted robot would drive on.
"""

import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache

import casadi as ca
import numpy as np
from scipy.optimize import minimize

from rr_opt.array import Array
from rr_opt.effects.floor_patch import BORDER
from rr_opt.machines.racer.model import RacerModel
from rr_opt.machines.racer.observed import Along, observed
from rr_opt.machines.racer.parameters import values_of
from rr_opt.machines.racer.unknown_input import PUSHES, cut, linearised_inputs
from rr_opt.motion.dynamics import assembled
from rr_opt.sysid.estimation import Fit
from rr_opt.sysid.settings import SETTINGS

_MOMENTS = 50
"""Most moments in a segment."""

_SAMPLES = 5
"""Fewest samples in a moment."""

_POINTS = 4
"""Places of a wheel in a moment, from which the share of it on a patch is taken."""

_LEAST, _MOST = 0.02, 100.0
"""Range of a patch's drag multiplier."""

_AT_ONCE = 64
"""Patches per batch, to bound the memory."""

Depth = Callable[[Array, Array], Array]
"""How deep inside a patch the places x, y are, m."""


@dataclass(frozen=True)
class FloorMap:
    """The inputs of all wheels in all moments, a moment's four wheels side by side, and their cost.

    places   of the wheels (2, moments, 4, points of a moment), m
    slope    (4 moments,), gradient by shares of drag, everything else fitted
    roots    (segments, r, 4 moments of a segment): roots' roots are second derivatives; refitting
             the parameters reduces them by onto' inverse onto, with `onto` (nq, 4 moments)
    """

    places: Array
    slope: Array
    roots: Array
    onto: Array
    inverse: Array

    def at(self, depth: Depth) -> Array:
        """The share of each moment for which each wheel is on a patch (4 moments,)."""
        return (1 + np.tanh(depth(*self.places) / BORDER).mean(-1).ravel()) / 2

    def roughly(self, depth: Depth) -> Array:
        """The same, from the wheels' places in the middle of the moments."""
        return (1 + np.tanh(depth(*self._middles) / BORDER)) / 2

    @cached_property
    def _middles(self) -> Array:
        """The wheels' places in the middle of the moments (2, 4 moments)."""
        return self.places[..., _POINTS // 2].reshape(2, -1)

    def gains(self, shares: Array) -> tuple[Array, Array]:
        """Gains of patches in chi-square, each at its best multiplier, and that; (patches,).

        shares  of the moments on each patch (patches, 4 moments)
        """
        bent = self.roots @ shares.T.reshape(len(self.roots), -1, len(shares))
        onto = self.onto @ shares.T
        bend = (bent**2).sum((0, 1)) - (onto * (self.inverse @ onto)).sum(0)
        slope = shares @ self.slope
        more = np.where(bend > 0, -slope / np.where(bend > 0, bend, 1.0), 0.0)
        more = np.clip(more, _LEAST - 1.0, _MOST - 1.0) * (bend > 0)
        return -more * (2 * slope + bend * more), 1.0 + more


def floor_map(racer: RacerModel, fit: Fit) -> FloorMap:
    """The map for a fit, over its segments, each with an initial state of its own."""
    problem, values = fit.problem, fit.values
    nq, given = len(problem.names), racer.simulator.given(values)
    requests = problem.requests(values, fit.states)
    along = observed(racer, requests, fit.effects)
    count = max(min(min(one.t.size for one in along) // _SAMPLES, _MOMENTS), 1)
    size = requests[0].state.size
    scale = np.ones(size + nq + 4 * count + 1)
    scale[size : size + nq] = problem.scale
    bends, onto, slopes = [], [], []
    shared, g = np.diag(problem.prior), problem.prior * fit.u
    drag, names = _resistance(racer.simulator.every(fit.effects))
    pushes = [_pushes(seen, drag, values_of(given, names)) for seen in along]
    linear = linearised_inputs(racer, requests, fit.effects, problem.names, pushes, count)
    for one, part in zip(requests, linear, strict=True):
        evidence = fit.evidences[one.segment.run]
        weight = 1 / (1 + max(evidence.excess, 0) / problem.correlation_times(one.segment.run))
        gram = weight * part.gram * scale * scale[:, None]
        if not np.isfinite(gram).all():  # A motion that diverged says nothing.
            gram = np.zeros_like(gram)
        inner = np.linalg.pinv(gram[:size, :size], hermitian=True)
        reduced = gram[size:, size:] - gram[size:, :size] @ inner @ gram[:size, size:]
        shared, g = shared + reduced[:nq, :nq], g + reduced[:nq, -1]
        bends.append(reduced[nq:-1, nq:-1])
        onto.append(reduced[:nq, nq:-1])
        slopes.append(reduced[nq:-1, -1])
    # Inputs belong to one segment each; the parameters, which all share, are fitted.
    inverse = np.asarray(np.linalg.pinv(shared, hermitian=True), float)
    across = np.hstack(onto)
    return FloorMap(
        np.concatenate([_points(one, count) for one in along], axis=1),
        np.concatenate(slopes) - across.T @ (inverse @ g),
        _roots(np.array(bends)),
        across,
        inverse,
    )


def _points(along: Along, count: int) -> Array:
    """Where the wheels were in each moment of a segment (2, count, 4, points), m."""
    ends = cut(along.t.size, count)
    shares = (np.arange(_POINTS) + 0.5) / _POINTS
    samples = (ends[:-1, None] + np.diff(ends)[:, None] * shares).astype(int)
    return along.places[:, :, samples].transpose(1, 2, 0, 3)


def _roots(squares: Array) -> Array:
    """(segments, r, k): roots' roots are the squares (segments, k, k), to a part in 1e9. r is less
    than k, since wheels that are braked in the same moment do much the same."""
    value, vector = np.linalg.eigh(squares)
    some = (value > 1e-9 * value.max()).any(axis=0)
    roots = np.sqrt(np.maximum(value, 0.0))[:, None] * vector
    return np.ascontiguousarray(roots[:, :, some].swapaxes(1, 2))


def _pushes(along: Along, drag: ca.Function, p: Array) -> Array:
    """Each wheel's drag, N, as on the rest of the floor (4, 7, n)."""
    out = np.zeros((4, len(PUSHES), along.t.size))
    out[range(4), range(4)] = drag.map(along.t.size)(along.u, p)
    return out


@lru_cache
def _resistance(effects: tuple[str, ...]) -> tuple[ca.Function, tuple[str, ...]]:
    """(rolling speeds, p) -> what the floor beside a patch does to each wheel (4,), N; and p's
    names."""
    assembly = assembled(
        tuple(name for name in effects if name != "floor_patch"), for_prediction=True
    )
    wheels = assembly.mechanism.wheels
    u = ca.SX.sym("u", len(wheels))
    forces = ca.vertcat(*(wheel.resistance(u[k]) for k, wheel in enumerate(wheels)))
    return ca.Function("resistance", [u, assembly.p], [forces]), assembly.parameters


_PLACES = 12
"""Grid points across the floor where wheels were, at which circles are tried."""

_RADII = (0.06, 0.1, 0.15, 0.22, 0.32, 0.45)
"""Radii of circles, relative to that floor's longer side."""

_DIRECTIONS, _BORDERS = 36, 36

_SEEDS, _BEST = 5, 2
"""How many distinct patches are refined, and how many of those are proposed."""

_ALIKE = 0.9
"""The cosine above which two patches cover about the same."""

_MOVES = 80


@dataclass(frozen=True)
class Shape:
    """A kind of patch, each described by a few numbers.

    depth   how deep inside one places are, m
    grid    patches to try for wheels that were at (2, n), (shapes, numbers)
    values  of a patch as a robot file has them, m and rad, around the middle (2,) of the floor
    """

    depth: Callable[[Array], Depth]
    grid: Callable[[Array], Array]
    values: Callable[[Array, Array], Mapping[str, float]]


def likely(floor: FloorMap, shape: Shape) -> list[tuple[float, Mapping[str, float]]]:
    """The patches of a shape that gain most, distinct from one another: gains and values."""
    places = floor.places.reshape(2, -1)
    grid = shape.grid(places)
    if not len(grid):
        return []

    def roughly(one: Array) -> Array:
        return floor.roughly(shape.depth(one))

    some = np.split(grid, range(_AT_ONCE, len(grid), _AT_ONCE))
    gains = np.concatenate([floor.gains(np.array([*map(roughly, part)]))[0] for part in some])
    best = grid[np.argsort(-gains)]
    size = float(np.ptp(places, axis=1).max()) / _PLACES
    moved = [_moved(floor, shape, best[k], size) for k in _unlike(map(roughly, best), _SEEDS)]
    shares = np.array([floor.at(shape.depth(one)) for one in moved])
    gains, multipliers = floor.gains(shares)
    order, middle = np.argsort(-gains), places.mean(axis=1)
    return [
        (float(gains[k]), {"multiplier": float(multipliers[k]), **shape.values(moved[k], middle)})
        for k in order[_unlike(shares[order], _BEST)]
    ]


def _unlike(patches: Iterable[Array], most: int) -> list[int]:
    """The first few of the patches, by their shares, skipping any that resembles an earlier one."""
    found: dict[int, Array] = {}
    for k, shares in enumerate(patches):
        length = np.linalg.norm(shares)
        one = shares / (length or 1.0)
        if length > 0 and all(one @ other <= _ALIKE for other in found.values()):
            found[k] = one
        if len(found) == most:
            break
    return [*found]


def _moved(floor: FloorMap, shape: Shape, one: Array, size: float) -> Array:
    """The patch refined to about a local maximum of its gain: a fit starts there."""
    around = np.vstack([one, one + size / 2 * np.eye(one.size)])
    best = minimize(
        lambda at: -float(floor.gains(floor.at(shape.depth(at))[None])[0][0]),
        one,
        method="Nelder-Mead",
        options={
            "maxfev": _MOVES,
            "initial_simplex": around,
            "xatol": BORDER,
            "fatol": SETTINGS.evidence,
        },
    )
    return np.asarray(best.x)


def _circles(places: Array) -> Array:
    low, high = places.min(axis=1), places.max(axis=1)
    size = float((high - low).max())
    step = size / _PLACES
    if step == 0:
        return np.zeros((0, 3))
    x, y = (np.arange(a - step, b + 2 * step, step) for a, b in zip(low, high, strict=True))
    return np.array([(*at, size * r) for *at, r in itertools.product(x, y, _RADII)])


def _lines(places: Array, normals: Array, count: int) -> Iterator[tuple[float, float]]:
    """Straight lines across the floor where wheels were: the normal, rad, and how far along it."""
    for normal in normals:
        along = np.array([math.cos(normal), math.sin(normal)]) @ places
        yield from ((normal, at) for at in np.linspace(along.min(), along.max(), count + 2)[1:-1])


def _edge_grid(places: Array) -> Array:
    normals = 2 * math.pi * np.arange(_DIRECTIONS) / _DIRECTIONS - math.pi
    return np.array([*_lines(places, normals, _BORDERS)])


def _edge_values(of: Array, middle: Array) -> Mapping[str, float]:
    """Through the point of the edge that is nearest to the middle."""
    normal = np.array([math.cos(of[0]), math.sin(of[0])])
    x, y = middle + (of[1] - middle @ normal) * normal
    return {
        "normal": float(math.remainder(of[0], 2 * math.pi)),
        "edge_x": float(x),
        "edge_y": float(y),
    }


ROUND = Shape(
    depth=lambda of: lambda x, y: of[2] - np.sqrt((x - of[0]) ** 2 + (y - of[1]) ** 2),
    grid=_circles,
    values=lambda of, _: {"x": float(of[0]), "y": float(of[1]), "radius": float(of[2])},
)

STRAIGHT = Shape(
    depth=lambda of: lambda x, y: x * math.cos(of[0]) + y * math.sin(of[0]) - of[1],
    grid=_edge_grid,
    values=_edge_values,
)


def _strips(places: Array) -> Array:
    size = float(np.ptp(places, axis=1).max())
    normals = math.pi * np.arange(_DIRECTIONS // 2) / (_DIRECTIONS // 2)
    lines = _lines(places, normals, _BORDERS // 2)
    return np.array([(*line, size * r) for line in lines for r in _RADII])


def _strip_depth(of: Array) -> Depth:
    from_middle = STRAIGHT.depth(of)
    return lambda x, y: of[2] / 2 - np.abs(from_middle(x, y))


def _strip_values(of: Array, middle: Array) -> Mapping[str, float]:
    edge = _edge_values(np.array([of[0], of[1] - of[2] / 2]), middle)
    return {**edge, "width": float(of[2])}


STRIP = Shape(_strip_depth, _strips, _strip_values)


def patches(racer: RacerModel, fit: Fit) -> list[tuple[int, Mapping[str, float]]]:
    """Patches that would gain most, by their form: circles, edges and strips; best first."""
    floor = floor_map(racer, fit)
    found = [
        (gain, form, {f"floor_patch.{key}": value for key, value in values.items()})
        for form, shape in enumerate((ROUND, STRAIGHT, STRIP))
        for gain, values in likely(floor, shape)
        if gain > 2 * SETTINGS.evidence
    ]
    return [(form, values) for _, form, values in sorted(found, key=lambda one: -one[0])]
