"""From where to look for wheels that slip: where fits of a few pieces of the runs lead lowest.

Wheels that hardly slide, or slide all the time, do not tell how they would with another grip, so
many grips are tried. Parameters that were bent to imitate slipping wheels hide them, so each is
tried with the parameters of a fit, and with those that are believed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.diagnose.fit import Fit, solve
from rr_opt.diagnose.model import Array, Form, Model, Piece, Proposal
from rr_opt.diagnose.normal import bounded_step, total
from rr_opt.diagnose.problem import Problem, box, doubt, scaled
from rr_opt.diagnose.starts import fit_starts

_PIECES, _KEPT, _STEPS = 8, 2, 8
"""Pieces that are looked at; of the places, how many are fitted, in so many steps."""


def of_slip(model: Model, name: str, form: int, fit: Fit) -> Sequence[Proposal]:
    """The best place of a form; none of one that another has all of, as a fit of that one leads
    there too, and a search drops what it can do without."""
    forms = model.catalogue[name].forms
    own = {q.name for q in forms[form].quantities}
    fuller = [one for one in forms if own < {q.name for q in one.quantities}]
    if fuller and _many(forms[form]):
        return []
    return _Look(model, name, forms[form], fit).proposals()


def _many(form: Form) -> bool:
    return len(form.starts) > 1


@dataclass(frozen=True)
class _Look:
    model: Model
    name: str
    form: Form
    fit: Fit

    def proposals(self) -> Sequence[Proposal]:
        every = tuple(self.fit.starts)
        some = every[:: max(len(every) // _PIECES, 1)]
        quantities = (*self.fit.quantities, *self.form.quantities)
        problem = Problem(self.model, some, (*self.fit.effects, self.name), quantities)
        less = Problem(self.model, some, self.fit.effects, self.fit.quantities)
        starts = {piece: self.fit.starts[piece] for piece in some}
        before, count = less.cost(self.fit.values, starts)
        places = self._places(problem, self.fit.values, starts)
        plain = {**self.fit.values} | {q.name: q.value for q in self.fit.quantities if q.known}
        if _many(self.form):
            alone = Problem(self.model, some, self.fit.effects, (), plain)
            places += self._places(problem, plain, fit_starts(alone, starts, steps=4).starts)
        fits = [solve(problem, values, starts, steps=_STEPS) for values, starts in places]
        weight = doubt(before, count)
        costs = [one.cost + weight * problem.beforehand(one.values) for one in fits]
        best = int(np.argmin(costs))
        gain = before + weight * less.beforehand(self.fit.values) - costs[best]
        values = {q.name: fits[best].values[q.name] for q in self.form.quantities}
        return [Proposal(values, gain * len(every) / len(some), weight)]

    def _places(
        self, problem: Problem, values: Mapping[str, float], starts: Mapping[Piece, Array]
    ) -> list[tuple[Mapping[str, float], Mapping[Piece, Array]]]:
        """The few from which one step promises most, and the starts of the pieces."""
        each = [{**values, **place} for place in self.form.starts]
        each.sort(key=lambda values: _after(problem, values, starts, self.fit))
        return [(values, starts) for values in each[:_KEPT]]


def _after(
    problem: Problem, values: Mapping[str, float], starts: Mapping[Piece, Array], fit: Fit
) -> float:
    """The cost that one step promises."""
    low, high = box(problem.quantities)
    u = scaled(problem.quantities, values)
    parts = problem.normals(values, starts)
    whole = total(parts.values(), doubt(fit.cost, fit.count) * problem.prior, u)
    near, far = np.maximum(low, u - 3), np.minimum(high, u + 3)
    return whole.at(bounded_step(whole.H, whole.g, 1e-9, u, near, far))
