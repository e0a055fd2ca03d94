"""From where to look for the effects of a Roller Racer that jump, and what each promises.

What the servo does shows in the joint's angle alone, which needs no dynamics: the values that fit
the angle best are where to begin. A patch of other floor is looked for on a map of it. For slipping
wheels see `slip_proposals`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import minimize_scalar

from rr_opt.diagnose.explain import windows
from rr_opt.diagnose.fit import Fit
from rr_opt.diagnose.floor_map import floor_map
from rr_opt.diagnose.floor_shapes import ROUND, STRAIGHT, likely
from rr_opt.diagnose.model import Form, Piece, Proposal
from rr_opt.diagnose.problem import Problem, doubt
from rr_opt.diagnose.racer_protocol import Racer
from rr_opt.diagnose.starts import fit_starts

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
