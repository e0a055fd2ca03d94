"""What a search amounts to: which effects are shown, how sure that is, and what is left.

The verdict is graded. Effects are named that the recordings' predictions of one another call for
and that leave no more than an imitation would not; what is left beside them is the remainder. Only
where no effect is shown is the answer `unexplained`.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import expit

from rr_opt.formatting import words_of
from rr_opt.messages import listed
from rr_opt.sysid.candidates import Candidate, weights
from rr_opt.sysid.constancy import Constancy, constancy
from rr_opt.sysid.diagnosis import Finding, Remainder, Tried, Verdict
from rr_opt.sysid.evaluation import Evaluation
from rr_opt.sysid.intervals import estimates, named, wrong
from rr_opt.sysid.model import Choice
from rr_opt.sysid.remainder import Dependence
from rr_opt.sysid.selection import Selection
from rr_opt.sysid.settings import SETTINGS


@dataclass(frozen=True)
class Identification:
    """What the diagnosis rests on.

    best      the candidate that was chosen, with values that are wrong released
    everywhere  the same fitted to all recordings, also those that are held out;  plain, the nominal
                model likewise
    nominal, refitted, final   as believed; with the parameters fitted; with what is missing
    before, after  what unknown inputs would explain beside the nominal model and beside the answer
    """

    selection: Selection
    best: Candidate
    everywhere: Candidate
    plain: Candidate
    nominal: Evaluation
    refitted: Evaluation
    final: Evaluation
    before: Sequence[Dependence] = ()
    after: Sequence[Dependence] = ()

    @cached_property
    def _ended(self) -> list[Candidate]:
        return [one for one in self.selection.tried.values() if not one.given_up]

    @cached_property
    def confidences(self) -> Mapping[str, float]:
        """Of each effect: the weight of the candidates that have it, by how they predict
        recordings, times the likelihood that it imitates nothing else."""
        tried = self._ended
        own = list(zip(weights(tried), tried, strict=True))
        return {
            name: float(self.sound * sum(w for w, one in own if name in one.effects))
            for name in self.best.effects
        }

    @cached_property
    def sound(self) -> float:
        """How likely the answer's effects are no imitation of something else: recordings agree on
        their values, those that were not fitted are predicted better with them, and what is left of
        the misfit is no more than machines differ from models of such effects."""
        return self._constant * self._as_machines_differ * self._predicts

    @property
    def _constant(self) -> float:
        """How likely the values are constant and those of what is there: of several effects that
        the motion alone shows each further one makes an imitation easier."""
        catalogue = self.selection.model.catalogue
        seen = sum(not catalogue[name].upstream for name in self.best.effects)
        odds = self.constancy.odds * SETTINGS.further ** max(seen - 1, 0)
        return odds / (1 + odds)

    @property
    def _as_machines_differ(self) -> float:
        """How likely what is left is what machines differ by from models of such effects: fitted to
        all recordings, as the motion after a start may depend on the values by more than they are
        known; whether recordings agree on them is another question."""
        slight = SETTINGS.none**2 + self.selection.model.form_error**2
        left = math.sqrt(max(self.everywhere.excess**2 - slight, 0.0))
        share = left / max(self.plain.excess, 1e-6)
        return 1 / (1 + (share / self._form_error / SETTINGS.form_errors) ** 4)

    @property
    def doubt(self) -> str:
        """What predicts best, and why it is not named, or where it shows; "" if nothing was found
        to predict better than the nominal model."""
        if not self.best.choices and self.selection.complete(self.best):
            return "The recordings that were fitted show none of it: fit those that do."
        best = self.best if self.best.choices else max(self._ended, key=lambda one: one.elpd)
        if not best.effects:
            return ""
        constant = self.constancy.probability
        disagree = "recordings disagree on the values"
        so_many = "so many effects can imitate anything"
        reasons = {
            disagree if constant <= SETTINGS.named else so_many: self._constant,
            "more is left than machines differ from such models": self._as_machines_differ,
            "the recordings that were not fitted do not bear it out": self._predicts,
        }
        against = [reason for reason, likely in reasons.items() if likely <= SETTINGS.named]
        if not against and self.sound <= SETTINGS.named:
            against = [min(reasons, key=lambda reason: reasons[reason])]
        if not best.predicts_better(self.selection.base):
            against = ["by too little to be sure: these recordings cannot tell"]
        elif not self.best.choices:
            against = ["most of the misfit is left"]
        names = listed(words_of(name) for name in best.effects)
        return f"What predicts best is {names}, but {listed(against) or 'others do about as well'}."

    @property
    def _predicts(self) -> float:
        """How likely the answer is after the recordings that were not fitted: before them it has at
        least the evidence that an effect needs. That is not asked where they leave no more than
        machines differ from such models."""
        if self.final.excess <= self._form_error * self.selection.base.excess:
            return 1.0
        runs = self.selection.model.runs
        own, other = self.everywhere.predictive, self.plain.predictive
        gains = [own[k] - other[k] for k, run in enumerate(runs) if run.held_out]
        odds = SETTINGS.evidence + sum(gains)
        return float(expit(odds)) if gains and self.best.choices else 1.0

    @property
    def _form_errors(self) -> Mapping[str, float]:
        catalogue = self.selection.model.catalogue
        return {name: catalogue[name].form_error for name in self.best.effects}

    @property
    def _form_error(self) -> float:
        """The largest; without an effect, any."""
        return max(self._form_errors.values(), default=math.inf)

    @cached_property
    def constancy(self) -> Constancy:
        """How well recordings agree on the answer's values."""
        explained = {run: max(one.rms**2 - 1, 0.0) for run, one in enumerate(self.refitted.misfits)}
        # Effects have form errors of their own.
        left = 0.0 if self.best.choices else self.everywhere.excess
        return constancy(self.everywhere.fit, left, explained, self._form_errors)

    @property
    def shown(self) -> tuple[Choice, ...]:
        """The effects that are missing with more likelihood than not: each, or another one of those
        that are indistinguishable from it."""
        tried, alike = self._ended, self.selection.alike()
        own = list(zip(weights(tried), tried, strict=True))
        return tuple(
            c
            for c in self.best.choices
            if self.sound * sum(w for w, one in own if c.name in one.effects or one in alike)
            > SETTINGS.named
        )

    @property
    def explained(self) -> bool:
        """Whether what the answer leaves, if it is fitted to all recordings, is no more than
        machines differ from their models; or is as noise that is a little larger than stated,
        which follows nothing. And whether recordings agree on its values."""
        if self.constancy.probability <= SETTINGS.named:
            return False
        both = (self.best, self.everywhere)
        if all(self.selection.complete(one) for one in both):
            return True
        most = max(one.excess for one in both)
        noisier = (1 + SETTINGS.misstated) ** 2 - 1
        return most**2 <= noisier and not any(one.certain for one in self.after)

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


def findings(result: Identification) -> tuple[Finding, ...]:
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


def wrong_values(result: Identification) -> tuple[Finding, ...]:
    """The parameters that are not what they were believed to be, as likely as recordings agree on
    the values."""
    intervals, likely = estimates(result.best.fit), result.constancy.probability
    return tuple(
        Finding(q.name, likely, {q.name: intervals[q.name]}, 1.0) for q in wrong(result.best.fit)
    )


def remainder_of(result: Identification) -> Remainder:
    """What is left with the answer's effects."""
    after = result.final.excess
    share = result.share
    large = "small" if share <= SETTINGS.small else "large"
    size = "none" if after <= SETTINGS.none else large
    return Remainder(size, after, share)


def tried(selection: Selection, accepted: Candidate | None) -> tuple[Tried, ...]:
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


def alike(result: Identification) -> tuple[tuple[str, ...], ...]:
    """Sets of effects that predict the recordings about as well as the answer does."""
    own = result.best
    near = []
    for one in result.rivals:
        gain, error = own.advantage(one)
        if gain < max(SETTINGS.evidence, SETTINGS.standard_errors * error) and one.effects:
            near.append(tuple(one.effects))
    groups = [tuple(dict.fromkeys((*own.effects, *one))) for one in near]
    return tuple(dict.fromkeys(groups))


def rival_of(result: Identification) -> tuple[str, Candidate] | None:
    """The candidate that comes next, of those that a recording may yet tell from the answer."""
    for one in result.rivals[:1]:
        gain, error = result.best.advantage(one)
        if gain < max(4 * SETTINGS.evidence, error):
            return " and ".join(one.effects) or "other parameters", one
    return None
