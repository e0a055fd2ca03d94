"""The whole diagnosis: is there a mismatch, is it values, where is it, what is it, how sure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rr_opt.diagnose.diagnosis import Diagnosis, Finding, Mismatch, Tried
from rr_opt.diagnose.explanation import FLOOR, Explanation, certain, chance, misfit, rms
from rr_opt.diagnose.found import Found, Steps, found
from rr_opt.diagnose.intervals import estimates
from rr_opt.diagnose.left_out import left_out
from rr_opt.diagnose.level import Level
from rr_opt.diagnose.model import Model
from rr_opt.diagnose.search import Search
from rr_opt.diagnose.values import wrong
from rr_opt.diagnose.verdict import LEFT, confidence, finding, verdict_of


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
