"""From recordings to a diagnosis: search, evaluate, weigh, locate, and state the confidence.

segments -> estimation -> selection -> intervals, remainder -> verdict
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace

from rr_opt.sysid.candidates import Candidate, first, refitted
from rr_opt.sysid.diagnosis import Diagnosis, summary_of
from rr_opt.sysid.estimation import solve
from rr_opt.sysid.evaluation import evaluation, mismatch
from rr_opt.sysid.intervals import estimates, released, wrong
from rr_opt.sysid.machine import MachineModel
from rr_opt.sysid.model import ChannelNoise
from rr_opt.sysid.noise import noise_in
from rr_opt.sysid.remainder import dependences, residues, stages, where
from rr_opt.sysid.selection import Selection, turned
from rr_opt.sysid.verdict import (
    Identification,
    findings,
    named,
    remainder_of,
    rival_of,
    ties,
    tried,
    verdict_of,
)


@dataclass
class Stopwatch:
    """Reports progress, and records how long each step took, s."""

    progress: Callable[[str], None] = lambda _: None
    seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def __call__(self, step: str) -> Iterator[None]:
        """Time a step."""
        self.progress(step)
        began = time.perf_counter()
        try:
            yield
        finally:
            spent = time.perf_counter() - began
            self.seconds[step] = self.seconds.get(step, 0.0) + spent


def diagnose(model: MachineModel, progress: Callable[[str], None] = lambda _: None) -> Diagnosis:
    """Diagnose any machine from its runs; `progress` is called with each step."""
    watch = Stopwatch(progress)
    result = identified(model, watch)
    with watch("planning the next recording"):
        rival = rival_of(result)
        # With the noise that was estimated.
        model = result.selection.model
        plan = model.next_experiment(result.best.fit, rival and (rival[0], rival[1].fit))
    found = replace(_answer(result), next_experiment=plan, seconds=dict(watch.seconds))
    worth = model.worth(found.nominal, found.final)
    return replace(found, summary=summary_of(found, worth, result.doubt))


def _answer(result: Identification) -> Diagnosis:
    verdict, selection, best = verdict_of(result), result.selection, result.best
    model, base = selection.model, selection.base
    found = named(result, verdict)
    faulty = verdict in ("missing_physics", "unexplained")
    located = stages(selection.dependences, model.inputs, base.excess, faulty=faulty)
    guilty = next((one for one in located if one.guilty), None)
    channel = guilty.channel if guilty else "none"
    if verdict == "missing_physics" and found:
        channel = model.catalogue[found[0].name].channel
    levels = (result.nominal, result.refitted, result.final)
    fit, known, last, beside = best.fit, result.estimates, result.final, result.after
    if verdict == "unexplained":
        # The best predictor, though what it still lacks cannot be named.
        last = min(levels, key=lambda one: one.rms)
        if last is not result.final:
            fit, known, beside = base.fit, estimates(base.fit), selection.dependences
    remainder = remainder_of(result, last)
    if remainder.size != "none" and beside:
        remainder = replace(remainder, depends_on=where(beside[0], model.inputs))
    return Diagnosis(
        verdict=verdict,
        summary="",
        mismatch=mismatch(base),
        channel=channel,
        where=guilty.where if guilty else "",
        stages=located,
        findings=found,
        suspects=findings(result, result.suspected),
        parameters=known,
        tried=tried(selection, best if verdict != "unexplained" else None),
        ties=ties(result, verdict),
        next_experiment=None,
        residue=tuple(residues(beside, model.inputs)) if verdict == "unexplained" else (),
        nominal=result.nominal.misfits,
        refitted=result.refitted.misfits,
        final=last.misfits,
        before=result.nominal.rms,
        after=last.rms,
        values={**fit.values, **last.values},
        seconds={},
        converged=best.fit.converged,
        remainder=replace(remainder, matters=model.accuracy(last.misfits)),
    )


def _quieter(selection: Selection) -> list[ChannelNoise] | None:
    """The noise, if the search shows less than was assumed; more may be what the answer lacks."""
    noise = noise_in(selection.best.simulated) or []
    lower = [replace(one, level=min(one.level, 1.0)) for one in noise]
    return lower if any(one.quieter for one in lower) else None


def identified(model: MachineModel, watch: Stopwatch) -> Identification:
    """Search for what is missing, with the noise estimated from the nominal model's residuals; once
    more if the answer shows less noise."""
    runs = [k for k, run in enumerate(model.runs) if not run.held_out]
    with watch("fitting the parameters"):
        base = first(model, runs)
        if noise := noise_in(base.simulated):
            model = model.with_noise(noise)
            base = first(model, runs)
    with watch("looking for what is missing"):
        selection = Selection.begun(model, base, watch.progress)
        if quieter := _quieter(selection):
            selection = selection.again(quieter)
        selection.run()
        if quieter := _quieter(selection):
            watch.progress("the noise is lower than estimated: repeating")
            selection = selection.again(quieter)
            selection.run()
    result = weighed(selection, watch)
    best = result.best
    with watch("locating the fault"):
        after = selection.dependences
        if best.choices or wrong(best.fit):
            after = dependences(best.fit, *selection.model.unknown_inputs(best.fit))
    return replace(result, after=after)


def weighed(selection: Selection, watch: Stopwatch) -> Identification:
    """The answer of a search, with the evidence for and against it."""
    model, runs = selection.model, list(selection.base.fit.problem.by_run)
    best = turned(model, selection.best)
    with watch("looking for wrong values"):
        # Iterated to full convergence.
        fit = solve(best.fit.problem, best.fit.values, best.fit.states, known=best.fit.linear)
        if selection.insignificant(best):
            fit = released(fit)
        best = Candidate(best.choices, fit)
    with watch("predicting every recording"):
        base = selection.base.fit
        believed = {q.name: q.value for q in model.parameters}
        levels = (
            evaluation(base, believed),
            evaluation(base, base.values),
            evaluation(fit, fit.values),
        )
        everywhere, plain = best, selection.base
        if len(runs) < len(model.runs):
            every = range(len(model.runs))
            everywhere = refitted(best, every)
            plain = refitted(plain, every) if best.choices else everywhere
    return Identification(selection, best, everywhere, plain, *levels)
