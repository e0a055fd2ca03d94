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

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rr_opt.diagnose.model import Array, Piece, Quantity
from rr_opt.diagnose.normal import Normal, Quadratic, bounded_step, total
from rr_opt.diagnose.problem import Problem, box, doubt, scaled, unscaled

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
