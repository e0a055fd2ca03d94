"""Rank what may be missing without fitting it: one linearised pass over all effects at once.

At a fit without them, the derivatives by every effect's quantities at the value where it vanishes
say what the best of each would gain, parameters and starts re-fitted with it. Of an effect that
cannot be linearised there the model proposes from where to look for it, and what that promises.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.sysid.candidate import Chosen
from rr_opt.sysid.least_squares import (
    Fit,
    Problem,
    Quadratic,
    bounded_step,
    box,
    doubt,
    scaled,
    total,
)
from rr_opt.sysid.model import Model

LUCK = 25.0
"""So much lower a chi-square is, by luck, where the best of many places was chosen; times doubt."""


@dataclass(frozen=True)
class Promise:
    """What adding an effect would gain, in chi-square with what is known, linearised.

    begins  where to begin, if the effect jumps
    luck    what the best of many places that are nothing would promise
    """

    chosen: Chosen
    gain: float
    begins: tuple[Mapping[str, float], ...] = ()
    luck: float = 0.0


def linear(model: Model, chosen: Chosen) -> bool:
    """Whether the effect can be linearised where it vanishes."""
    return chosen.name not in model.jumping


@dataclass(frozen=True)
class Look:
    """A look for an effect that jumps, in all its forms, beside a fit; dear for some."""

    model: Model
    fit: Fit
    name: str

    def __call__(self) -> list[Promise]:
        """What each form promises, if it is proposed."""
        found = []
        for form in range(len(self.model.catalogue[self.name].forms)):
            proposals = self.model.propose(self.name, form, self.fit)
            if proposals:
                best = max(proposals, key=lambda proposal: proposal.gain)
                begins = tuple(proposal.values for proposal in proposals)
                luck = LUCK * best.doubt
                found.append(Promise(Chosen(self.name, form), best.gain, begins, luck))
        return found


def looks(model: Model, fit: Fit, have: Sequence[Chosen], *, dear: bool) -> list[Look]:
    """The looks for what jumps, beside a fit: of the dear ones, or of the others."""
    names = {one.name for one in have}
    return [
        Look(model, fit, name)
        for name in model.catalogue
        if name in model.jumping and (name in model.dear) == dear and name not in names
    ]


def every(model: Model) -> list[Chosen]:
    """Every effect in every form."""
    return [
        Chosen(name, form)
        for name, candidate in model.catalogue.items()
        for form in range(len(candidate.forms))
    ]


def screen(model: Model, fit: Fit, have: Sequence[Chosen]) -> list[Promise]:
    """What each effect promises beside those already there."""
    names = {one.name for one in have}
    new = [one for one in every(model) if one.name not in names and linear(model, one)]
    quantities = tuple(q for one in new for q in one.of(model).quantities)
    own = (*fit.quantities, *quantities)
    values = {q.name: q.neutral for q in quantities} | dict(fit.values)
    effects = (*fit.effects, *dict.fromkeys(one.name for one in new))
    problem = Problem(model, tuple(fit.starts), effects, own)
    normals = problem.normals(values, fit.starts).values()
    u, (low, high) = scaled(own, values), box(own)
    whole = total(normals, doubt(fit.cost, fit.count) * problem.prior, u)
    base = list(range(len(fit.quantities)))
    place = {q.name: k for k, q in enumerate(own)}
    promises = []
    for one in new:
        k = np.array(base + [place[q.name] for q in one.of(model).quantities])
        some = Quadratic(0.0, whole.g[k], whole.H[np.ix_(k, k)])
        d = bounded_step(some.H, some.g, 1e-9, u[k], low[k], high[k])
        promises.append(Promise(one, -some.at(d)))
    return sorted(promises, key=lambda promise: -promise.gain)
