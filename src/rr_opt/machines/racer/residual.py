"""When no name fits: the push that the model lacks, as a function of what it depends on.

All terms of `residue_terms` are columns of one linearised problem at the fit. A set of terms is
judged by how well each run is predicted from the others with it, parameters re-fitted, so a
function that only follows one run's noise is not believed. The few that are kept are chosen one by
one.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.array import Array
from rr_opt.effects import CATALOGUE
from rr_opt.effects.effect import Effect
from rr_opt.machines.racer.observed import observed
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.machines.racer.residual_terms import Term, shape, terms
from rr_opt.machines.racer.unknown_input import Columns, Linearised, Point, linearised, moved
from rr_opt.sysid.candidate import FLOOR, Explanation
from rr_opt.sysid.diagnosis import Residue
from rr_opt.sysid.least_squares import Fit, doubt
from rr_opt.sysid.model import Piece
from rr_opt.sysid.selection import EXACT

MOST = 3
"""So many variables, at most."""

WORTH = 0.15
"""A term removes at least this share of the misfit that is left without it."""

MOSTLY = 0.5
"""A curve of friction over speed is kept before all else if it removes this share."""

LEAST = 0.15
"""And this share of the misfit there was at first."""

ALIKE = 0.05
"""Terms that differ by less of the misfit do about as well."""

PATTERN = 40.0
"""A gain in chi-square, in terms of model error, that noise and small model errors do not make."""

BORDERED = 0.03
"""A share of the misfit that a part of the floor may leave."""

_RATE = 50.0
"""So many samples a second are enough here: what is looked for is slower than the sampling."""

_AGAIN = 3
"""So often the problem is linearised again."""


def residue(
    model: RollerRacer,
    best: Explanation,
    each: Callable[..., Iterable] = map,
    *,
    by_speed: bool = False,
) -> tuple[Residue, ...]:
    """The functions that the model lacks beyond an explanation, the most telling first.

    Returns none where no function predicts the runs better, each from the others.

    by_speed  whether it is known that a rolling force over speed does by itself: what else would
              seem to help then makes up for what is not linear
    """
    fit = best.whole
    if best.misfit <= FLOOR**2:
        return ()
    ground = _ground(model, fit, each)
    every, sizes, places = ground.terms, ground.sizes, ground.places
    point = ground.begin
    problem = ground.at(point)
    most = 1 if by_speed else MOST
    chosen = _chosen(problem, places, most)
    for _ in range(_AGAIN if chosen else 0):
        point = moved(fit, point, problem, _joined(places, chosen))
        problem = ground.at(point)
        chosen = _chosen(problem, places, most)
    if not chosen:
        return ()
    values, spread = problem.curve(_joined(places, chosen))
    shares = _shares(problem, places, chosen)
    out, at = [], 0
    for k, share in zip(chosen, shares, strict=True):
        own = slice(at, at + places[k].size)
        at = own.stop
        out.append(_told(every[k], sizes[k], values[own], spread[own, own], share))
    return tuple(out)


def systematic(
    model: RollerRacer, best: Explanation, base: Explanation, each: Callable[..., Iterable] = map
) -> bool:
    """Whether what an explanation leaves, however little, still depends on something.

    Effects that imitate what is really there leave such a pattern. A servo that jumps and wheels
    that slide leave one even if the effect is right, as no two machines do so alike: not asked.
    Nor where it is next to nothing of what the parameters alone (`base`) leave, as no effect's
    model is exact; for a part of the floor that is more: where its border lies is a matter of
    millimetres.
    """
    effects = [CATALOGUE[name] for name in best.names]
    bordered = any(effect.family == "floor" and not effect.differentiable for effect in effects)
    if not best.chosen or any(_blurred(effect) for effect in effects):
        return False
    if best.misfit < (BORDERED if bordered else EXACT) ** 2 * base.misfit:
        return False
    ground = _ground(model, best.whole, each)
    problem = ground.at(ground.begin)
    before = problem.cost(_joined(ground.places, []))
    return any(
        before - after > PATTERN * doubt(after, problem.count)
        for after in (problem.cost(columns) for columns in ground.places)
    )


def _blurred(effect: Effect) -> bool:
    jumps = effect.actuate is not None and not effect.differentiable
    return jumps or any(q.model_form_error for q in effect.parameters)


@dataclass(frozen=True)
class _Ground:
    """All terms beside a fit: their usual sizes, the columns of each, and how they push."""

    model: RollerRacer
    fit: Fit
    begin: Point
    terms: Sequence[Term]
    sizes: Sequence[float]
    places: Sequence[Columns]
    pushes: Mapping[Piece, Array]
    each: Callable[..., Iterable]

    def at(self, point: Point) -> Linearised:
        """The linearised problem at a point."""
        weights = [term.weights for term in self.terms]
        return linearised(self.model, self.fit, point, self.pushes, weights, self.each)


def _ground(model: RollerRacer, fit: Fit, each: Callable[..., Iterable]) -> _Ground:
    less, starts = _thinned(model, fit)
    seen = {p: observed(less, p, fit.values, fit.effects, start) for p, start in starts.items()}
    slips = any(CATALOGUE[name].stiff for name in fit.effects)
    every = terms(list(seen.values()), model.nominal["h"], slips=slips)
    sizes = [term.kind.size(*_usual(model)) for term in every]
    pushes = {
        piece: np.concatenate([s * t.pushes(along) for t, s in zip(every, sizes, strict=True)])
        for piece, along in seen.items()
    }
    edges = np.cumsum([len(fit.quantities), *(term.columns for term in every)])
    places = [np.arange(a, b) for a, b in itertools.pairwise(edges)]
    begin = Point(fit.values, starts, np.zeros(edges[-1] - edges[0]))
    return _Ground(less, fit, begin, every, sizes, places, pushes, each)


def _thinned(model: RollerRacer, fit: Fit) -> tuple[RollerRacer, Mapping[Piece, Array]]:
    """The model with fewer samples, and the fit's starts of whole runs in it."""
    runs = []
    for run in model.experiment.runs:
        r = run.recording
        every = max(round(1 / (_RATE * float(np.median(np.diff(r.t))))), 1)
        few = {name: getattr(r, name) for name in ("values", "sigma", "flags")}
        few = {
            name: {key: column[::every] for key, column in one.items()} for name, one in few.items()
        }
        runs.append(replace(run, recording=replace(r, t=r.t[::every], **few)))
    less = RollerRacer(replace(model.experiment, runs=tuple(runs)))
    starts = {Piece(p.run, 0, len(less.runs[p.run].t)): start for p, start in fit.starts.items()}
    return less, starts


def _joined(places: Sequence[Columns], chosen: Sequence[int]) -> Columns:
    return np.concatenate([np.zeros(0, int), *(places[k] for k in chosen)])


def _chosen(problem: Linearised, places: Sequence[Columns], at_most: int) -> list[int]:
    """Which terms: one by one that which helps most."""
    chosen: list[int] = []
    first = now = problem.left(_joined(places, chosen))
    # Friction is a matter of speed before all else: its curve over speed, the first of the terms,
    # holds the constant part, and the others what varies with something else.
    by_speed = problem.left(_joined(places, [0]))
    if by_speed < (1 - MOSTLY) * first and first > FLOOR**2:
        chosen, now = [0], by_speed
    while len(chosen) < at_most and now > FLOOR**2:
        tried = {
            k: problem.left(_joined(places, [*chosen, k]))
            for k in range(len(places))
            if k not in chosen
        }
        most = min(tried.values())
        if most > (1 - WORTH) * now or now - most < LEAST * first:
            break
        # Of those that do about as well, the first in the list, which is the plainest.
        best = next(k for k in tried if tried[k] <= most + ALIKE * now)
        chosen, now = [*chosen, best], tried[best]
    return chosen


def _shares(problem: Linearised, places: Sequence[Columns], chosen: Sequence[int]) -> list[float]:
    """Of the misfit there was, what goes with each term, one after the other."""
    lefts = [problem.left(_joined(places, chosen[:n])) for n in range(len(chosen) + 1)]
    return [(a - max(b, 0.0)) / lefts[0] for a, b in itertools.pairwise(lefts)]


def _told(term: Term, size: float, values: Array, spread: Array, share: float) -> Residue:
    at = term.shown_at()
    basis = term.basis(at)
    mean = size * (values @ basis)
    error = size * np.sqrt(np.maximum(np.einsum("ik,ij,jk->k", basis, spread, basis), 0.0))
    words = shape(term.kind.says, term.variable.name, term.variable.unit, at, mean, error)
    article = "an" if term.kind.name[0] in "aeiou" else "a"
    sentence = f"What is left is {article} {term.kind.name} that {words}."
    return Residue(
        term.kind.name, term.variable.name, term.variable.unit, at, mean, error, share, sentence
    )


def _usual(model: RollerRacer) -> tuple[float, float]:
    """The viscous force on a wheel at the robot's speed, N, and that speed, m/s."""
    robot, speed = model.experiment.robot, model.setting.speed
    return (robot.k1 + robot.k2) / 2 * speed, speed
