"""The steps of a diagnosis: the model as believed, with other values, with what is missing."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

from rr_opt.diagnose.agreement import other_forms, together
from rr_opt.diagnose.explain import joined, nominal, parameters, windows
from rr_opt.diagnose.explanation import Explanation, misfit, rms
from rr_opt.diagnose.fit import Fit, solve
from rr_opt.diagnose.level import Level, level_of
from rr_opt.diagnose.model import Model
from rr_opt.diagnose.problem import Problem, recorded
from rr_opt.diagnose.search import Search
from rr_opt.diagnose.values import settled
from rr_opt.diagnose.verdict import LEFT, NEAR

_BETTER = 0.5
"""Of the held-out misfit that the parameters alone leave, RMS, an effect has to leave less."""

Say = Callable[[str], None]
T = TypeVar("T")


@dataclass
class Steps:
    """Who hears of progress, how work is shared out, and how long each step took."""

    say: Say = lambda _: None
    each: Callable[..., Iterable] = map
    seconds: dict[str, float] = field(default_factory=dict)

    def timed(self, name: str, work: Callable[[], T]) -> T:
        """Say it, do it, and note how long it took."""
        self.say(name)
        begun = time.perf_counter()
        try:
            return work()
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - begun


@dataclass(frozen=True)
class Found:
    """What the steps of a diagnosis found.

    levels    the model as believed, with its parameters re-estimated, and with what is missing
    together  with what is missing, fitted to all recordings, where those that were not fitted told
              what the others left open
    """

    model: Model
    search: Search
    best: Explanation
    levels: tuple[Level, Level, Level]
    steps: Steps
    together: Level | None = None

    @property
    def rivals(self) -> list[Explanation]:
        """The explanations without one of the accepted effects, the best first."""
        own = set(self.best.names)
        rivals = [one for one in self.search.tried if not own <= set(one.names)]
        return sorted(rivals, key=lambda one: one.score)


def found(model: Model, steps: Steps) -> Found:
    """Fit the model, its parameters, and what may be missing."""
    fitted = [k for k, run in enumerate(model.runs) if not run.held_out]
    held = [k for k, run in enumerate(model.runs) if run.held_out]
    start = steps.timed(
        "the model as it is believed to be", lambda: nominal(model, windows(model, fitted + held))
    )
    first = _of_runs(model, start, fitted)
    level0 = steps.timed(
        "against the recordings", lambda: level_of(model, joined(model, start), start)
    )
    believed = rms(misfit(_of_runs(model, level0.fit, fitted)))
    base = steps.timed("its parameters", lambda: _base(model, first))
    level1 = steps.timed("held-out recordings", lambda: level_of(model, base.whole, level0.fit))
    search = Search(model, first, base, believed, steps.say, steps.each)
    best = steps.timed("what is missing", search.run)
    best, level2 = steps.timed(
        "which values are wrong", lambda: _that_predicts(model, best, search.tried, level0.fit)
    )
    every = steps.timed("all recordings", lambda: _together(model, best, (level1, level2)))
    return Found(model, search, best, (level0, level1, level2), steps, every)


def _that_predicts(
    model: Model, best: Explanation, tried: Sequence[Explanation], start: Fit
) -> tuple[Explanation, Level]:
    """The explanation and what it leaves; where that predicts badly, in the form of those that the
    fitted recordings do not tell apart that predicts best."""

    def told(one: Explanation) -> tuple[Explanation, Level]:
        one = settled(model, _plainest(model, one))
        return one, level_of(model, one.whole, start)

    first = told(best)
    if not any(run.held_out for run in model.runs) or rms(first[1].held() ** 2 - 1) <= LEFT:
        return first
    others = [told(one) for one in other_forms(best, tried)]
    return min([first, *others], key=lambda pair: pair[1].held())


def _plainest(model: Model, best: Explanation) -> Explanation:
    """The explanation, or its twin that is nearer to what was believed."""
    fit = best.whole
    twin = model.twin(fit.values)
    if twin is None:
        return best
    problem = Problem(model, tuple(fit.starts), fit.effects, fit.quantities)
    other = solve(problem, twin, fit.starts)
    return replace(best, whole=other) if other.cost < fit.cost + 1.0 else best


def _together(model: Model, best: Explanation, levels: tuple[Level, Level]) -> Level | None:
    """The explanation fitted to all recordings, where those held out were predicted better with it
    than without, but not well."""
    before, after = (rms(level.held() ** 2 - 1) for level in levels)
    if not best.chosen or not NEAR < after < _BETTER * before:
        return None
    if not any(run.held_out for run in model.runs):
        return None
    fit = together(model, best, levels[1].starts)
    level = fit and level_of(model, fit, fit)
    return level if level and level.held() ** 2 - 1 < LEFT**2 else None


def _base(model: Model, first: Fit) -> Explanation:
    fit = parameters(model, first)
    return Explanation((), fit, joined(model, fit))


def _of_runs(model: Model, fit: Fit, runs: list[int]) -> Fit:
    pieces = [piece for piece in fit.starts if piece.run in runs]
    return replace(
        fit,
        starts={piece: fit.starts[piece] for piece in pieces},
        normals={piece: fit.normals[piece] for piece in pieces},
        cost=sum(fit.normals[piece].cost for piece in pieces),
        count=recorded(model, pieces),
    )
