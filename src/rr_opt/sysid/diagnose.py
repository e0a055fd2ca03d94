"""The whole diagnosis: is there a mismatch, is it values, where is it, what is it, how sure."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

from rr_opt.sysid.candidate import (
    FLOOR,
    Explanation,
    certain,
    chance,
    joined,
    left_out,
    misfit,
    nominal,
    parameters,
    rms,
    windows,
)
from rr_opt.sysid.diagnosis import Diagnosis, Finding, Mismatch, Tried
from rr_opt.sysid.evaluation import Level, level_of, other_forms, together
from rr_opt.sysid.least_squares import Fit, Problem, recorded, solve
from rr_opt.sysid.model import Model
from rr_opt.sysid.selection import Search
from rr_opt.sysid.values import estimates, settled, wrong
from rr_opt.sysid.verdict import LEFT, NEAR, confidence, finding, verdict_of

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


def diagnose(model: Model, steps: Steps | None = None) -> Diagnosis:
    """Diagnose a machine from its runs."""
    return answer(found(model, steps or Steps()))


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
        rough=search.rounds.rough(best),
        systematic=systematic,
    )
    together = it.together if verdict == "missing_physics" else None
    findings = _findings(it.best, search, intervals, (level1, level2), it.rivals)
    if verdict == "parameters":
        findings = tuple(Finding(q.name, 1.0, {q.name: intervals[q.name]}, 1.0) for q in moved)
    if verdict in ("consistent", "unexplained"):
        findings = ()
    channel = model.catalogue[best.names[0]].channel if findings and best.names else "none"
    return Diagnosis(
        verdict=verdict,
        summary=summary_of(verdict, findings, level0, level2, together, apart=held_out_alone(it)),
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
        together=together and together.held(),
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
    sure = confidence(best, rivals, max(rms(search.base.misfit), rms(before)))
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


def held_out_alone(it: Found) -> tuple[str, ...]:
    """The held-out recordings in which alone something shows: those fitted are explained as they
    are, so that nothing was looked for."""
    base = it.search.base
    if it.best.chosen or certain(base.misfit, base.whole.count) > FLOOR:
        return ()
    held = [one for one in it.levels[1].misfits if one.held_out]
    return tuple(one.recording for one in held if one.rms**2 > 1 + LEFT**2)


def summary_of(
    verdict: str,
    findings: tuple[Finding, ...],
    before: Level,
    after: Level,
    together: Level | None = None,
    *,
    apart: tuple[str, ...] = (),
) -> str:
    """The answer in two sentences, or three.

    apart  the recordings that show alone what is left out
    """
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
        "consistent": "The model explains the recordings as it is."
        if before.unseen() ** 2 - after.unseen() ** 2 < FLOOR**2
        else "The model explains the recordings, with values within their stated uncertainty.",
        "parameters": f"The model is right, but these values are not: {names}.",
        "missing_physics": f"The model leaves out {names}.",
        "unexplained": "Something is left out, and no effect of the catalogue accounts for it.",
    }[verdict]
    if together:
        numbers += (
            " The others do not tell all values; those given here fit all recordings, "
            f"and leave {together.held():.2f} sigma."
        )
    if apart and verdict == "unexplained":
        opening = (
            f"Something is left out that shows in held-out recordings alone: {', '.join(apart)}. "
            "Those that were fitted lack nothing, so nothing was looked for. Hold out others "
            "instead, and diagnose again."
        )
    return f"{opening} {numbers}"
