"""What a fit leaves of every recording, also of those it did not see.

Do recordings that were held out contradict an explanation, or tell what the others left open?

Two recordings along one side of a patch do not tell how wide it is, and one that goes around it is
then predicted wrong, through no fault of the explanation. So it is fitted to all recordings: where
values that those fitted first allow as well leave nothing in the others, these contradict nothing.
Nor do they often tell whether a patch is round or has a straight border, which says what is behind
the edge that was seen: then those held out tell.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2

from rr_opt.array import Array
from rr_opt.sysid.candidate import Explanation, certain, left_out, whole
from rr_opt.sysid.diagnosis import Misfit
from rr_opt.sysid.least_squares import Fit, Problem, doubt, fit_starts, recorded, solve
from rr_opt.sysid.model import Model, Piece

_POOR = 1.1
"""With more misfit a run's start is looked for from elsewhere too, mean square in sigma."""


@dataclass(frozen=True)
class Level:
    """A fit of the shared quantities and what it leaves of every run, held out or not.

    starts  of all runs, whole
    """

    fit: Fit
    misfits: tuple[Misfit, ...]
    starts: Mapping[Piece, Array]

    def held(self) -> float:
        """RMS in sigma over the held-out runs; over the fitted ones where none is held out."""
        return _rms_of(self.misfits, held_out=True)

    def unseen(self) -> float:
        """The same for the answer; where none is held out, of the runs each predicted from the
        others. The verdict does not rest on that: of two or three runs, one may be all that tells a
        parameter, and what the others say of it is then far off through no fault of the model."""
        apart = float("nan")
        if not any(one.held_out for one in self.misfits):
            apart = left_out(self.fit)
        return math.sqrt(apart + 1.0) if np.isfinite(apart) else self.held()

    def surplus(self) -> float:
        """What `unseen` is above the noise and a usual chance of it, mean square in sigma."""
        return certain(self.unseen() ** 2 - 1, self.count(), z=1.0) ** 2

    def count(self) -> int:
        """The values that this is of."""
        return int(np.isfinite(_residuals(self.misfits, held_out=True)).sum())


def level_of(model: Model, fit: Fit, start: Fit) -> Level:
    """What a fit leaves of every run: those it did not see get the start that fits them best."""
    seen = {piece.run for piece in fit.starts}
    pieces = whole(model, range(len(model.runs)))
    first = {piece.run: state for piece, state in start.starts.items() if piece.first == 0}
    problem = Problem(model, pieces, fit.effects, (), fit.values)
    fresh = [piece for piece in pieces if piece.run not in seen]
    starts = {**fit.starts, **_best_starts(problem, {p: first[p.run] for p in fresh})}
    misfits = tuple(_misfit(problem, piece, starts[piece]) for piece in pieces)
    return Level(fit, misfits, {piece: starts[piece] for piece in pieces})


def _best_starts(problem: Problem, first: Mapping[Piece, Array]) -> dict[Piece, Array]:
    """Each run's start: from the first guess that leaves little, else from that which leaves least.

    Where dry friction holds a machine at first, the misfit has no slope by its starting speed.
    Where a border is crossed or not, a long run has wrong minima.
    """
    costs: dict[Piece, float] = {}
    best: dict[Piece, Array] = {}
    model = problem.model
    guesses: tuple[Callable[[Piece], Array], ...] = (
        lambda piece: first[piece],
        model.start,
        lambda piece: _grown(problem, piece),
    )
    for guess in guesses:
        poor = [p for p in first if p not in costs or costs[p] > _POOR * recorded(model, [p])]
        if not poor:
            break
        starts = _started(problem, {piece: guess(piece) for piece in poor}).starts
        for piece, cost in problem.costs({}, starts).items():
            if piece not in costs or cost < costs[piece]:
                costs[piece], best[piece] = cost, starts[piece]
    return best


def _grown(problem: Problem, piece: Piece) -> Array:
    """The start that fits the run's beginning, and then three times as much of it at a time."""
    model = problem.model
    t = model.runs[piece.run].t
    start, seconds = model.start(piece), model.window
    while seconds < t[-1] - t[0]:
        part = replace(piece, last=int(np.searchsorted(t, t[0] + seconds)))
        start = _started(problem, {part: start}).starts[part]
        seconds *= 3
    return start


def _started(problem: Problem, starts: Mapping[Piece, Array]) -> Fit:
    alone = Problem(problem.model, tuple(starts), problem.effects, (), problem.fixed)
    return fit_starts(alone, starts)


def _misfit(problem: Problem, piece, start) -> Misfit:
    data = problem.model.runs[piece.run]
    response = problem.model.respond(piece, problem.fixed, problem.effects, start)
    r = (response.predicted - data.values) / data.sigma
    channels = {
        name: float(np.sqrt(np.nanmean(r[:, k] ** 2)))
        for k, name in enumerate(problem.model.channels)
        if np.isfinite(r[:, k]).any()
    }
    total = float(np.sqrt(np.nanmean(r**2)))
    return Misfit(data.name, data.held_out, total, channels, data.t, response.predicted, r)


def _rms_of(misfits: tuple[Misfit, ...], *, held_out: bool) -> float:
    return float(np.sqrt(np.nanmean(_residuals(misfits, held_out=held_out) ** 2)))


def _residuals(misfits: tuple[Misfit, ...], *, held_out: bool) -> Array:
    some = [m for m in misfits if m.held_out == held_out] or list(misfits)
    return np.concatenate([m.residuals.ravel() for m in some])


_CHANCE = 1e-3
"""Of values that are right to lie so far from those fitted first."""

_TIE = 6.0
"""A lead in score by which odds are 20 to 1; less does not tell one form from another."""


def together(model: Model, best: Explanation, starts: Mapping[Piece, Array]) -> Fit | None:
    """An explanation fitted to all recordings; none if those fitted first speak against it.

    starts  of the recordings, whole, as far as they are known
    """
    first = best.whole
    problem = Problem(model, tuple(starts), first.effects, first.quantities)
    fit = solve(problem, first.values, starts)
    after = sum(fit.normals[piece].cost for piece in first.starts)
    allowed = chi2.isf(_CHANCE, len(first.quantities)) * doubt(first.cost, first.count)
    return fit if after - first.cost <= allowed else None


def other_forms(best: Explanation, tried: Sequence[Explanation]) -> list[Explanation]:
    """The same effects in other forms, which the recordings fitted do not tell from these."""
    tie = _TIE * doubt(best.whole.cost, best.whole.count)
    return [
        one
        for one in tried
        if set(one.names) == set(best.names)
        and set(one.chosen) != set(best.chosen)
        and one.score < best.score + tie
    ]
