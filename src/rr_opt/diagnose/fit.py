"""Fit a model's quantities to all runs at once, by simulation error.

The cost is the sum of squares of (predicted - recorded)/sigma over runs, channels and samples, and
of (value - known)/uncertainty over the quantities of which something is known beforehand. Each run
starts in a state of its own. Gauss-Newton steps with Levenberg's damping, inside a box; the horizon
grows, as a long run has local minima where a short one has none.

While the model is wrong its residuals are not noise: they are large, and the samples of a second or
two say the same. What was known beforehand is then weighed against them as against so much larger
noise, `doubt`, or the parameters would be bent to imitate what is missing. It is 1 at the noise.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.diagnose.model import Array, Model, Piece, Quantity
from rr_opt.diagnose.normal import Normal, Quadratic, normal_of, total

_DAMPINGS = (0.0, 1e-4, 1e-3, 1e-2, 1e-1, 1.0)
_PARTS = (1.0, 0.6, 0.3, 0.1, 0.03, 0.01)
_TRIES, _UPHILL = 4, 1e3
_STRIDE = 3.0
"""A scaled quantity moves by no more in a step, an effect's by no more than that or twofold."""

_ALIKE = 150
"""So many samples of a misfit, 1.5 s at 100 Hz, count as one."""
_DONE = 0.02
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


_FAR, _CRAWL, _PATIENCE = 2.0, 5e-3, 2
"""A fit that is that far above the noise, mean square in sigma, and has lowered what is above it by
less than such a share in each of several steps, has gone down a wrong valley, and is given up."""


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

    def residuals(self, piece: Piece, values: Mapping[str, float], start: Array) -> Array:
        """(predicted - recorded)/sigma (n, channels), NaN where there are no data."""
        data = self.model.runs[piece.run]
        out = self.model.respond(piece, self.fixed | dict(values), self.effects, start)
        return (out.predicted - data.values[piece.span]) / data.sigma[piece.span]

    def normal(
        self, piece: Piece, values: Mapping[str, float], start: Array, *, stray: bool = False
    ) -> Normal:
        """The linearised problem of a piece; `stray` takes in what no model of it has exactly."""
        data = self.model.runs[piece.run]
        names = tuple(q.name for q in self.quantities)
        given = self.fixed | dict(values)
        out = self.model.respond(piece, given, self.effects, start, names)
        by_value, by_start = out.slopes
        sigma = data.sigma[piece.span]
        r = (out.predicted - data.values[piece.span]) / sigma
        seen = np.isfinite(r)
        scale = np.array([q.scale for q in self.quantities])
        Jv = (by_value / sigma[:, :, None])[seen] * scale
        Js = (by_start / sigma[:, :, None])[seen]
        within, begun = self.model.start_within, start
        if stray:
            # One more unknown of the run, of which it is known that it is 0 to within 1.
            Js = np.column_stack([Js, (self.model.stray(out.predicted) / sigma)[seen]])
            within, begun = np.append(within, 1.0), np.append(start, 0.0)
        return normal_of(r[seen], Jv, Js, begun / within, 1 / within)

    def cost(self, values: Mapping[str, float], starts: Mapping[Piece, Array]) -> tuple[float, int]:
        """Chi-square of the data, infinite where the prediction leaves the numbers; their count."""
        total, count = 0.0, 0
        for piece in self.pieces:
            r = self.residuals(piece, values, starts[piece])
            seen = np.isfinite(self.model.runs[piece.run].values[piece.span])
            total += float(np.sum(r[seen] ** 2))
            total += float(np.sum((starts[piece] / self.model.start_within) ** 2))
            count += int(seen.sum())
        return (total if np.isfinite(total) else np.inf), count

    def beforehand(self, values: Mapping[str, float]) -> float:
        """Chi-square of what was known."""
        return float(self.prior @ scaled(self.quantities, values) ** 2)


def doubt(cost: float, count: int) -> float:
    """By how much what was known counts for more while the data are not yet explained."""
    return max(1.0, 1.0 + _ALIKE * (cost / max(count, 1) - 1.0))


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
    done: float = _DONE,
) -> Fit:
    """Fit from given values and starts.

    What the data see best is 10^4 times as well seen as what they see least, and a long step along
    the one bends away from the valley of the other. So a step may go uphill: the next ones, from a
    new linearisation, get a few tries to come back lower than before, until it is damped instead.
    """
    cost, count = problem.cost(values, starts)
    best = _Point(dict(values), dict(starts), cost, problem.beforehand(values))
    at, tries, damping, crawled, converged = best, 0, 0, 0, False
    kept: dict[Piece, Normal] = {}
    for _ in range(steps):
        if at is not best or not kept:
            normals = {
                one: problem.normal(one, at.values, at.starts[one]) for one in problem.pieces
            }
            kept = normals if at is best else kept
        else:
            normals = kept
        weight = doubt(best.cost, count)
        trial = _stepped(problem, at, normals, weight, damping)
        before, after = best.total(weight), trial.total(weight)
        if after < before:
            best = at = trial
            kept, tries, damping = {}, 0, max(damping - 1, 0)
            if before - after < max(done, 1e-6 * before):
                converged = True
                break
            crawled = crawled + 1 if before - after < _CRAWL * (before - count) else 0
            if crawled > _PATIENCE and before > _FAR * count:
                break
        elif tries < _TRIES and after < _UPHILL * before:
            at, tries = trial, tries + 1
        elif damping + 1 < len(_DAMPINGS):
            at, tries, damping = best, 0, damping + 1
        else:
            converged = True
            break
    if not kept:
        kept = {one: problem.normal(one, best.values, best.starts[one]) for one in problem.pieces}
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
) -> _Point:
    """The best point of the linearised problem, inside the box and not too far away."""
    u = scaled(problem.quantities, at.values)
    low, high = box(problem.quantities)
    whole = total(normals.values(), weight * problem.prior, u)
    reach = np.array([_reach(q, at.values[q.name]) for q in problem.quantities])
    near, far = np.maximum(low, u - reach), np.minimum(high, u + reach)
    d = bounded_step(whole.H, whole.g, _DAMPINGS[damping], u, near, far)
    values = unscaled(problem.quantities, u + d)
    # Starts alone are not damped but go a part of the way.
    part = 1.0 if problem.quantities else _PARTS[damping]
    starts = {one: at.starts[one] + part * (n.shift + n.follow @ d) for one, n in normals.items()}
    cost, _ = problem.cost(values, starts)
    return _Point(values, starts, cost, problem.beforehand(values))


def _reach(q: Quantity, value: float) -> float:
    """How far a quantity may move in one step, scaled."""
    return _STRIDE if q.known else max(_STRIDE, abs(value) / q.scale)


def box(quantities: Sequence[Quantity]) -> tuple[Array, Array]:
    """The bounds, scaled."""
    low = scaled(quantities, {q.name: q.low for q in quantities})
    return low, scaled(quantities, {q.name: q.high for q in quantities})


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
