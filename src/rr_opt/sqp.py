"""Sequential quadratic programming for a few variables, with finite-difference derivatives.

A smooth function of some four variables is maximised within bounds, linear constraints and rows.
Each iteration places a small stencil around the point, evaluates it in one call, and gets from it
the gradient and the Hessian of the function and of every row. The quadratic program for the step is
solved as a least-distance problem by non-negative least squares, as SLSQP does it (Lawson and
Hanson, Solving Least Squares Problems, 1974, chapter 23).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array

Mask = NDArray[np.bool_]

_GAIN, _LENGTH, _STATIONARY = 1e-9, 1e-7, 1e-4
"""Convergence: relative gain and scaled length of the last step; and relative slope of further gain
that only the trust radius prevents."""
_ROUNDING = 1e-12
"""Rounding error of a row, at least."""
_FRACTIONS = np.array([1.0, 0.6, 0.3, 0.1, 0.03])
"""Fractions of a step that are tried, all in one call."""
_RADIUS = 0.2
"""The largest trust radius, in scales."""
_SHRUNK = 0.1
"""Factor on the radius after a step that gains nothing."""
_ITERATIONS = 100
_CORRECTIONS = 3
"""Most corrections of a step."""
FEASIBLE = 1e-7
"""Largest violation of a row that counts as satisfied."""
_DEARER, DEAREST = 10.0, 1e5
"""Factor on the penalty if a climb ends with a violated row, and the largest penalty, in values of
the function: if that is not enough, there is no solution nearby."""
_REPEATED, _SETTLED = 8, 1e-2
"""Most quadratic programs within a step, and the relative change that ends them."""
_ACROSS, _FLAT, _SLIGHT = 10.0, 1e-6, 1e-3
"""Curvature added across active rows, and least curvature, relative to the largest curvature or
slope of the function; and the least of those, relative to the penalty."""


class Seen(NamedTuple):
    """Values at K points: the function (K,); rows (R, K), smooth along the points, with maxima over
    a curve followed from the first point's; worst (W, K), the same with each point's own maxima;
    names of the rows; and the rounding of rows and, relative, of the function."""

    function: Array
    rows: Array
    worst: Array
    names: tuple[str, ...]
    rounding: float = 0.0


@dataclass(frozen=True)
class Program:
    """Maximise the function subject to rows <= 0.

    low, high, scale   bounds (n,), and a small step of each variable (n,)
    matrix, most       linear constraints: matrix x <= most
    look               points (K, n) -> Seen
    equal              the first rows, of rows and worst, that must be 0: their number
    unit               a small value of the function
    """

    low: Array
    high: Array
    scale: Array
    matrix: Array
    most: Array
    look: Callable[[Array], Seen]
    equal: int = 0
    unit: float = 0.0
    step: float = 1e-3

    def violation(self, worst: Array) -> Array:
        """Violation of the worst row, (K,)."""
        size = np.concatenate([np.abs(worst[: self.equal]), worst[self.equal :]])
        return size.max(axis=0, initial=0.0)


@dataclass(frozen=True)
class Prices:
    """Shadow prices: value gained per unit by which each row, linear constraint or upper bound is
    raised, or a lower bound lowered; 0 where inactive."""

    rows: Array
    linear: Array
    high: Array
    low: Array


@dataclass(frozen=True)
class Ascent:
    """The result of a climb: the point (n,), the function there, the violation of the worst row,
    prices, of rows with these names; and whether it has converged."""

    x: Array
    value: float
    violation: float
    prices: Prices
    names: tuple[str, ...]
    converged: bool
    iterations: int


def ascend(program: Program, start: Array, penalty: float = 10.0) -> Ascent:
    """Climb from a start within the bounds.

    penalty: initial value for a violation of 1, in values of the function.
    """
    x, radius, converged, iterations = start, _RADIUS, False, 0
    kept, least_penalty, smallest = False, penalty, max(program.unit, 1e-300)
    size = smallest
    near, design = _stencil(len(x), program.step)
    here = program.look(x[None])
    value, violation = float(here.function[0]), float(program.violation(here.worst)[0])
    names, prices = here.names, Prices(np.zeros(len(here.rows)), *(np.zeros(0) for _ in range(3)))
    while not converged and iterations < _ITERATIONS:
        iterations += 1
        if violation <= FEASIBLE and not kept:
            # Values and prices along the way can be a thousand times larger than here.
            kept, penalty, size, radius = True, least_penalty, smallest, _RADIUS
        around = x + program.step * program.scale * near
        function, rows, _, names, rounding = program.look(around)
        rounding = max(_ROUNDING, rounding)
        models = np.vstack([function, rows]) @ design.T
        if not np.isfinite(models).all():
            break
        # It never decreases: otherwise the climb could cycle.
        size = max(abs(value), size)
        step, priced, promise = _step(program, x, models, radius, penalty * size)
        if not np.isfinite(step).all():
            break
        prices = priced
        dearest = float(np.abs(prices.rows).max(initial=0.0)) / size
        penalty = max(penalty, min(2 * dearest, DEAREST))
        length, reach = float(np.abs(step).max(initial=0.0)), radius
        tried = _tried(program, x, step, models, prices, penalty * size, rounding)
        merit = tried.merit
        best = int(merit.argmax())
        gain = float(merit[best] - merit[0])
        x, value = tried.points[best], float(tried.function[best])
        violation = float(tried.violation[best])
        if best == 0:
            radius = _SHRUNK * min(radius, length)
        elif best == 1:
            radius = min(2 * radius, _RADIUS)
        else:
            radius = float(_FRACTIONS[best - 1]) * length
        # A step cut short by its radius, or that gains less than predicted, is inconclusive.
        noise = penalty * rounding
        least = (_GAIN + noise) * size
        small = length <= _LENGTH or abs(gain if best == 1 else promise) <= least
        converged = length < (1 - _SETTLED) * reach and small
        ended = converged or reach <= _LENGTH
        if ended and violation > FEASIBLE and penalty < DEAREST:
            # Where the function gains much along a row that hardly changes, violating it paid off.
            penalty, radius, converged = min(_DEARER * penalty, DEAREST), _RADIUS, False
        elif reach <= _LENGTH:
            converged = -noise * size <= promise <= (_STATIONARY * reach + noise) * size
            break
    return Ascent(x, value, violation, prices, names, converged, iterations)


class _Tried(NamedTuple):
    """A point and fractions of a step from it, (K,): points (K, n), function, violation, and the
    penalised function; rows (K, R)."""

    points: Array
    function: Array
    violation: Array
    merit: Array
    rows: Array


def _weighed(program: Program, points: Array, penalty: float) -> _Tried:
    seen = program.look(points)
    violation = program.violation(seen.worst)
    merit = seen.function - penalty * violation
    merit = np.where(np.isfinite(merit), merit, -np.inf)
    return _Tried(points, seen.function, violation, merit, seen.rows.T)


def _tried(
    program: Program,
    x: Array,
    step: Array,
    models: Array,
    prices: Prices,
    penalty: float,
    rounding: float,
) -> _Tried:
    """Fractions of a step, each corrected towards violated rows: where rows bend, the straight line
    to a feasible step violates them."""
    points = np.clip(x + _FRACTIONS[:, None] * program.scale * step, program.low, program.high)
    tried = _weighed(program, np.vstack([x, points]), penalty)
    for _ in range(_CORRECTIONS):
        if tried.merit.argmax() == 1 or not (tried.violation[1:] > rounding).any():
            break
        bent = _weighed(program, _corrected(program, models, prices, tried), penalty)
        better = bent.merit >= tried.merit
        both = zip(tried, bent, strict=True)
        tried = _Tried(*(np.where(better, two.T, one.T).T for one, two in both))
    return tried


def _corrected(program: Program, models: Array, prices: Prices, tried: _Tried) -> Array:
    """Points (K, n) corrected towards the active rows: third derivatives, which the models lack,
    carry a long step off sharply bent rows."""
    x, scale, equal = tried.points[0], program.scale, program.equal
    _, slopes, bends = _parts(models, len(x))
    held = np.concatenate([np.ones(equal, bool), prices.rows[equal:] > 0])
    bounds = np.eye(len(x))[np.flatnonzero((prices.high > 0) | (prices.low > 0))]
    still = np.vstack([(program.matrix * scale)[prices.linear > 0], bounds])
    bent = tried.points.copy()
    for point, rows in zip(bent[1:], tried.rows[1:], strict=True):
        slope = slopes[1:] + bends[1:] @ ((point - x) / scale)
        miss = np.concatenate([rows[:equal], np.maximum(rows[equal:], 0.0)])[held]
        if np.isfinite(miss).all():
            sides = np.vstack([slope[held], still])
            back = np.linalg.lstsq(sides, np.append(-miss, np.zeros(len(still))), rcond=None)[0]
            point += scale * back  # noqa: PLW2901
    bent = np.clip(bent, program.low, program.high)
    inside = np.all(bent @ program.matrix.T <= program.most + _ROUNDING, axis=1)
    return np.where(inside[:, None], bent, tried.points)


# Models may be large enough to overflow.
@np.errstate(over="ignore", divide="ignore", invalid="ignore")
def _step(
    program: Program, x: Array, models: Array, radius: float, penalty: float
) -> tuple[Array, Prices, float]:
    """The step, in scales, to the optimum of the quadratic models, the prices, and the predicted
    gain.

    The models of the rows are quadratic too, so several quadratic programs are solved within a
    step: along a curved limit, linearised rows would restrict it to the size of their error. A last
    variable relaxes the rows, for when their linearisations are inconsistent.
    """
    n, scale, equal = len(x), program.scale, program.equal
    values, slopes, bends = _parts(models, n)
    rows, straight = len(slopes) - 1, program.matrix * scale
    room = np.maximum(program.most - program.matrix @ x, 0.0)
    upper, lower = (program.high - x) / scale, (x - program.low) / scale
    high, low = np.clip(upper, 0.0, radius), np.clip(lower, 0.0, radius)
    column = np.append(-np.ones(rows + equal), np.zeros(len(straight) + 2 * n))
    sides = np.vstack([straight, np.eye(n), -np.eye(n)])
    curve, price, step = np.zeros((n + 1, n + 1)), np.zeros(rows), np.zeros(n)
    curve[n, n] = penalty
    found = np.zeros(rows + equal + len(sides) + 1)
    for _ in range(_REPEATED):
        bent = bends @ step
        here, tangents = values + (slopes + bent / 2) @ step, slopes + bent
        normals = np.vstack([tangents[1:], -tangents[1 : 1 + equal], sides])
        G = np.vstack([np.column_stack([normals, column]), np.append(np.zeros(n), -1.0)])
        at = np.concatenate([room - straight @ step, high - step, low + step, [0.0]])
        h = np.concatenate([-here[1:], here[1 : 1 + equal], np.maximum(at, 0.0)])
        bend = np.tensordot(price, bends[1:], 1) - bends[0]
        if not np.isfinite(bend).all():
            step = np.full(n, np.nan)
            break
        least = max(np.abs(slopes[0]).max(initial=0.0), _SLIGHT * penalty)
        # Where rows are inconsistent, none of them determines the step across it.
        settled = found[:-1] > np.where(
            (found[-1] > 0) | (np.arange(len(normals)) >= rows + equal), 0.0, np.inf
        )
        curve[:n, :n] = _convex(bend, least, normals[settled])
        change, found = _quadratic(curve, np.append(-tangents[0], penalty), G, h, found > 0)
        price = found[:rows].copy()
        price[:equal] -= found[rows : rows + equal]
        step = step + change[:n]
        if np.abs(change[:n]).max(initial=0.0) <= _SETTLED * np.abs(step).max(initial=0.0):
            break
    parts = np.cumsum([rows + equal, len(straight), n])
    _, linear, at_high, at_low = np.split(found[:-1], parts)
    # An active trust radius is not a bound of the program.
    at_high, at_low = at_high * (upper <= radius) / scale, at_low * (lower <= radius) / scale
    there = values + (slopes + bends @ step / 2) @ step
    promise = there[0] - values[0] - penalty * (_worst(there, equal) - _worst(values, equal))
    return step, Prices(price, linear, at_high, at_low), float(promise)


def _worst(models: Array, equal: int) -> float:
    """Violation of the worst row, by the models of the function and the rows."""
    rows = models[1:].copy()
    rows[:equal] = np.abs(rows[:equal])
    return float(rows.max(initial=0.0))


def _convex(bend: Array, least: float, held: Array) -> Array:
    """A convex curvature that is unchanged along the active rows, given by their normals.

    Across them the rows determine the step: there curvature is added (as in an augmented
    Lagrangian). Remaining negative curvature is raised.
    """
    size = max(float(np.abs(bend).max(initial=0.0)), least)
    unit = held / np.maximum(np.sqrt((held**2).sum(axis=1, keepdims=True)), 1e-300)
    values, vectors = np.linalg.eigh(bend + _ACROSS * size * unit.T @ unit)
    return (vectors * np.maximum(np.abs(values), _FLAT * size)) @ vectors.T


def _quadratic(curve: Array, slope: Array, G: Array, h: Array, active: Mask) -> tuple[Array, Array]:
    """min d'curve d/2 + slope'd with G d <= h, and the multipliers, as a least-distance problem.

    active: rows that are likely to be active
    """
    size = np.sqrt(np.diag(curve))
    L = np.linalg.cholesky(curve / np.outer(size, size))
    # In y = L'(size d) - centre: the least |y| with normals y + least <= 0.
    centre = -np.linalg.solve(L, slope / size)
    normals = np.asarray(np.linalg.solve(L, (G / size).T).T, float)
    least = normals @ centre - h
    u, rest = _nonnegative(np.vstack([-normals.T, least]), active)
    return np.linalg.solve(L.T, centre - rest[:-1] / rest[-1]) / size, u / -rest[-1]


def _nonnegative(E: Array, active: Mask) -> tuple[Array, Array]:
    """u >= 0 with the least |E u - f|, f the last unit vector, and E u - f; active: initial guess
    of where u > 0."""
    f = np.zeros(len(E))
    f[-1] = 1.0
    length = np.maximum(np.sqrt((E * E).sum(axis=0)), 1e-300)
    E = E / length
    u, active = np.zeros(E.shape[1]), active.copy()
    if active.any():
        u[active] = _solved(E[:, active], f)
        if u.min() < 0:
            u[:], active[:] = 0.0, False
    for _ in range(3 * E.shape[1]):
        pull = np.where(active, -np.inf, E.T @ (f - E @ u))
        enter = int(pull.argmax())
        if pull[enter] <= 1e-13:
            break
        active[enter] = True
        while active.any():
            at = np.flatnonzero(active)
            inside = _solved(E[:, at], f)
            if inside.min() > 0:
                u[at] = inside
                break
            falls = np.flatnonzero(~(inside > 0))
            shares = u[at][falls] / np.maximum(u[at][falls] - inside[falls], 1e-300)
            u[at] += shares.min() * (inside - u[at])
            gone = at[falls[shares <= shares.min()]]
            u[gone], active[gone] = 0.0, False
    return u / length, E @ u - f


def _solved(E: Array, f: Array) -> Array:
    """The least |E u - f|, without sign constraints."""
    Q, R = np.linalg.qr(E)
    pivots = np.abs(np.diag(R))
    if E.shape[1] > len(E) or pivots.min() <= 1e-10 * pivots.max():
        return np.asarray(np.linalg.lstsq(E, f, rcond=None)[0], float)
    return np.asarray(np.linalg.solve(R, Q[-1]), float)


def stencil(n: int) -> Array:
    """A minimal set of points (M, n) for a quadratic in n variables, the first at the centre."""
    pairs = list(combinations(range(n), 2))
    points = np.zeros((1 + 2 * n + len(pairs), n))
    for i in range(n):
        points[1 + 2 * i, i], points[2 + 2 * i, i] = 1.0, -1.0
    for row, (i, j) in enumerate(pairs, start=1 + 2 * n):
        points[row, [i, j]] = 1.0
    return points


@lru_cache
def _stencil(n: int, step: float) -> tuple[Array, Array]:
    """Points (M, n), in stencils, and the matrix from values there to those of a quadratic: value,
    slopes and second derivatives, in scales."""
    points = stencil(n)
    crossed = [points[:, [i]] * points[:, [j]] for i, j in combinations(range(n), 2)]
    monomials = np.hstack([np.ones((len(points), 1)), points, points**2 / 2, *crossed])
    design = np.asarray(np.linalg.inv(monomials), float)
    design[1 : n + 1] /= step
    design[n + 1 :] /= step**2
    return points, design


def _parts(models: Array, n: int) -> tuple[Array, Array, Array]:
    """Values (R,), slopes (R, n) and second derivatives (R, n, n)."""
    bends = np.zeros((len(models), n, n))
    for i in range(n):
        bends[:, i, i] = models[:, 1 + n + i]
    for k, (i, j) in enumerate(combinations(range(n), 2), start=1 + 2 * n):
        bends[:, i, j] = bends[:, j, i] = models[:, k]
    return models[:, 0], models[:, 1 : n + 1], bends
