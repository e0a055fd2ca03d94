"""Fit a model's quantities to all runs at once, by simulation error.

One run's least-squares problem, linearised, with the run's own start taken out.

With r the residuals in sigmas, Jv their derivatives by the shared quantities and Js by the run's
start, the start that fits best for any change d of the quantities is known, and what is left is

    |r|^2 - b'..  + 2 g'd + d'H d,     H = Jv'Jv - Jv'Js (Js'Js)^-1 Js'Jv

so runs add up, can be left out one at a time, and quantities can be taken in or left out, all
without going back to the data.

The cost is the sum of squares of (predicted - recorded)/sigma over runs, channels and samples, and
of (value - known)/uncertainty over the quantities of which something is known beforehand. Each run
starts in a state of its own. Gauss-Newton steps with Levenberg's damping, inside a box; the horizon
grows, as a long run has local minima where a short one has none.

While the model is wrong its residuals are not noise: they are large, and the samples of a second or
two say the same. What was known beforehand is then weighed against them as against so much larger
noise, `doubt`, or the parameters would be bent to imitate what is missing. It is 1 at the noise.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rr_opt.array import Array
from rr_opt.sysid.model import Asked, Model, Piece, Quantity

_RIDGE = 1e-9
"""Of the largest diagonal entry: a start that these data do not see stays where it is."""


@dataclass(frozen=True)
class Quadratic:
    """cost + 2 g'd + d'H d at a change d (nv,) of the scaled quantities; g (nv,), H (nv, nv)."""

    cost: float
    g: Array
    H: Array

    def at(self, d: Array) -> float:
        """The cost after a change of the quantities."""
        return float(self.cost + 2 * self.g @ d + d @ self.H @ d)


@dataclass(frozen=True)
class Normal(Quadratic):
    """|residuals|^2 after the best start, which is start + shift + follow @ d."""

    shift: Array
    follow: Array


def total(parts: Iterable[Quadratic], prior: Array, u: Array) -> Quadratic:
    """The parts at u (nv,), and u' prior u of what was known; prior (nv, nv), or its diagonal."""
    prior = np.diag(prior) if prior.ndim == 1 else prior
    known = prior @ u
    every = (*parts, Quadratic(float(u @ known), known, prior))
    return Quadratic(
        sum(one.cost for one in every),
        np.sum([one.g for one in every], axis=0),
        np.sum([one.H for one in every], axis=0),
    )


def normal_of(gram: Array, begun: Array, known: Array) -> Normal:
    """Reduce J'J, J = [Js | Jv | r] in sigmas, with (ns + nv + 1) columns.

    begun  (ns,) the start, in what is known of it; known (ns,) how much a unit of it is in that
    """
    S, ns = gram.copy(), begun.size
    S[np.diag_indices(ns)] += known**2
    S[:ns, -1] += known * begun
    S[-1, :ns] += known * begun
    S[-1, -1] += begun @ begun
    A = S[:ns, :ns]
    size = np.sqrt(np.maximum(np.diag(A), 1e-300))
    scaled = A / np.outer(size, size)
    unseen = np.diag(A) <= _RIDGE * np.diag(A).max()
    scaled[unseen, :] = scaled[:, unseen] = 0.0
    scaled[np.diag_indices(ns)] = np.where(unseen, 1.0, np.diag(scaled) + 1e-12)
    C = S[:ns, ns:] * (~unseen)[:, None]
    solved = np.linalg.solve(scaled, C / size[:, None]) / size[:, None]
    left = S[ns:, ns:] - C.T @ solved
    left = (left + left.T) / 2
    return Normal(
        cost=max(float(left[-1, -1]), 0.0),
        g=left[:-1, -1],
        H=left[:-1, :-1],
        shift=-solved[:, -1],
        follow=-solved[:, :-1],
    )


def bounded_step(H: Array, g: Array, damping: float, u: Array, low: Array, high: Array) -> Array:
    """Minimise 2 g'd + d'Hd inside the box: what would leave it is held at its edge."""
    n = g.size
    d = np.zeros(n)
    free = np.ones(n, bool)
    damped = H + np.diag(damping * np.diag(H) + 1e-10 * (1 + np.diag(H)))
    for _ in range(n + 1):
        if not free.any():
            break
        rhs = -(g[free] + damped[np.ix_(free, ~free)] @ d[~free])
        d[free] = np.linalg.solve(damped[np.ix_(free, free)], rhs)
        over = free & ((u + d < low - 1e-12) | (u + d > high + 1e-12))
        if not over.any():
            break
        d[over] = np.where(u + d < low, low - u, high - u)[over]
        free &= ~over
    return d


_ALIKE = 150
"""So many samples of a misfit, 1.5 s at 100 Hz, count as one."""


def scaled(quantities: Sequence[Quantity], values: Mapping[str, float]) -> Array:
    """(value - where it starts)/scale."""
    return np.array([(values[q.name] - q.value) / q.scale for q in quantities])


def unscaled(quantities: Sequence[Quantity], u: Array) -> dict[str, float]:
    """The values, held inside their bounds."""
    return {
        q.name: float(min(max(q.value + q.scale * x, q.low), q.high))
        for q, x in zip(quantities, u, strict=True)
    }


class Problem:
    """The pieces of runs and the quantities of one fit; each piece has a start of its own."""

    def __init__(
        self,
        model: Model,
        pieces: Sequence[Piece],
        effects: tuple[str, ...],
        quantities: tuple[Quantity, ...],
        fixed: Mapping[str, float] | None = None,
    ) -> None:
        self.model, self.pieces, self.effects = model, tuple(pieces), effects
        self.quantities, self.fixed = quantities, dict(fixed or {})
        self.prior = np.array([float(q.known) for q in quantities])

    def normal(self, piece: Piece, values: Mapping[str, float], start: Array) -> Normal:
        """The linearised problem of a piece."""
        return self.normals(values, {piece: start})[piece]

    def normals(
        self, values: Mapping[str, float], starts: Mapping[Piece, Array], *, stray: bool = False
    ) -> dict[Piece, Normal]:
        """The linearised problems of pieces; `stray` takes in what no model of them has exactly."""
        names = tuple(q.name for q in self.quantities)
        grams = self.model.grams(self._asked(values, starts), self.effects, names, stray=stray)
        within = self.model.start_within
        # Of how far a run strays it is known that it is 0 to within 1.
        within = np.append(within, 1.0) if stray else within
        scale = np.array([*np.ones(within.size), *(q.scale for q in self.quantities), 1.0])
        out = {}
        for (piece, start), gram in zip(starts.items(), grams, strict=True):
            begun = np.append(start, 0.0) if stray else start
            out[piece] = normal_of(gram * np.outer(scale, scale), begun / within, 1 / within)
        return out

    def costs(
        self, values: Mapping[str, float], starts: Mapping[Piece, Array]
    ) -> dict[Piece, float]:
        """Chi-square of each piece, infinite where its prediction leaves the numbers."""
        out = {}
        every = self.model.off(self._asked(values, starts), self.effects)
        for (piece, start), off in zip(starts.items(), every, strict=True):
            known = start / self.model.start_within
            cost = float(np.vdot(off, off) + known @ known)
            out[piece] = cost if np.isfinite(cost) else np.inf
        return out

    def cost(self, values: Mapping[str, float], starts: Mapping[Piece, Array]) -> tuple[float, int]:
        """Chi-square of the data, infinite where a prediction leaves the numbers; their count."""
        return sum(self.costs(values, self.own(starts)).values()), self.count

    def own(self, starts: Mapping[Piece, Array]) -> dict[Piece, Array]:
        """The starts of its pieces."""
        return {piece: starts[piece] for piece in self.pieces}

    @cached_property
    def count(self) -> int:
        """How many values were recorded."""
        return recorded(self.model, self.pieces)

    def _asked(self, values: Mapping[str, float], starts: Mapping[Piece, Array]) -> list[Asked]:
        given = {**self.fixed, **values}
        return [Asked(piece, given, start) for piece, start in starts.items()]

    def beforehand(self, values: Mapping[str, float]) -> float:
        """Chi-square of what was known."""
        return float(self.prior @ scaled(self.quantities, values) ** 2)


def recorded(model: Model, pieces: Iterable[Piece]) -> int:
    """How many values were recorded of pieces."""
    seen = (model.runs[piece.run].values[piece.span] for piece in pieces)
    return sum(int(np.isfinite(values).sum()) for values in seen)


def doubt(cost: float, count: int) -> float:
    """By how much what was known counts for more while the data are not yet explained."""
    return max(1.0, 1.0 + _ALIKE * (cost / max(count, 1) - 1.0))


def box(quantities: Sequence[Quantity]) -> tuple[Array, Array]:
    """The bounds, scaled."""
    low = scaled(quantities, {q.name: q.low for q in quantities})
    return low, scaled(quantities, {q.name: q.high for q in quantities})


_DAMPINGS = (0.0, 1e-4, 1e-3, 1e-2, 1e-1, 1.0)
TRIES, UPHILL = 4, 1e3
_STRIDE = 3.0
"""A scaled quantity moves by no more in a step, an effect's by no more than that or twofold."""

DONE = 0.02
"""A step that would lower the cost by less ends the fit: far below one unit of chi-square."""


@dataclass(frozen=True)
class Fit:
    """A model with effects, fitted to runs.

    quantities  what was free
    values      of them, by name, SI
    starts      by piece
    normals     by piece, in scaled units, at the solution
    cost        chi-square of the data;  count  of their values
    """

    effects: tuple[str, ...]
    quantities: tuple[Quantity, ...]
    values: Mapping[str, float]
    starts: Mapping[Piece, Array]
    normals: Mapping[Piece, Normal]
    cost: float
    count: int
    converged: bool

    @property
    def scaled(self) -> Array:
        """The quantities in their scaled units."""
        return scaled(self.quantities, self.values)

    @property
    def prior(self) -> Array:
        """Weights of what was known of them (nq,), beside these data."""
        return doubt(self.cost, self.count) * np.array([float(q.known) for q in self.quantities])

    def total(self) -> Quadratic:
        """The cost of the data and of what was known, linearised."""
        return total(self.normals.values(), self.prior, self.scaled)


_FAR, _CRAWL, _PATIENCE = 1.05, 0.02, 10
"""A fit that is that far above the noise, mean square in sigma, and has lowered what is above it by
less than such a share in so many steps has gone down a wrong valley, and is given up."""

_KEPT = 0.25
"""A step that lowers the cost by less than that share of what it promised was too long, and the
next is damped as much."""


@dataclass(frozen=True)
class _Point:
    """Where a fit is, and the whole cost there: of the data, and of what was known."""

    values: Mapping[str, float]
    starts: Mapping[Piece, Array]
    cost: float
    known: float

    def total(self, weight: float) -> float:
        return self.cost + weight * self.known


def solve(
    problem: Problem,
    values: Mapping[str, float],
    starts: Mapping[Piece, Array],
    *,
    steps: int = 16,
    done: float = DONE,
) -> Fit:
    """Fit from given values and starts; for starts alone see `fit_starts`.

    What the data see best is 10^4 times as well seen as what they see least, and a long step along
    the one bends away from the valley of the other. So a step may go uphill: the next ones, from a
    new linearisation, get a few tries to come back lower than before, until it is damped instead.
    """
    cost, count = problem.cost(values, starts)
    best = _Point(dict(values), dict(starts), cost, problem.beforehand(values))
    at, tries, damping, converged = best, 0, 0, False
    kept: dict[Piece, Normal] = {}
    excess = np.inf
    for number in range(steps):
        if number % _PATIENCE == 0:
            last, excess = excess, best.total(doubt(best.cost, count)) - count
            if excess > (_FAR - 1) * count and excess > (1 - _CRAWL) * last:
                break
        if at is not best or not kept:
            normals = problem.normals(at.values, problem.own(at.starts))
            kept = normals if at is best else kept
        else:
            normals = kept
        weight = doubt(best.cost, count)
        trial, promised = _stepped(problem, at, normals, weight, damping)
        before, after = best.total(weight), trial.total(weight)
        if after < before:
            if before - after > _KEPT * (at.total(weight) - promised):
                damping = max(damping - 1, 0)
            best = at = trial
            kept, tries = {}, 0
            if before - after < max(done, 1e-6 * before):
                converged = True
                break
        elif tries < TRIES and after < UPHILL * before:
            at, tries = trial, tries + 1
        elif damping + 1 < len(_DAMPINGS):
            at, tries, damping = best, 0, damping + 1
        else:
            converged = True
            break
    if not kept:
        kept = problem.normals(best.values, problem.own(best.starts))
    return Fit(
        problem.effects,
        problem.quantities,
        best.values,
        best.starts,
        kept,
        best.cost,
        count,
        converged,
    )


def _stepped(
    problem: Problem, at: _Point, normals: Mapping[Piece, Normal], weight: float, damping: int
) -> tuple[_Point, float]:
    """The best point of the linearised problem, inside the box and not too far away, and the whole
    cost that it promises."""
    u = scaled(problem.quantities, at.values)
    low, high = box(problem.quantities)
    whole = total(normals.values(), weight * problem.prior, u)
    reach = np.array([_reach(q, at.values[q.name]) for q in problem.quantities])
    near, far = np.maximum(low, u - reach), np.minimum(high, u + reach)
    d = bounded_step(whole.H, whole.g, _DAMPINGS[damping], u, near, far)
    values = unscaled(problem.quantities, u + d)
    starts = {one: at.starts[one] + n.shift + n.follow @ d for one, n in normals.items()}
    cost, _ = problem.cost(values, starts)
    return _Point(values, starts, cost, problem.beforehand(values)), whole.at(d)


def _reach(q: Quantity, value: float) -> float:
    """How far a quantity may move in one step, scaled."""
    return _STRIDE if q.known else max(_STRIDE, abs(value) / q.scale)


_PARTS = (1.0, 0.6, 0.3, 0.1, 0.03, 0.01)
"""A step that leads uphill goes such a part of the way."""


@dataclass
class _Way:
    """A piece's start on the way to its best: where it is, the best so far, and their costs."""

    at: Array
    best: Array
    cost: float
    tries: int = 0
    part: int = 0
    ended: bool = False
    converged: bool = False

    def arrived(self, trial: Array, cost: float, done: float) -> None:
        """Take a step, or think better of it. Like a fit's, it may lead uphill for a few tries."""
        if cost < self.cost:
            self.ended = self.converged = self.cost - cost < max(done, 1e-6 * self.cost)
            self.at = self.best = trial
            self.cost, self.tries, self.part = cost, 0, max(self.part - 1, 0)
        elif self.tries < TRIES and cost < UPHILL * self.cost:
            self.at, self.tries = trial, self.tries + 1
        elif self.part + 1 < len(_PARTS):
            self.at, self.tries, self.part = self.best, 0, self.part + 1
        else:
            self.ended = self.converged = True


def fit_starts(
    problem: Problem, starts: Mapping[Piece, Array], *, steps: int = 16, done: float = DONE
) -> Fit:
    """The starts that fit each piece best, with the problem's fixed values and nothing else free.

    done  a step that would lower a piece's chi-square by less is its last
    """
    if problem.quantities:
        raise ValueError(f"Read {len(problem.quantities)} free quantities. Expected none.")
    own = problem.own(starts)
    ways = {p: _Way(own[p], own[p], cost) for p, cost in problem.costs({}, own).items()}
    normals = {}
    for _ in range(steps):
        open_ways = {piece: way for piece, way in ways.items() if not way.ended}
        if not open_ways:
            break
        fresh = {
            p: w.at for p, w in open_ways.items() if p not in normals or normals[p][0] is not w.at
        }
        for piece, normal in problem.normals({}, fresh).items():
            normals[piece] = fresh[piece], normal
        trials = {p: w.at + _PARTS[w.part] * normals[p][1].shift for p, w in open_ways.items()}
        for piece, cost in problem.costs({}, trials).items():
            ways[piece].arrived(trials[piece], cost, done)
    found = {piece: way.best for piece, way in ways.items()}
    fresh = {
        p: start for p, start in found.items() if p not in normals or normals[p][0] is not start
    }
    last = {piece: one for piece, (_, one) in normals.items()} | problem.normals({}, fresh)
    return Fit(
        problem.effects,
        (),
        problem.fixed,
        found,
        {piece: last[piece] for piece in found},
        sum(way.cost for way in ways.values()),
        problem.count,
        all(way.converged for way in ways.values()),
    )
