"""Score tests: what each smooth effect would gain, from one linearised pass for all of them.

At a fit without an effect, the log likelihood's gradient by the effect's quantities is its score.
With the information matrix it gives the likelihood gain of a Newton step, everything else refitted
(Rao 1948), and an initial guess. Only the few most promising effects are fitted.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from rr_opt.array import Array, Indices
from rr_opt.sysid.estimation import Fit, FitProblem, Linear, bounded_minimum, root
from rr_opt.sysid.model import Choice, Linearisation, Request, Segment
from rr_opt.sysid.settings import SETTINGS


@dataclass(frozen=True)
class Score:
    """Expected gain of adding some effects to a fit, in -2 log likelihood less the Occam penalty of
    their quantities, and initial values."""

    choices: tuple[Choice, ...]
    gain: float
    guess: Mapping[str, float]


def with_all(fit: Fit) -> tuple[str, ...]:
    """The fit's effects, and all that it lacks to first order."""
    return tuple(sorted((*fit.effects, *_lacking(fit).values())))


def _lacking(fit: Fit) -> dict[str, str]:
    """The effects that a fit lacks and a diagnosis may name, each with the one that equals it to
    first order: if it is smooth, itself."""
    every = fit.problem.model.catalogue.items()
    named = {n: info for n, info in every if info.named and n not in fit.effects}
    return {n: info.tangent or n for n, info in named.items() if info.smooth or info.tangent}


def scores(fit: Fit, most: int) -> list[Score]:
    """Scores of all effects that the fit lacks and that have a first order, and of all pairs of
    them; best first. Without those that gain nothing: at a bound, a step leaves them out."""
    model, problem = fit.problem.model, fit.problem
    # Each effect's quantities, under its name.
    own = {
        Choice(name, k): {q.name.replace(tangent, name, 1): q for q in form.quantities}
        for name, tangent in _lacking(fit).items()
        for k, form in enumerate(model.catalogue[tangent].forms)
    }
    if not own:
        return []
    added = {q.name: q for some in own.values() for q in some.values()}
    quantities = (*problem.quantities, *added.values())
    effects = with_all(fit)
    values = {**fit.values, **{q.name: q.neutral for q in added.values()}}
    states = {
        one: model.converted(Request(one, values, state), effects)
        for one, state in fit.states.items()
    }
    wide = replace(problem, effects=effects, quantities=quantities)
    requests = wide.requests(values, states)
    made = dict(zip(wide.segments, model.simulate(requests, effects), strict=True))
    test = ScoreTest.of(Linear.of(wide, values, states, made), values, len(problem.quantities))
    where = {q.name: k for k, q in enumerate(quantities)}
    out = []
    for size in (1, 2)[:most]:
        for these in itertools.combinations(own, size):
            if len({one.name for one in these}) < size:
                continue
            some = {name: q for one in these for name, q in own[one].items()}
            gain, occam, d = test.gain([where[q.name] for q in some.values()])
            if all(any(d[where[q.name]] for q in own[one].values()) for one in these):
                guess = {name: q.neutral + d[where[q.name]] * q.scale for name, q in some.items()}
                out.append(Score(tuple(sorted(these)), gain - occam, guess))
    return sorted(out, key=lambda score: -score.gain)


def secants(fit: Fit, problem: FitProblem, parts: Mapping[Segment, Linearisation]) -> list[float]:
    """What a share of each finite change of a prediction would gain, as a score: a derivative says
    nothing of effects that set in suddenly.

    problem  the fit's, or a part of it
    parts    its segments linearised in the quantities and then in the changes
    """
    linear, fitted = Linear(problem, fit.linear.made, parts, fit.states), len(problem.names)
    test = ScoreTest.of(linear, fit.values, fitted, (0.0, SETTINGS.largest_share))
    gains = (test.gain([k]) for k in range(fitted, test.g.size))
    return [gain - occam for gain, occam, _ in gains]


@dataclass(frozen=True)
class ScoreTest:
    """The loss value + 2 g'd + d'Hd of a linearised problem, and of further columns.

    low, high  bounds of d;  prior  precisions;  fitted  how many are in the fit
    """

    H: Array
    g: Array
    low: Array
    high: Array
    prior: Array
    fitted: int

    @classmethod
    def of(
        cls,
        linear: Linear,
        values: Mapping[str, float],
        fitted: int,
        bounds: tuple[float, float] = (-np.inf, np.inf),
    ) -> ScoreTest:
        """At these values; `bounds` are those of columns beyond the quantities."""
        problem, every = linear.problem, linear.evidences(linear.problem.q).values()
        columns = np.zeros(next(iter(every)).g.size - len(problem.names))
        u = problem.scaled(values)
        prior = np.append(problem.prior, columns + SETTINGS.effect_prior**-2)
        g = prior * np.append(u, columns) + sum(e.g for e in every)
        H = np.diag(prior) + sum(e.H for e in every)
        low, high = (
            np.append(end - u, columns + far) for end, far in zip(problem.box, bounds, strict=True)
        )
        return cls(H, g, low, high, prior, fitted)

    def keep(self, own: Sequence[int]) -> Indices:
        """What is in the fit, and these."""
        return np.array([*range(self.fitted), *own], np.int64)

    def gain(self, own: Sequence[int]) -> tuple[float, float, Array]:
        """Gain in -2 log likelihood if these are fitted too, within the bounds; the Occam penalty;
        and the step d."""
        (before, less, _), (after, more, d) = self._fit, self._lowered(own)
        return after - before, more - less, d

    @cached_property
    def _fit(self) -> tuple[float, float, Array]:
        return self._lowered([])

    def _lowered(self, own: Sequence[int]) -> tuple[float, float, Array]:
        keep, d = self.keep(own), np.zeros(self.g.size)
        if not keep.size:
            return 0.0, 0.0, d
        H = self.H[np.ix_(keep, keep)]
        d[keep] = bounded_minimum(H, self.g[keep], self.low[keep], self.high[keep])
        lowered = -float(2 * self.g @ d + d @ self.H @ d)
        log = 2 * float(np.sum(np.log(np.diag(root(H)))))
        return lowered, log - float(np.sum(np.log(self.prior[keep]))), d
