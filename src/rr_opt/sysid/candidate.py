"""A set of effects fitted to the recordings, and how much of them it leaves.

Predict each fitted run from the others, without fitting again.

The linearised problems of the runs add up. Taking one out and solving gives the quantities that
the others would have given; at these, with a start of its own, the run is what it was not part of.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from rr_opt.array import Array
from rr_opt.sysid.least_squares import (
    Fit,
    Problem,
    bounded_step,
    box,
    fit_starts,
    scaled,
    solve,
    total,
)
from rr_opt.sysid.model import Form, Model, Piece

_LONG_WAY = 1.5
"""Mean square in sigma: above it over whole runs, and below it in windows, is a long way."""

_NEAR = 0.5
"""In windows, whose fit only begins another, a step that would lower the cost by less ends it."""

_LOOK = 3
"""So many steps from each of several places to begin say which leads lowest."""


def whole(model: Model, runs: Sequence[int]) -> list[Piece]:
    """The runs in one piece each."""
    return [Piece(run, 0, len(model.runs[run].t)) for run in runs]


def windows(model: Model, runs: Sequence[int], seconds: float | None = None) -> list[Piece]:
    """The runs in pieces of about so long, else the model's window; each ends where one begins."""
    pieces = []
    for run in runs:
        t = model.runs[run].t
        count = max(round((t[-1] - t[0]) / (seconds or model.window)), 1)
        edges = np.linspace(0, len(t), count + 1).astype(int)
        pieces += [Piece(run, a, b) for a, b in itertools.pairwise(edges)]
    return pieces


@dataclass(frozen=True)
class Chosen:
    """An effect and which of its forms."""

    name: str
    form: int = 0

    def of(self, model: Model) -> Form:
        """The form itself."""
        return model.catalogue[self.name].forms[self.form]


def nominal(model: Model, pieces: Sequence[Piece]) -> Fit:
    """The model as it is believed to be: the starts alone are fitted, each piece on its own."""
    problem = Problem(model, pieces, (), ())
    return fit_starts(problem, {piece: model.start(piece) for piece in pieces})


def parameters(model: Model, start: Fit) -> Fit:
    """The nominal model with the parameters free within what is known of them."""
    problem = Problem(model, tuple(start.starts), (), model.parameters)
    return solve(
        problem, {q.name: q.value for q in model.parameters} | dict(start.values), start.starts
    )


def explain(
    model: Model,
    chosen: Sequence[Chosen],
    nominal: Fit,
    start: Fit,
    begins: Sequence[Mapping[str, float]] | None = None,
) -> Fit:
    """Fit the parameters and the chosen effects together.

    Effects that `start` has begin as they are in it, a new one at the best of `begins`, or where
    its form says. Parameters and the runs' starts begin where they are believed to be, in the
    `nominal` fit: bent to imitate what was missing, they lie at the end of a valley along which a
    fit comes back only slowly. Where that leads astray, and what ends is worse than `start`, they
    begin where they are in it.
    """
    quantities = (*model.parameters, *(q for one in chosen for q in one.of(model).quantities))
    kept = {q.name: start.values[q.name] for q in quantities if q.name in start.values}
    loose = {q.name: kept[q.name] for q in quantities if q.name in kept and not q.known}
    fresh = [one.of(model).starts for one in chosen if one.name not in start.effects]
    places = [
        {name: value for part in found for name, value in part.items()}
        for found in itertools.product(*([begins] if begins else fresh))
    ]
    names = tuple(one.name for one in chosen)
    problem = Problem(model, tuple(nominal.starts), names, quantities)
    fit = _from_best(problem, nominal, loose, places)
    if start.starts.keys() == nominal.starts.keys() and fit.cost > start.cost + 1.0:
        other = _from_best(problem, start, kept, places)
        fit = min(fit, other, key=lambda one: one.cost)
    return fit


def _from_best(
    problem: Problem, first: Fit, values: Mapping[str, float], places: Sequence[Mapping[str, float]]
) -> Fit:
    """The fit from the starts of another and from the best of some places; what has no value begins
    where it is believed to be."""
    believed = {q.name: q.value for q in problem.quantities}
    each = [believed | dict(values) | dict(place) for place in places]
    if len(each) == 1:
        return solve(problem, each[0], _starts(problem, each[0], first), done=_NEAR)
    best = min(
        (solve(problem, v, _starts(problem, v, first), steps=_LOOK, done=_NEAR) for v in each),
        key=lambda f: f.cost,
    )
    return best if best.converged else solve(problem, best.values, best.starts, done=_NEAR)


def _starts(problem: Problem, values: Mapping[str, float], nominal: Fit) -> Mapping[Piece, Array]:
    """The starts of the nominal fit, or, where they are worse with these values than without, those
    that fit each piece by itself: one that goes astray takes all others with it."""
    if problem.cost(values, nominal.starts)[0] <= nominal.cost:
        return nominal.starts
    alone = Problem(problem.model, problem.pieces, problem.effects, (), values)
    return fit_starts(alone, nominal.starts, done=_NEAR).starts


def joined(model: Model, fit: Fit) -> Fit:
    """The same fit over whole runs, from one over windows.

    Where that is a long way, by pieces of three windows: a long run has wrong minima near which a
    shorter one has none.
    """
    far = _alone(model, fit, len(fit.starts))
    if fit.quantities and far.cost > _LONG_WAY * far.count and fit.cost < _LONG_WAY * fit.count:
        near = _alone(model, fit, 3)
        problem = Problem(model, tuple(near.starts), fit.effects, fit.quantities)
        between = solve(problem, fit.values, near.starts, steps=12, done=_NEAR)
        far = _alone(model, between, len(between.starts))
        fit = between
    if not fit.quantities:
        return fit_starts(
            Problem(model, tuple(far.starts), fit.effects, (), fit.values), far.starts
        )
    problem = Problem(model, tuple(far.starts), fit.effects, fit.quantities)
    return solve(problem, fit.values, far.starts, steps=40)


def _alone(model: Model, fit: Fit, most: int) -> Fit:
    """The same values over so many pieces joined into one, of which the starts alone are fitted."""
    starts: dict[Piece, Array] = {}
    for run in sorted({piece.run for piece in fit.starts}):
        pieces = sorted((p for p in fit.starts if p.run == run), key=lambda piece: piece.first)
        for k in range(0, len(pieces), most):
            together = pieces[k : k + most]
            one = Piece(run, together[0].first, together[-1].last)
            starts[one] = fit.starts[together[0]]
    problem = Problem(model, tuple(starts), fit.effects, (), fit.values)
    return fit_starts(problem, starts, steps=4)


_UNSEEN = 1e-3
"""Chi-square that says nothing of a quantity: of where along an edge a point of it is."""

FLOOR = 0.1
"""A misfit of a tenth of a sigma, RMS, is none: no machine is ever exactly its model."""


@dataclass(frozen=True)
class Explanation:
    """A set of effects, fitted in windows and over whole runs.

    misfit  mean square of the residuals over whole runs less 1, in sigma squared; 0 is the noise
    """

    chosen: tuple[Chosen, ...]
    windows: Fit
    whole: Fit

    @property
    def names(self) -> tuple[str, ...]:
        """The effects, in order of choice."""
        return tuple(one.name for one in self.chosen)

    @property
    def misfit(self) -> float:
        """Mean square over whole runs, less that of noise with as many quantities fitted."""
        return misfit(self.whole)

    @property
    def strain(self) -> float:
        """Chi-square of the parameters against what was known of them."""
        known = [q for q in self.whole.quantities if q.known and not q.free]
        return float(np.sum(scaled(known, self.whole.values) ** 2))

    @property
    def score(self) -> float:
        """Chi-square of data and knowledge, and what each quantity that they tell costs (BIC)."""
        added = [k for k, q in enumerate(self.whole.quantities) if not q.known]
        seen = self.whole.total().H[np.ix_(added, added)]
        told = int(np.linalg.matrix_rank(seen, tol=_UNSEEN, hermitian=True)) if added else 0
        return self.whole.cost + self.strain + told * math.log(self.whole.count)

    def apart(self) -> float:
        """Of what the effect that came last does, squared, the share that no values imitate."""
        fit, own = self.whole, f"{self.names[-1]}."
        total, u = fit.total(), fit.scaled
        its = np.array([q.name.startswith(own) for q in fit.quantities])
        neutral = scaled(fit.quantities, {q.name: q.neutral for q in fit.quantities})
        gone = (neutral - u)[its]
        push = total.H[np.ix_(~its, its)] @ gone
        does = float(gone @ total.H[np.ix_(its, its)] @ gone)
        imitated = float(push @ np.linalg.pinv(total.H[np.ix_(~its, ~its)], hermitian=True) @ push)
        return 1.0 - imitated / does if does > 0 else 0.0


def misfit(fit: Fit) -> float:
    """Mean square of the residuals in sigma, less 1."""
    return fit.cost / _freedom(fit) - 1.0


def chance(fit: Fit) -> float:
    """Of noise alone to leave as much."""
    return float(chi2.sf(fit.cost, _freedom(fit)))


def _freedom(fit: Fit) -> int:
    """The values there are beyond those that were fitted."""
    fitted = sum(start.size for start in fit.starts.values()) + len(fit.quantities)
    return max(fit.count - fitted, 1)


def rms(excess: float) -> float:
    """The misfit as RMS in sigma, 0 at or below the noise."""
    return math.sqrt(max(excess, 0.0))


def certain(excess: float, count: int, z: float = 3.1) -> float:
    """The misfit of so many values, RMS in sigma, less what noise reaches once in a thousand."""
    return rms(excess - z * math.sqrt(2 / max(count, 1)))


def left_out(fit: Fit) -> float:
    """Misfit of the runs, each predicted from the others: mean square in sigma, less 1."""
    if len(fit.normals) < 2:
        return float("nan")
    u, (low, high) = fit.scaled, box(fit.quantities)
    left = 0.0
    for piece, own in fit.normals.items():
        others = [n for other, n in fit.normals.items() if other != piece]
        rest = total(others, fit.prior, u)
        d = bounded_step(rest.H, rest.g, 1e-9, u, low, high) if u.size else u
        left += own.at(d)
    starts = sum(normal.shift.size for normal in fit.normals.values())
    return left / max(fit.count - starts, 1) - 1.0
