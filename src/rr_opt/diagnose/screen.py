"""Rank what may be missing without fitting it: one linearised pass over all effects at once.

At a fit without them, the derivatives by every effect's quantities at the value where it vanishes
say what the best of each would gain, parameters and starts re-fitted with it. Of an effect that
cannot be linearised there the model proposes from where to look for it, and what that promises.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.diagnose.explain import Chosen
from rr_opt.diagnose.fit import Fit, Problem, bounded_step, box, doubt, scaled
from rr_opt.diagnose.model import Array, Model


@dataclass(frozen=True)
class Promise:
    """What adding effects would leave of the cost, linearised.

    begins  where to begin, if the effect jumps
    """

    chosen: tuple[Chosen, ...]
    cost: float
    begins: tuple[Mapping[str, float], ...] = ()


def linear(model: Model, chosen: Chosen) -> bool:
    """Whether the effect can be linearised where it vanishes."""
    return chosen.name not in model.jumping


def jumps(model: Model, fit: Fit, have: Sequence[Chosen], *, dear: bool) -> list[Promise]:
    """What those that jump promise, beside a fit: of the dear ones, or of the others."""
    names = {one.name for one in have}
    new = [
        one
        for one in every(model)
        if one.name in model.jumping and (one.name in model.dear) == dear and one.name not in names
    ]
    found = []
    for one in new:
        proposals = model.propose(one.name, one.form, fit)
        if proposals:
            gain = max(proposal.gain for proposal in proposals)
            begins = tuple(proposal.values for proposal in proposals)
            found.append(Promise((one,), fit.cost - gain, begins))
    return sorted(found, key=lambda promise: promise.cost)


def every(model: Model) -> list[Chosen]:
    """Every effect in every form."""
    return [
        Chosen(name, form)
        for name, candidate in model.catalogue.items()
        for form in range(len(candidate.forms))
    ]


def screen(model: Model, fit: Fit, have: Sequence[Chosen], together: int = 1) -> list[Promise]:
    """What each effect, or each set of `together`, promises beside those already there."""
    names = {one.name for one in have}
    new = [one for one in every(model) if one.name not in names and linear(model, one)]
    quantities = tuple(q for one in new for q in one.of(model).quantities)
    own = (*fit.quantities, *quantities)
    values = {q.name: q.neutral for q in quantities} | dict(fit.values)
    effects = (*fit.effects, *dict.fromkeys(one.name for one in new))
    problem = Problem(model, tuple(fit.starts), effects, own)
    normals = [problem.normal(piece, values, start) for piece, start in fit.starts.items()]
    u = scaled(own, values)
    prior = problem.prior * doubt(fit.cost, fit.count)
    g = sum((n.g for n in normals), prior * u)
    H = sum((n.H for n in normals), np.diag(prior))
    whole = sum(n.cost for n in normals) + prior @ u**2
    low, high = box(own)
    base = list(range(len(fit.quantities)))
    place = {q.name: k for k, q in enumerate(own)}
    promises = []
    for some in itertools.combinations(new, together):
        if len({one.name for one in some}) < together:
            continue
        k = np.array(base + [place[q.name] for one in some for q in one.of(model).quantities])
        d = _best(g[k], H[np.ix_(k, k)], u[k], low[k], high[k])
        promises.append(Promise(some, float(whole + 2 * g[k] @ d + d @ H[np.ix_(k, k)] @ d)))
    return sorted(promises, key=lambda promise: promise.cost)


def _best(g: Array, H: Array, u: Array, low: Array, high: Array) -> Array:
    return bounded_step(H, g, 1e-9, u, low, high)
