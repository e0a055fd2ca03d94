"""Score tests: what each smooth effect would gain, from one linearised pass for all of them.

At a fit without an effect, the log likelihood's gradient by the effect's quantities is its score.
With the information matrix it gives the likelihood gain of a Newton step, everything else refitted
(Rao 1948), and an initial guess. Only the few most promising effects are fitted.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.array import Array
from rr_opt.sysid.estimation import Fit, FitProblem, Linear, States, bounded_minimum, root, summed
from rr_opt.sysid.model import Choice, Linearisation, Quantity, Request, Segment, Simulation
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
    test = _Test.of(Linear.of(wide, values, states, made), values, len(problem.quantities))
    where = {q.name: k for k, q in enumerate(quantities)}
    out = []
    for size in (1, 2)[:most]:
        for these in itertools.combinations(own, size):
            if len({one.name for one in these}) < size:
                continue
            some = {name: q for one in these for name, q in own[one].items()}
            gain, d = test.gain([where[q.name] for q in some.values()])
            if all(any(d[where[q.name]] for q in own[one].values()) for one in these):
                guess = {name: q.neutral + d[where[q.name]] * q.scale for name, q in some.items()}
                out.append(Score(tuple(sorted(these)), gain, guess))
    return sorted(out, key=lambda score: -score.gain)


def secants(
    problem: FitProblem,
    values: Mapping[str, float],
    states: States,
    made: Mapping[Segment, Simulation],
    every: Mapping[Segment, Linearisation],
) -> list[float]:
    """What a share of each finite change of a prediction would gain, as a score: a derivative says
    nothing of effects that set in suddenly.

    every  the segments linearised in the quantities and then in the changes
    """
    fitted, size = len(problem.quantities), next(iter(states.values())).size
    count = next(iter(every.values())).end.shape[1] - size - fitted
    shares = tuple(
        Quantity(f"share {k}", "", 0.0, 1.0, False, 0.0, SETTINGS.largest_share, 0.0)
        for k in range(count)
    )
    wide = replace(problem, quantities=(*problem.quantities, *shares))
    values = {**values, **{q.name: 0.0 for q in shares}}
    test = _Test.of(Linear.scaled(wide, every, states, made), values, fitted)
    return [test.gain([fitted + k])[0] for k in range(count)]


@dataclass(frozen=True)
class _Test:
    H: Array
    g: Array
    u: Array
    box: tuple[Array, Array]
    fitted: int
    prior: Array

    @classmethod
    def of(cls, linear: Linear, values: Mapping[str, float], fitted: int) -> _Test:
        """Of what comes after the first `fitted` quantities of a linearised problem."""
        problem = linear.problem
        u = problem.scaled(values)
        H, g, _ = summed(problem, linear.evidences(problem.q), u)
        return cls(H, g, u, problem.box, fitted, problem.prior)

    def gain(self, own: Sequence[int]) -> tuple[float, Array]:
        """Gain in -2 log marginal likelihood of some further columns, and the step."""
        (before, _), (after, d) = self._lowered([]), self._lowered(own)
        return after - before, d

    def _lowered(self, own: Sequence[int]) -> tuple[float, Array]:
        keep = np.array([*range(self.fitted), *own], int)
        d = np.zeros(self.u.size)
        if not keep.size:
            return 0.0, d
        H, g = self.H[np.ix_(keep, keep)], self.g[keep]
        low, high = (end[keep] - self.u[keep] for end in self.box)
        d[keep] = bounded_minimum(H, g, low, high)
        lowered = -float(2 * self.g @ d + d @ self.H @ d)
        log = 2 * float(np.sum(np.log(np.diag(root(H)))))
        return lowered - log + float(np.sum(np.log(self.prior[keep]))), d
