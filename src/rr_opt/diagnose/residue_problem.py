"""The linearised problem of a fit with all terms that may be missing, and what some of them leave.

The terms are functions of time along the recorded path, so that their size alone is unknown. What
is nonlinear is how far they carry the robot: the problem is linearised again where the best set of
terms leads.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from rr_opt.diagnose.fit import Fit
from rr_opt.diagnose.gram import gram_of
from rr_opt.diagnose.model import Array, Piece
from rr_opt.diagnose.normal import Normal, bounded_step, normal_of, total
from rr_opt.diagnose.problem import box, doubt, scaled, unscaled
from rr_opt.diagnose.pushed import respond
from rr_opt.diagnose.racer_protocol import Racer

Columns = NDArray[np.int_]

_LARGEST, _ROUGHEST = 30.0, 3.0
"""The functions, and their changes from knot to knot, in usual sizes, are about no larger."""


@dataclass(frozen=True)
class Linearised:
    """The problem by the fit's quantities and, after them, all terms' columns, at u, scaled.

    normals  by piece;  prior  weights of what is known, (n, n);  fitted  how many quantities;
    count    values in the recordings
    """

    normals: Mapping[Piece, Normal]
    u: Array
    prior: Array
    low: Array
    high: Array
    fitted: int
    count: int

    def left(self, columns: Columns) -> float:
        """Misfit of the runs, each predicted from the others: mean square in sigma, less 1."""
        every = list(self.normals.values())
        left = 0.0
        for n in every:
            others = [other for other in every if other is not n] or every
            left += n.at(self.step(others, columns))
        return left / max(self.count - 4 * len(every), 1) - 1.0

    def step(self, normals: Sequence[Normal], columns: Columns) -> Array:
        """The best change (n,) with some columns free and the others at zero."""
        own = self._own(columns)
        d = np.zeros(self.u.size)
        d[self.fitted :] = -self.u[self.fitted :]
        d[own] = 0.0
        whole = total(normals, self.prior, self.u)
        g = whole.g + whole.H @ d
        d[own] = bounded_step(
            whole.H[np.ix_(own, own)], g[own], 1e-9, self.u[own], self.low[own], self.high[own]
        )
        return d

    def cost(self, columns: Columns) -> float:
        """Chi-square of all runs at the best change."""
        d = self.step(list(self.normals.values()), columns)
        return sum(n.at(d) for n in self.normals.values())

    def curve(self, columns: Columns) -> tuple[Array, Array]:
        """The columns' values and their covariance, from all runs."""
        own, every = self._own(columns), list(self.normals.values())
        d = self.step(every, columns)
        wider = doubt(self.cost(columns), self.count)
        H = total(every, self.prior, self.u).H[np.ix_(own, own)]
        spread = np.asarray(wider * np.linalg.inv(H), float)
        return (self.u + d)[columns], spread[self.fitted :, self.fitted :]

    def _own(self, columns: Columns) -> Columns:
        return np.concatenate([np.arange(self.fitted), columns])


@dataclass(frozen=True)
class Point:
    """Where a problem is linearised: values, starts, and how much of each column there is."""

    values: Mapping[str, float]
    starts: Mapping[Piece, Array]
    amounts: Array


def linearised(
    model: Racer,
    fit: Fit,
    point: Point,
    pushes: Mapping[Piece, Array],
    weights: Sequence[Array],
    each: Callable[..., Iterable] = map,
) -> Linearised:
    """The problem at a point; the columns push (columns, 7, n) in each piece.

    weights  of each term's columns, against being rough
    """
    tasks = [_OfPiece(model, fit, point, piece, pushes[piece]) for piece in point.starts]
    done = list(each(_linearised, tasks))
    normals = {task.piece: normal for task, (normal, _, _) in zip(tasks, done, strict=True)}
    cost, count = sum(one[1] for one in done), sum(one[2] for one in done)
    added = point.amounts.size
    low, high = box(fit.quantities)
    known = np.array([float(q.known) for q in fit.quantities])
    return Linearised(
        normals,
        np.append(scaled(fit.quantities, point.values), point.amounts),
        doubt(cost, count)
        * np.asarray(block_diag(np.diag(known), *(_known(one) for one in weights))),
        np.append(low, np.full(added, -np.inf)),
        np.append(high, np.full(added, np.inf)),
        len(fit.quantities),
        count,
    )


@dataclass(frozen=True)
class _OfPiece:
    model: Racer
    fit: Fit
    point: Point
    piece: Piece
    pushes: Array


def _linearised(one: _OfPiece) -> tuple[Normal, float, int]:
    """A piece's problem, its chi-square and how many values it has."""
    model, piece, quantities = one.model, one.piece, one.fit.quantities
    names = tuple(q.name for q in quantities)
    scale = np.array([q.scale for q in quantities])
    within, start = model.start_within, one.point.starts[piece]
    values, amounts = one.point.values, one.point.amounts
    out = respond(model, piece, values, one.fit.effects, start, names, one.pushes, amounts)
    data = model.runs[piece.run]
    sigma = data.sigma[piece.span]
    r = (out.predicted - data.values[piece.span]) / sigma
    good = np.isfinite(r)
    by_value, by_push, by_start = (
        (part / sigma[:, :, None])[good] for part in (out.by_value, out.by_push, out.by_start)
    )
    gram = gram_of(by_start, by_value * scale, by_push, r[good])
    normal = normal_of(gram, start / within, 1 / within)
    return normal, float(r[good] @ r[good]), int(good.sum())


def _known(weights: Array) -> Array:
    """Weights of a term's columns, which are neither huge nor rough."""
    return np.eye(len(weights)) / _LARGEST**2 + weights / _ROUGHEST**2


def moved(fit: Fit, point: Point, problem: Linearised, columns: Columns) -> Point:
    """Where the best set of columns leads."""
    d = problem.step(list(problem.normals.values()), columns)
    u = problem.u + d
    starts = {
        piece: point.starts[piece] + n.shift + n.follow @ d for piece, n in problem.normals.items()
    }
    values = dict(point.values) | unscaled(fit.quantities, u[: problem.fitted])
    return Point(values, starts, u[problem.fitted :])
