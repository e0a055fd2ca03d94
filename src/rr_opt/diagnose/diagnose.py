"""The whole diagnosis: is there a mismatch, is it values, where is it, what is it, how sure."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np

from rr_opt.diagnose.agreement import together
from rr_opt.diagnose.diagnosis import Diagnosis, Finding, Misfit, Mismatch, Tried
from rr_opt.diagnose.explain import joined, nominal, parameters, whole, windows
from rr_opt.diagnose.explanation import Explanation, certain, chance, misfit, rms
from rr_opt.diagnose.fit import Fit, Problem, solve
from rr_opt.diagnose.intervals import estimates
from rr_opt.diagnose.left_out import left_out
from rr_opt.diagnose.model import Array, Model, Piece
from rr_opt.diagnose.search import Search
from rr_opt.diagnose.values import settled, wrong
from rr_opt.diagnose.verdict import LEFT, NEAR, confidence, finding, verdict_of

_BETTER = 0.5
"""Of the held-out misfit that the parameters alone leave, RMS, an effect has to leave less."""

_POOR = 1.1
"""With more misfit a run's start is looked for from elsewhere too, mean square in sigma."""

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
class Level:
    """A fit of the shared quantities and what it leaves of every run, held out or not.

    starts  of all runs, whole
    """

    fit: Fit
    misfits: tuple[Misfit, ...]
    starts: Mapping[Piece, Array]

    def held(self) -> float:
        """RMS in sigma over the held-out runs; over the fitted ones where none is held out."""
        return _rms_of(self.misfits, held_out=True)

    def unseen(self) -> float:
        """The same for the answer; where none is held out, of the runs each predicted from the
        others. The verdict does not rest on that: of two or three runs, one may be all that tells a
        parameter, and what the others say of it is then far off through no fault of the model."""
        apart = float("nan")
        if not any(one.held_out for one in self.misfits):
            apart = left_out(self.fit)
        return math.sqrt(apart + 1.0) if np.isfinite(apart) else self.held()

    def surplus(self) -> float:
        """What `unseen` is above the noise and a usual chance of it, mean square in sigma."""
        return certain(self.unseen() ** 2 - 1, self.count(), z=1.0) ** 2

    def count(self) -> int:
        """The values that this is of."""
        return int(np.isfinite(_residuals(self.misfits, held_out=True)).sum())


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


def diagnose(model: Model, steps: Steps | None = None) -> Diagnosis:
    """Diagnose a machine from its runs."""
    return answer(found(model, steps or Steps()))


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
    best = steps.timed("which values are wrong", lambda: settled(model, _plainest(model, best)))
    level2 = level_of(model, best.whole, level0.fit)
    every = steps.timed("all recordings", lambda: _together(model, best, (level1, level2)))
    return Found(model, search, best, (level0, level1, level2), steps, every)


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
    seen = (model.runs[piece.run].values[piece.span] for piece in pieces)
    return replace(
        fit,
        starts={piece: fit.starts[piece] for piece in pieces},
        normals={piece: fit.normals[piece] for piece in pieces},
        cost=sum(fit.normals[piece].cost for piece in pieces),
        count=sum(int(np.isfinite(values).sum()) for values in seen),
    )


def level_of(model: Model, fit: Fit, start: Fit) -> Level:
    """What a fit leaves of every run: those it did not see get the start that fits them best."""
    seen = {piece.run for piece in fit.starts}
    pieces = whole(model, range(len(model.runs)))
    first = {piece.run: state for piece, state in start.starts.items() if piece.first == 0}
    problem = Problem(model, pieces, fit.effects, (), fit.values)
    fresh = [piece for piece in pieces if piece.run not in seen]
    alone = Problem(model, fresh, fit.effects, (), fit.values)
    starts = dict(fit.starts)
    if fresh:
        starts |= _best_starts(alone, first)
    misfits = tuple(_misfit(problem, piece, starts[piece]) for piece in pieces)
    return Level(fit, misfits, {piece: starts[piece] for piece in pieces})


def _best_starts(problem: Problem, first: Mapping[int, Array]) -> dict[Piece, Array]:
    """Each run's start: from the first guess that leaves little, else from that which leaves least.

    first  guesses, by run
    """
    out: dict[Piece, Array] = {}
    for piece in problem.pieces:
        fits: list[Fit] = []
        for guess in _guesses(problem, piece, first[piece.run]):
            fits.append(_started(problem, piece, guess))
            if fits[-1].cost <= _POOR * fits[-1].count:
                break
        out |= min(fits, key=lambda fit: fit.cost).starts
    return out


def _guesses(problem: Problem, piece: Piece, first: Array) -> Iterator[Array]:
    """Where dry friction holds a machine at first, the misfit has no slope by its starting speed.

    Where a border is crossed or not, a long run has wrong minima.
    """
    yield first
    yield problem.model.start(piece)
    yield _grown(problem, piece)


def _grown(problem: Problem, piece: Piece) -> Array:
    """The start that fits the run's beginning, and then three times as much of it at a time."""
    model = problem.model
    t = model.runs[piece.run].t
    start, seconds = model.start(piece), model.window
    while seconds < t[-1] - t[0]:
        part = replace(piece, last=int(np.searchsorted(t, t[0] + seconds)))
        start = _started(problem, part, start).starts[part]
        seconds *= 3
    return start


def _started(problem: Problem, piece: Piece, start: Array) -> Fit:
    alone = Problem(problem.model, [piece], problem.effects, (), problem.fixed)
    return solve(alone, {}, {piece: start})


def _misfit(problem: Problem, piece, start) -> Misfit:
    data = problem.model.runs[piece.run]
    response = problem.model.respond(piece, problem.fixed, problem.effects, start)
    r = (response.predicted - data.values) / data.sigma
    channels = {
        name: float(np.sqrt(np.nanmean(r[:, k] ** 2)))
        for k, name in enumerate(problem.model.channels)
        if np.isfinite(r[:, k]).any()
    }
    total = float(np.sqrt(np.nanmean(r**2)))
    return Misfit(data.name, data.held_out, total, channels, data.t, response.predicted, r)


def _rms_of(misfits: tuple[Misfit, ...], *, held_out: bool) -> float:
    return float(np.sqrt(np.nanmean(_residuals(misfits, held_out=held_out) ** 2)))


def _residuals(misfits: tuple[Misfit, ...], *, held_out: bool) -> Array:
    some = [m for m in misfits if m.held_out == held_out] or list(misfits)
    return np.concatenate([m.residuals.ravel() for m in some])


def answer(it: Found, *, systematic: bool = False) -> Diagnosis:
    """What was found as an answer; see `verdict_of`."""
    model, search, best, levels, steps = it.model, it.search, it.best, it.levels, it.steps
    level0, level1, level2 = levels
    told = it.together or level2
    best = replace(best, whole=told.fit)
    held = tuple(certain(level.held() ** 2 - 1, level.count()) for level in (level0, level1, told))
    intervals = estimates(model, best.whole, told.surplus())
    moved = wrong(best.whole)
    nominal_left = max(rms(misfit(level0.fit)), held[0])
    apart = held[1], held[2]
    verdict = verdict_of(
        *(best, search.base, nominal_left, apart, model.inexact),
        moved=bool(moved),
        rough=search.rough(best),
        systematic=systematic,
    )
    findings = _findings(it.best, search, intervals, (level1, level2), it.rivals)
    if verdict == "parameters":
        findings = tuple(Finding(q.name, 1.0, {q.name: intervals[q.name]}, 1.0) for q in moved)
    if verdict in ("consistent", "unexplained"):
        findings = ()
    channel = model.catalogue[best.names[0]].channel if findings and best.names else "none"
    return Diagnosis(
        verdict=verdict,
        summary=summary_of(verdict, findings, level0, level2, it.together),
        mismatch=Mismatch(rms(search.base.misfit), chance(search.base.whole)),
        channel=channel,
        where="",
        stages=(),
        findings=findings,
        parameters={q.name: intervals[q.name] for q in best.whole.quantities},
        tried=tuple(
            _tried(one, best if verdict != "unexplained" else None)
            for one in sorted(search.tried, key=lambda e: e.score)
        ),
        indistinguishable=(),
        next_experiment=None,
        residue=(),
        nominal=level0.misfits,
        refitted=level1.misfits,
        final=level2.misfits,
        before=level0.unseen(),
        after=level2.unseen(),
        values=dict(best.whole.values),
        seconds=dict(steps.seconds),
        converged=best.whole.converged,
    )


def _findings(
    best: Explanation,
    search: Search,
    intervals: Mapping,
    levels: tuple[Level, Level],
    rivals: list[Explanation],
) -> tuple[Finding, ...]:
    before = max(levels[0].held() ** 2 - 1, 1e-12)
    after = max(levels[1].held() ** 2 - 1, 0.0)
    sure = confidence(best, rivals)
    out = []
    for name in best.names:
        rest = set(best.names) - {name}
        without = [e for e in search.tried if set(e.names) == rest]
        left = max(without[0].misfit, 0.0) if without else before
        removes = min(max((left - max(best.misfit, 0.0)) / before, 0.0), 1.0) if without else 1.0
        if len(best.names) == 1:
            removes = min(max(1 - after / before, 0.0), 1.0)
        out.append(finding(name, sure, intervals, removes))
    return tuple(sorted(out, key=lambda f: -f.removes))


def _tried(one: Explanation, accepted: Explanation | None) -> Tried:
    return Tried(
        one.names,
        rms(one.misfit),
        rms(left_out(one.whole)),
        one.score,
        {k: v for k, v in one.whole.values.items() if "." in k},
        accepted is not None and one.chosen == accepted.chosen,
    )


def summary_of(
    verdict: str,
    findings: tuple[Finding, ...],
    before: Level,
    after: Level,
    together: Level | None = None,
) -> str:
    """The answer in two sentences, or three."""
    held = any(one.held_out for one in after.misfits)
    where = (
        "On recordings that were not fitted"
        if held
        else "On each recording, predicted from the others,"
        if len(after.misfits) > 1
        else "On the one recording there is, which was fitted,"
    )
    numbers = (
        f"{where} the simulation was {before.unseen():.2f} sigma off, "
        f"and is {after.unseen():.2f} sigma off now; 1 is the noise."
    )
    names = " and ".join(one.name.replace("_", " ") for one in findings)
    opening = {
        "consistent": "The model explains the recordings as it is.",
        "parameters": f"The model is right, but these values are not: {names}.",
        "missing_physics": f"The model leaves out {names}.",
        "unexplained": "Something is left out, and no effect of the catalogue accounts for it.",
    }[verdict]
    if verdict == "missing_physics" and together:
        numbers += (
            " The others do not tell all values; those given here fit all recordings, "
            f"and leave {together.held():.2f} sigma."
        )
    return f"{opening} {numbers}"
