"""From recordings to a diagnosis: evaluate, search, weigh, and say how sure it is.

    segments -> estimation -> selection -> intervals, remainder -> verdict

The verdict is graded. Effects are named that the recordings' predictions of one another call for
and that explain most of the misfit; what is left beside them is the remainder. Only where no effect
is shown is the answer `unexplained`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.stats import chi2

from rr_opt.sysid.candidates import Candidate, Choice, weights
from rr_opt.sysid.diagnosis import Diagnosis, Finding, Mismatch, Remainder, Tried, Verdict
from rr_opt.sysid.evaluation import Evaluation, evaluation
from rr_opt.sysid.intervals import estimates, named, released, wrong
from rr_opt.sysid.model import Model
from rr_opt.sysid.selection import Selection
from rr_opt.sysid.settings import SETTINGS


@dataclass
class Stopwatch:
    """Tells what is being done, and remembers how long each step took, s."""

    progress: Callable[[str], None] = lambda _: None
    seconds: dict[str, float] = field(default_factory=dict)

    def __call__(self, step: str) -> _Timed:
        """Time a step."""
        self.progress(step)
        return _Timed(self, step)


@dataclass
class _Timed:
    watch: Stopwatch
    step: str
    began: float = 0.0

    def __enter__(self) -> None:
        self.began = time.perf_counter()

    def __exit__(self, *_: object) -> None:
        spent = time.perf_counter() - self.began
        self.watch.seconds[self.step] = self.watch.seconds.get(self.step, 0.0) + spent


@dataclass(frozen=True)
class Result:
    """What the diagnosis rests on.

    best      the candidate that was chosen, with values that are wrong released
    nominal, refitted, final   as believed; with the parameters fitted; with what is missing
    """

    selection: Selection
    best: Candidate
    nominal: Evaluation
    refitted: Evaluation
    final: Evaluation

    @cached_property
    def confidences(self) -> Mapping[str, float]:
        """Of each effect: the weight of the candidates that have it, by how they predict
        recordings; less where more is left in recordings that were not fitted than a small part of
        the misfit, or than machines differ from such models, as then it may imitate something
        else."""
        tried = list(self.selection.tried.values())
        info, left = self.selection.model.catalogue, max(self.final.excess, 1e-12)
        form = sum(info[name].form_error for name in self.best.effects) * self.nominal.excess
        first = max(self.refitted.excess, self.selection.base.excess)
        small = SETTINGS.small * first**2
        allowed = form**2 + small + (2 * SETTINGS.negligible) ** 2
        sound = min(1.0, allowed / left**2) ** 2
        own = list(zip(weights(tried), tried, strict=True))
        return {
            name: float(sound * sum(w for w, one in own if name in one.effects))
            for name in self.best.effects
        }

    @property
    def shown(self) -> tuple[Choice, ...]:
        """The effects that are more likely missing than not."""
        own = self.confidences
        return tuple(c for c in self.best.choices if own[c.name] > SETTINGS.named)

    @property
    def complete(self) -> bool:
        """Whether what the candidate leaves is no more than machines differ from such models."""
        return self.selection.complete(self.best)

    @property
    def share(self) -> float:
        """What is left of the nominal model's misfit beyond the noise (mean square), 0 to 1, in
        recordings that were not fitted where there are any."""
        before = max(self.nominal.excess, self.selection.base.excess)
        after = max(self.final.excess, 0.0)
        return float(np.clip((after / before) ** 2, 0.0, 1.0)) if before > 0 else 0.0

    @property
    def rivals(self) -> list[Candidate]:
        """Candidates without one of the effects, the best first."""
        own = set(self.best.effects)
        others = [c for c in self.selection.tried.values() if not own <= set(c.effects)]
        return sorted(others, key=lambda one: -one.elpd)


def identified(model: Model, watch: Stopwatch) -> Result:
    """Search for what is missing."""
    runs = [k for k, run in enumerate(model.runs) if not run.held_out]
    with watch("fitting the parameters"):
        selection = Selection(model, runs, watch.progress)
    with watch("looking for what is missing"):
        best = selection.run()
    with watch("looking for wrong values"):
        fit = best.fit
        if selection.complete(best):
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
    return Result(selection, best, *levels)


def verdict_of(result: Result) -> Verdict:
    """See above."""
    if result.shown:
        return "missing_physics"
    if result.best.choices or not result.complete:
        return "unexplained"
    slight = result.selection.allowance(result.best)
    if result.nominal.excess**2 > slight and wrong(result.best.fit):
        return "parameters"
    return "consistent"


def findings(result: Result) -> tuple[Finding, ...]:
    """The effects that are shown, strongest first."""
    base = max(result.selection.base.excess, 1e-12) ** 2
    out = []
    for choice in result.shown:
        rest = tuple(one for one in result.best.choices if one != choice)
        without = result.selection.tried.get(rest, result.selection.base)
        left = without.excess**2 if rest else base
        removes = float(np.clip((left - result.best.excess**2) / base, 0.0, 1.0))
        if not rest:
            removes = 1.0 - result.share
        values = named(result.best.fit, choice.name)
        out.append(Finding(choice.name, result.confidences[choice.name], values, removes))
    return tuple(sorted(out, key=lambda one: -one.removes))


def remainder_of(result: Result) -> Remainder:
    """What is left with the answer's effects."""
    after = result.final.excess
    share = result.share if result.best.choices else float(after > 0)
    if after <= 2 * SETTINGS.negligible:
        size = "none"
    else:
        size = "small" if share <= SETTINGS.small else "large"
    return Remainder(size, after, share)


def answer(result: Result, watch: Stopwatch) -> Diagnosis:
    """The result as a diagnosis; the machine adds where, what depends on it, what to do next."""
    verdict, selection, best = verdict_of(result), result.selection, result.best
    told = findings(result) if verdict == "missing_physics" else ()
    intervals = estimates(best.fit)
    if verdict == "parameters":
        told = tuple(
            Finding(q.name, 1.0, {q.name: intervals[q.name]}, 1.0) for q in wrong(best.fit)
        )
    base = selection.base.fit
    used = len(base.problem.names)
    misfit = sum(e.excess for e in base.evidences.values())
    channel = selection.model.catalogue[told[0].name].channel if best.choices and told else "none"
    levels = (result.nominal, result.refitted, result.final)
    return Diagnosis(
        verdict=verdict,
        summary="",
        mismatch=Mismatch(
            selection.base.excess,
            float(chi2.sf(base.samples + misfit, max(base.samples - used, 1))),
        ),
        channel=channel,
        where="",
        stages=(),
        findings=told,
        parameters={q.name: intervals[q.name] for q in best.fit.problem.quantities},
        tried=_tried(selection, best if verdict != "unexplained" else None),
        indistinguishable=_alike(result) if told else (),
        next_experiment=None,
        residue=(),
        nominal=levels[0].misfits,
        refitted=levels[1].misfits,
        final=levels[2].misfits,
        before=levels[0].rms,
        after=levels[2].rms,
        values=dict(best.fit.values),
        seconds=dict(watch.seconds),
        converged=best.fit.converged,
        remainder=remainder_of(result),
    )


def _tried(selection: Selection, accepted: Candidate | None) -> tuple[Tried, ...]:
    """All candidates; the score is twice the log predictive density lost against the best."""
    every = sorted(selection.tried.values(), key=lambda one: -one.elpd)
    return tuple(
        Tried(
            one.effects,
            one.excess if "simulated" in one.__dict__ else _roughly(one),
            -2 * one.elpd,
            {k: v for k, v in one.fit.values.items() if "." in k},
            accepted is not None and one.choices == accepted.choices,
        )
        for one in every
    )


def _roughly(one: Candidate) -> float:
    """What a candidate that was not simulated whole leaves with its process noise."""
    return one.fit.excess


def _alike(result: Result) -> tuple[tuple[str, ...], ...]:
    """Sets of effects that predict the recordings about as well as the answer does."""
    own = result.best
    near = []
    for one in result.rivals:
        gain, error = own.advantage(one)
        if gain < max(SETTINGS.evidence, SETTINGS.standard_errors * error) and one.effects:
            near.append(tuple(one.effects))
    groups = [tuple(dict.fromkeys((*own.effects, *one))) for one in near]
    return tuple(dict.fromkeys(groups))


def rival_of(result: Result) -> tuple[str, Candidate] | None:
    """The candidate that comes next, of those that a recording may yet tell from the answer."""
    for one in result.rivals[:1]:
        gain, error = result.best.advantage(one)
        if gain < max(4 * SETTINGS.evidence, error):
            return " and ".join(one.effects) or "other parameters", one
    return None


def diagnose(model: Model, progress: Callable[[str], None] = lambda _: None) -> Diagnosis:
    """Diagnose any machine from its runs; progress is told each step."""
    watch = Stopwatch(progress)
    found = answer(identified(model, watch), watch)
    return replace(found, summary=summary_of(found))


def summary_of(found: Diagnosis, worth: str = "") -> str:
    """What was found, how sure, what it is worth, what remains, what to record next.

    worth  what it is worth in the machine's own terms: `the place was 8 mm off and is 1 mm off; `
    """
    listed = " and ".join(one.name.replace("_", " ") for one in found.findings)
    sure = ", ".join(f"{one.confidence:.0%}" for one in found.findings)
    opening = {
        "consistent": "The nominal model explains the recordings.",
        "parameters": f"The model is right, but the value of {listed} is not.",
        "missing_physics": f"The model leaves out {listed} (confidence {sure}).",
        "unexplained": "Something is left out, and no effect of the catalogue accounts for it.",
    }[found.verdict]
    held = any(one.held_out for one in found.final)
    which = "recordings that were not fitted" if held else "the recordings, which were all fitted"
    misfit = (
        f"On {which}, {worth}the misfit fell from {found.before:.2f} to {found.after:.2f} sigma, "
        "where 1 is the noise."
    )
    remainder, remains = found.remainder, ""
    if found.verdict != "consistent" and remainder.size != "none":
        depends = f": {remainder.depends_on}" if remainder.depends_on else ""
        share = f"{remainder.share:.0%} of the misfit"
        remains = f"What remains is {remainder.size} ({share}){depends}."
    doubtful = found.verdict != "consistent" and (remains or found.indistinguishable)
    plan = found.next_experiment.sentence if found.next_experiment and doubtful else ""
    return " ".join(part for part in (opening, misfit, remains, plan) if part)
