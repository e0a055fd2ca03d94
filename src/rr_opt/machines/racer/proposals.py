"""From where to look for the effects of a Roller Racer that jump, and what each promises.

From where to look for wheels that slip: where fits of a few pieces of the runs lead lowest.

Wheels that hardly slide, or slide all the time, do not tell how they would with another grip, so
many grips are tried. Parameters that were bent to imitate slipping wheels hide them, so each is
tried with the parameters of a fit, and with those that are believed.

What the servo does shows in the joint's angle alone, which needs no dynamics: the values that fit
the angle best are where to begin. A patch of other floor is looked for on a map of it. For slipping
wheels see `slip_proposals`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize_scalar

from rr_opt.array import Array
from rr_opt.machines.racer.floor_map import ROUND, STRAIGHT, floor_map, likely
from rr_opt.machines.racer.simulation import Racer
from rr_opt.sysid.candidate import windows
from rr_opt.sysid.least_squares import (
    Fit,
    Problem,
    bounded_step,
    box,
    doubt,
    fit_starts,
    scaled,
    solve,
    total,
)
from rr_opt.sysid.model import Form, Model, Piece, Proposal

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


_TRIED = 14
"""Values of an effect of the servo, between next to nothing and a lot."""

_LONG = 3
"""Windows that a piece may last in which a patch is looked for that does not show in one."""


def of_servo(model: Racer, name: str, form: Form, fit: Fit) -> Sequence[Proposal]:
    """The value that fits the recorded angle best; phi is the last channel."""
    (q,) = form.quantities
    effects = (*fit.effects, name)
    runs = sorted({piece.run for piece in fit.starts})

    def left(value: float, used: tuple[str, ...] = effects) -> float:
        given = {**model.nominal, **fit.values, q.name: value}
        total = 0.0
        for run in runs:
            data = model.runs[run]
            r = (model.simulated.angle(run, given, used) - data.values[:, -1]) / data.sigma[:, -1]
            total += float(np.nansum(r**2))
        return total

    before = left(q.neutral, fit.effects)
    count = sum(int(np.isfinite(model.runs[run].values[:, -1]).sum()) for run in runs)
    if before < count + 4 * math.sqrt(2 * count):
        return []  # noise alone
    if q.neutral:
        values = q.scale * np.geomspace(0.25, 1.0, _TRIED)
    else:
        values = q.scale * np.geomspace(0.05, 5.0, _TRIED)
    found = [left(value) for value in values]
    k = int(np.argmin(found))
    low, high = values[max(k - 1, 0)], values[min(k + 1, _TRIED - 1)]
    best = minimize_scalar(left, bounds=(low, high), method="bounded", options={"maxiter": 12})
    least, value = min((float(best.fun), float(best.x)), (found[k], float(values[k])))
    return [Proposal({q.name: value}, before - least, doubt(fit.cost, fit.count))]


def of_patch(model: Racer, fit: Fit) -> tuple[Sequence[Proposal], Sequence[Proposal]]:
    """Circles and edges that would gain most; see `floor_map`."""
    plain = _unbent(model, fit)
    floor = floor_map(model, plain)
    # The map fits the parameters too: what they leave is what a gain is weighed against.
    fitted = plain.starts.keys() == fit.starts.keys()
    unsure = doubt(min(plain.cost, fit.cost) if fitted else plain.cost, plain.count)
    round_ones, straight = (_named(likely(floor, shape), unsure) for shape in (ROUND, STRAIGHT))
    return round_ones, straight


def _unbent(model: Racer, fit: Fit) -> Fit:
    """The fit over pieces that are short enough for a map, of which the starts alone are fitted.

    In windows parameters are as they are believed to be: a strong patch has bent them to imitate
    it. What only shows over whole runs may be little, and they are as fitted; or it is in few runs,
    and they are as believed if that leaves less.
    """
    runs = sorted({piece.run for piece in fit.starts})
    believed = {q.name: q.value if q.known else fit.values[q.name] for q in fit.quantities}
    if len(fit.starts) > len(runs):
        return _starts_alone(model, fit, list(fit.starts), believed)
    pieces = windows(model, runs, _LONG * model.window)
    tried = [_starts_alone(model, fit, pieces, values) for values in (fit.values, believed)]
    return min(tried, key=lambda one: one.cost)


def _starts_alone(
    model: Racer, fit: Fit, pieces: Sequence[Piece], values: Mapping[str, float]
) -> Fit:
    """The fit over other pieces, or with other values, of which the starts alone are fitted."""
    problem = Problem(model, pieces, fit.effects, (), values)
    starts = {piece: fit.starts.get(piece, model.start(piece)) for piece in pieces}
    return replace(fit_starts(problem, starts), quantities=fit.quantities, values=values)


def _named(places: Sequence[tuple[float, Mapping[str, float]]], unsure: float) -> list[Proposal]:
    return [
        Proposal({f"floor_patch.{key}": value for key, value in values.items()}, gain, unsure)
        for gain, values in places
    ]
