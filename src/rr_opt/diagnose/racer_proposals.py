"""From where to look for the effects of a Roller Racer that jump, and what each promises.

What the servo does shows in the joint's angle alone, which needs no dynamics: the values that fit
the angle best are where to begin. A patch of other floor is looked for on a map of it. Slipping
wheels are linearised where they slip.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy.optimize import minimize_scalar

from rr_opt.diagnose.explain import windows
from rr_opt.diagnose.fit import Fit, Problem, bounded_step, box, doubt, scaled, solve
from rr_opt.diagnose.floor_map import Found, cells_of, drags, likely
from rr_opt.diagnose.model import Form, Model, Proposal
from rr_opt.diagnose.normal import total
from rr_opt.diagnose.observed import observed
from rr_opt.diagnose.racer_protocol import Racer
from rr_opt.diagnose.residue_problem import Point, linearised
from rr_opt.diagnose.screen import LUCK

_TRIED = 14
"""Values of an effect of the servo, between next to nothing and a lot."""

_MUCH, _SHORT = 2.0, 1.0
"""With more misfit, mean square in sigma, a patch is looked for over so many seconds as well."""


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
            r = (model.angle(run, given, used) - data.values[:, -1]) / data.sigma[:, -1]
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
    return [Proposal({q.name: value}, before - least)]


def of_slip(model: Racer, name: str, form: Form, fit: Fit) -> Sequence[Proposal]:
    """Where the form says, and what one step from there promises."""
    quantities = (*fit.quantities, *form.quantities)
    problem = Problem(model, tuple(fit.starts), (*fit.effects, name), quantities)
    low, high = box(quantities)
    prior = problem.prior * doubt(fit.cost, fit.count)
    before = fit.cost + float(fit.prior @ fit.scaled**2)
    found = []
    for start in form.starts:
        values = {**fit.values, **start}
        parts = [problem.normal(piece, values, begin) for piece, begin in fit.starts.items()]
        u = scaled(quantities, values)
        whole = total(parts, prior, u)
        d = bounded_step(whole.H, whole.g, 1e-9, u, np.maximum(low, u - 3), np.minimum(high, u + 3))
        found.append(Proposal(start, before - whole.at(d)))
    return found


def of_patch(model: Racer, fit: Fit) -> tuple[Sequence[Proposal], Sequence[Proposal]]:
    """Circles and edges that would gain most; see `floor_map`.

    A strong patch takes a robot far from where it would be without, and the map is blurred. So
    where much is left it is looked for over pieces too that are too short for that.
    """
    circles, edges = _on_map(model, fit)
    if fit.cost > _MUCH * fit.count:
        pieces = windows(model, sorted({p.run for p in fit.starts}), _SHORT)
        problem = Problem(model, pieces, fit.effects, fit.quantities)
        short = solve(problem, fit.values, {piece: model.start(piece) for piece in pieces})
        more_circles, more_edges = _on_map(model, short)
        round_one, straight = model.catalogue["floor_patch"].forms
        circles += _refined(model, short, round_one, more_circles)
        edges += _refined(model, short, straight, more_edges)
    return circles, edges


def _refined(model: Model, fit: Fit, form: Form, places: Sequence[Proposal]) -> list[Proposal]:
    """The best place on the map, if there is one, fitted over the pieces of a fit without it."""
    if not places or places[0].gain < LUCK * doubt(fit.cost, fit.count):
        return []
    place, own = places[0], form.quantities
    quantities = (*fit.quantities, *own)
    problem = Problem(model, tuple(fit.starts), (*fit.effects, "floor_patch"), quantities)
    fitted = solve(problem, {**fit.values, **place.values}, fit.starts)
    return [Proposal({q.name: fitted.values[q.name] for q in own}, fit.cost - fitted.cost)]


def _on_map(model: Racer, fit: Fit) -> tuple[list[Proposal], list[Proposal]]:
    cells = cells_of([model.runs[piece.run].values[piece.span, :2] for piece in fit.starts])
    given = {**model.nominal, **fit.values}
    k = np.repeat([given["kappa1"], given["kappa2"]], 2) / given["h"] ** 2
    pushes = {
        piece: drags(cells, observed(model, piece, fit.values, fit.effects, start), k)
        for piece, start in fit.starts.items()
    }
    n, added = len(fit.quantities), len(cells.centres)
    point = Point(fit.values, fit.starts, np.zeros(added))
    problem = linearised(model, fit, point, pushes, [np.zeros((added, added))])
    whole = total(problem.normals.values(), problem.prior, problem.u)
    H, g = whole.H, whole.g
    onto = np.linalg.pinv(H[:n, :n], hermitian=True) @ H[:n, n:] if n else H[:0, n:]
    circles, edges = likely(cells, g[n:] - onto.T @ g[:n], H[n:, n:] - onto.T @ H[:n, n:])
    return _named(circles), _named(edges)


def _named(places: Sequence[Found]) -> list[Proposal]:
    return [
        Proposal({f"floor_patch.{key}": value for key, value in values.items()}, gain)
        for gain, values in places
    ]
