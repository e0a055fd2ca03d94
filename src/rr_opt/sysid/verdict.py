"""The outcome of a search: which effects are shown, with what confidence, and what remains.

The verdict is graded. An effect is named if cross-validation over recordings calls for it and its
misfit is too small for an imitation; what remains is the remainder. Only if no effect is shown is
the answer `unexplained`.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import expit

from rr_opt.formatting import words_of
from rr_opt.messages import listed
from rr_opt.sysid.candidates import Candidate
from rr_opt.sysid.constancy import Constancy, constancy
from rr_opt.sysid.diagnosis import Estimate, Finding, Remainder, Tie, Tried, Verdict
from rr_opt.sysid.estimation import overdispersion
from rr_opt.sysid.evaluation import Evaluation
from rr_opt.sysid.intervals import estimates, instead_of, joint, wrong
from rr_opt.sysid.model import Choice
from rr_opt.sysid.remainder import Dependence, where
from rr_opt.sysid.selection import Selection
from rr_opt.sysid.settings import SETTINGS

_CHANGED = "Check whether something changed between the recordings."
_DIFFER = "Record gaits that differ more."
_LOOK = "Look for a cause where the remaining misfit shows."

_DISAGREE = "the recordings disagree on the values"
_SO_MANY = "that many effects can mimic almost anything"
_EXCEEDS = "the remaining misfit exceeds the usual error of such models"
_UNCONFIRMED = "the held-out recordings do not confirm it"
_LEAD = "its lead is too small for these recordings to be conclusive"
_REMAINS = "most of the misfit remains"
_OTHERS = "others do about as well"

_REMEDIES = {
    _DISAGREE: _CHANGED,
    _SO_MANY: _DIFFER,
    _EXCEEDS: _LOOK,
    _UNCONFIRMED: "Check the held-out recordings, or fit them too and hold out others.",
    _LEAD: "Record more gaits, or for longer.",
    _REMAINS: _LOOK,
    _OTHERS: _DIFFER,
}
"""Why the best candidate is not named, and what to do about it."""


@dataclass(frozen=True)
class Identification:
    """What the diagnosis rests on.

    best      the chosen candidate, with the priors of wrong values released
    everywhere  the same fitted to all recordings, held-out ones included;  plain, the nominal
                model likewise
    nominal, refitted, final   nominal; with the parameters fitted; with the missing effects
    before, after  what unknown inputs would explain beside the nominal model and beside the answer
    """

    selection: Selection
    best: Candidate
    everywhere: Candidate
    plain: Candidate
    nominal: Evaluation
    refitted: Evaluation
    final: Evaluation
    after: Sequence[Dependence] = ()

    @cached_property
    def _weighted(self) -> list[tuple[Candidate, float]]:
        return self.selection.weighted

    @cached_property
    def _ended(self) -> list[Candidate]:
        return [one for one, _ in self._weighted]

    @cached_property
    def confidences(self) -> Mapping[str, float]:
        """Of each effect: the predictive weight of all candidates that have it, times the
        probability that the answer is no imitation."""
        return {
            name: self.sound * sum(w for one, w in self._weighted if name in one.effects)
            for name in self.best.effects
        }

    @cached_property
    def sound(self) -> float:
        """Probability that the answer's effects do not imitate something else: recordings agree on
        their values, held-out recordings are predicted better with them, and the remaining misfit
        is within the form error of such effects."""
        return self._constant * self._as_machines_differ * self._predicts

    @property
    def _constant(self) -> float:
        """Probability that the values are constant, and real: of several effects that the motion
        alone shows, each further one makes an imitation easier."""
        catalogue = self.selection.model.catalogue
        seen = sum(not catalogue[name].upstream for name in self.best.effects)
        odds = self.constancy.odds * SETTINGS.further ** max(seen - 1, 0)
        return odds / (1 + odds)

    @property
    def _as_machines_differ(self) -> float:
        """Probability that the remaining misfit is due to the form error of such effects. Fitted to
        all recordings, as the motion after a start may depend on the values by more than they are
        known; whether recordings agree on them is another question."""
        slight = SETTINGS.none**2 + self.selection.model.form_error**2
        left = math.sqrt(max(self.everywhere.excess**2 - slight, 0.0))
        share = left / max(self.plain.excess, 1e-6)
        return 1 / (1 + (share / self._form_error / SETTINGS.form_errors) ** 4)

    @property
    def _disagree(self) -> bool:
        return self.constancy.probability <= SETTINGS.named

    @property
    def doubt(self) -> str:
        """What predicts best and why it is not named, or what else is known of what is missing;
        empty if something is suspected."""
        if self.suspected:
            return ""
        if not self.best.choices and self.selection.insignificant(self.best):
            return " ".join(self._hints())
        best = self.best if self.best.choices else max(self._ended, key=lambda one: one.elpd)
        if not best.effects:
            return (
                "No effect predicts the recordings better than the nominal model, which leaves "
                f"{best.excess:.1f} sigma beyond the noise in the fitted ones. {_LOOK}"
            )
        reasons = {
            _DISAGREE if self._disagree else _SO_MANY: self._constant,
            _EXCEEDS: self._as_machines_differ,
            _UNCONFIRMED: self._predicts,
        }
        against = [reason for reason, likely in reasons.items() if likely <= SETTINGS.named]
        if not against and self.sound <= SETTINGS.named:
            against = [min(reasons, key=lambda reason: reasons[reason])]
        if not best.predicts_better(self.selection.base):
            against = [_LEAD]
        elif not self.best.choices:
            against = [_REMAINS]
        names, against = listed(words_of(name) for name in best.effects), against or [_OTHERS]
        why = f"The best candidate is {names}, but {listed(against)}."
        return " ".join([why, *dict.fromkeys(_REMEDIES[reason] for reason in against)])

    def _hints(self) -> Iterator[str]:
        """What is known of what is missing if the fitted recordings leave no misfit to explain."""
        certain = [one for one in self.after if one.certain]
        if self._disagree:
            yield f"The recordings disagree on the values of the nominal model. {_CHANGED}"
        if certain and remainder_of(self).size == "none":
            found = where(certain[0], self.selection.model.inputs)
            yield f"What remains is slight, but it is not noise: it looks like {found}."
        if not (self.selection.foreseen and (self._disagree or certain)):
            yield (
                "The missing physics shows mainly in the held-out recordings. Change them to "
                "`use: fit`, hold out others, and diagnose again."
            )

    @property
    def _predicts(self) -> float:
        """Probability of the answer given the held-out recordings, with prior log odds of the
        evidence that an effect needs. Not tested if their misfit is within the form error; a
        recording says less the more machines may differ in it from the effect's model, or any."""
        model, problem = self.selection.model, self.everywhere.fit.problem
        held = [k for k, run in enumerate(model.runs) if run.held_out]
        slight = self.final.excess <= self._form_error * self.selection.base.excess
        if slight or not (held and self.best.choices):
            return 1.0
        own, other = self.everywhere.predictive, self.plain.predictive
        odds = SETTINGS.evidence
        for k in held:
            off = self._form_error**2 * self._explained[k] + model.form_error**2
            odds += (own[k] - other[k]) / overdispersion(problem, k, off * problem.samples[k])
        return float(expit(odds))

    @property
    def _form_error(self) -> float:
        """The largest form error of its effects; inf without any."""
        return max(self.best.form_errors.values(), default=math.inf)

    @cached_property
    def _explained(self) -> Mapping[int, float]:
        """By run, the mean square in sigma that the answer's effects explain."""
        return {run: max(one.rms**2 - 1, 0.0) for run, one in enumerate(self.refitted.misfits)}

    @cached_property
    def constancy(self) -> Constancy:
        """How well recordings agree on the answer's values."""
        # With effects, their own form errors count instead.
        left = 0.0 if self.best.choices else self.everywhere.excess
        return constancy(self.everywhere.fit, left, self._explained, self.best.form_errors)

    @cached_property
    def estimates(self) -> Mapping[str, Estimate]:
        """The answer's values, from the fitted recordings; the intervals also cover what whole-run
        simulations of all recordings give."""
        return joint(estimates(self.best.fit), estimates(self.everywhere.simulated))

    @property
    def shown(self) -> tuple[Choice, ...]:
        """The named effects that are more likely missing than not."""
        catalogue = self.selection.model.catalogue
        return tuple(one for one in self._likely if catalogue[one.name].named)

    @property
    def suspected(self) -> tuple[Choice, ...]:
        """The others, which predict better than the named effects that look like them."""
        return tuple(one for one in self._likely if one not in self.shown)

    @cached_property
    def _likely(self) -> tuple[Choice, ...]:
        """The effects that are more likely missing than not: each of them, or another one that is
        indistinguishable from it."""
        alike = [*self.selection.alike(), *self.selection.lookalikes]

        def likely(name: str) -> float:
            return sum(w for one, w in self._weighted if name in one.effects or one in alike)

        return tuple(c for c in self.best.choices if self.sound * likely(c.name) > SETTINGS.named)

    @property
    def explained(self) -> bool:
        """Whether recordings agree on the answer's values and its misfit, also when fitted to all
        recordings, is insignificant, or no more than slightly larger noise than stated; and nothing
        is certainly missing."""
        if self._disagree or any(one.certain for one in self.after):
            return False
        both = (self.best, self.everywhere)
        noisier = (1 + SETTINGS.misstated) ** 2 - 1
        slight = max(one.excess for one in both) ** 2 <= noisier
        return slight or all(self.selection.complete(one) for one in both)

    @property
    def share(self) -> float:
        """Share of the nominal model's misfit beyond the noise (mean square) that remains, 0 to 1,
        on held-out recordings if there are any."""
        return _share(self, self.final)

    @property
    def rivals(self) -> list[Candidate]:
        """Candidates that lack one of the answer's effects, the best first."""
        own = set(self.best.effects)
        others = [one for one in self._ended if not own <= set(one.effects)]
        return sorted(others, key=lambda one: -one.elpd)


def verdict_of(result: Identification) -> Verdict:
    """Whether effects are shown, and if not, whether the nominal model is enough."""
    if result.shown:
        return "missing_physics"
    if result.best.choices or not result.explained:
        return "unexplained"
    slight = max(SETTINGS.negligible, result.selection.model.form_error)
    if result.nominal.excess > slight and wrong(result.best.fit):
        return "parameters"
    return "consistent"


def findings(result: Identification, choices: Sequence[Choice]) -> tuple[Finding, ...]:
    """Effects of the answer, strongest first."""
    catalogue = result.selection.model.catalogue
    base = max(result.selection.base.excess, 1e-12) ** 2
    out = []
    for choice in choices:
        rest, removes = tuple(c for c in result.best.choices if c != choice), 1.0 - result.share
        if rest:
            without = result.selection.fitted(rest, [{}], result.best)
            change = without.excess**2 - result.best.excess**2
            removes = float(np.clip(change / base, 0.0, 1.0))
        own = f"{choice.name}."
        values = {n[len(own) :]: e for n, e in result.estimates.items() if n.startswith(own)}
        others = (*_undecided(result, choice), *catalogue[choice.name].unmodelled)
        out.append(Finding(choice.name, result.confidences[choice.name], values, removes, others))
    return tuple(sorted(out, key=lambda one: -one.removes))


def _undecided(result: Identification, choice: Choice) -> Iterator[str]:
    """The lookalikes of an effect that predict about as well as it does."""
    selection = result.selection
    for name in selection.model.catalogue[choice.name].lookalikes:
        own = [one for one in selection.lookalikes if name in one.effects]
        if any(not selection.best.predicts_better(one) for one in own):
            yield words_of(name)


def named(result: Identification, verdict: Verdict) -> tuple[Finding, ...]:
    """The effects that are missing, or the values that are wrong."""
    if verdict == "parameters":
        return wrong_values(result)
    return findings(result, result.shown) if verdict == "missing_physics" else ()


def wrong_values(result: Identification) -> tuple[Finding, ...]:
    """The parameters whose nominal values are wrong; the confidence is the probability that
    recordings agree on the values."""
    intervals, likely = result.estimates, result.constancy.probability
    return tuple(
        Finding(q.name, likely, {q.name: intervals[q.name]}, 1.0) for q in wrong(result.best.fit)
    )


def _share(result: Identification, last: Evaluation) -> float:
    before = max(result.nominal.excess, result.selection.base.excess)
    left = last.excess / before if before > 0 else 0.0
    return min(left**2, 1.0)


def remainder_of(result: Identification, last: Evaluation | None = None) -> Remainder:
    """The misfit that remains with the answer's effects, or with other values."""
    last = last or result.final
    after, share = last.excess, _share(result, last)
    large = "small" if share <= SETTINGS.small else "large"
    slight = math.hypot(SETTINGS.none, result.selection.model.form_error)
    size = "none" if after <= slight else large
    return Remainder(size, after, share)


def tried(selection: Selection, accepted: Candidate | None) -> tuple[Tried, ...]:
    """All candidates, the best first; the score is -2 log predictive density."""
    every = sorted(selection.tried.values(), key=lambda one: -one.elpd)
    return tuple(
        Tried(
            one.effects,
            # Of one that was not simulated over whole runs, that in segments, with process noise.
            one.excess if "simulated" in one.__dict__ else one.fit.excess,
            -2 * one.elpd,
            {k: v for k, v in one.fit.values.items() if k.partition(".")[0] in one.effects},
            accepted is not None and one.choices == accepted.choices,
        )
        for one in every
    )


def ties(result: Identification, verdict: Verdict) -> tuple[Tie, ...]:
    """Sets of effects that predict the recordings about as well as the answer does, or values that
    explain them as well as a wrong one."""
    if verdict == "parameters":
        fit = result.best.fit
        both = (Tie((q.name,), tuple(instead_of(fit, q.name))) for q in wrong(fit))
        return tuple(one for one in both if one.rival)
    if verdict != "missing_physics" and not result.suspected:
        return ()
    own, catalogue = result.best, result.selection.model.catalogue
    near = []
    for one in result.rivals:
        if not all(catalogue[name].named for name in one.effects):
            continue
        gain, error = own.advantage(one)
        if gain < max(SETTINGS.evidence, SETTINGS.standard_errors * error) and one.effects:
            near.append(tuple(one.effects))
    return tuple(Tie(tuple(own.effects), one) for one in dict.fromkeys(near))


def rival_of(result: Identification) -> tuple[str, Candidate] | None:
    """The runner-up, if another recording might distinguish it from the answer."""
    for one in result.rivals[:1]:
        gain, error = result.best.advantage(one)
        if gain < max(4 * SETTINGS.evidence, error):
            return " and ".join(one.effects) or "other parameters", one
    return None
