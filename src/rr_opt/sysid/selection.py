"""Stepwise selection of effects, by how well recordings are predicted from one another.

Effects of the drive come first, from the drive's own recording. Then forward steps: score tests
promise, fits confirm, and the machine proposes where it takes more than a derivative to see an
effect. Backward steps drop what the predictions do without. A model is complete when what its
simulation of whole runs leaves is no more than machines differ from models of such effects.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from rr_opt.sysid.candidates import Candidate, Choice, first, fitted
from rr_opt.sysid.model import Model
from rr_opt.sysid.score_test import scores
from rr_opt.sysid.settings import SETTINGS

Progress = Callable[[str], None]


@dataclass
class Selection:
    """A search, and every candidate that was fitted in it.

    base  the nominal model with its parameters fitted
    best  the candidate that was chosen
    """

    model: Model
    runs: Sequence[int]
    progress: Progress = lambda _: None
    tried: dict[tuple[Choice, ...], Candidate] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.progress("fitting the parameters")
        self.base = self.best = self.tried[()] = first(self.model, self.runs)

    def run(self) -> Candidate:
        """Search; the candidate that was chosen."""
        self._drive()
        while len(self.best.choices) < SETTINGS.most_effects and not self.complete(self.best):
            before = self.best
            self._forward()
            self._backward()
            if self.best is before:
                break
        else:
            self._backward()
        self._refine()
        return self.best

    def allowance(self, candidate: Candidate) -> float:
        """Mean square in sigma that its simulation may leave and still be complete: what is
        negligible, what machines differ from such models, and what noise leaves by chance."""
        info = self.model.catalogue
        rough = sum(info[name].form_error for name in candidate.effects) * self.base.excess
        chance = 2 * math.sqrt(2 / max(candidate.fit.samples, 1))
        return max(SETTINGS.negligible, self.model.form_error) ** 2 + rough**2 + chance

    def complete(self, candidate: Candidate) -> bool:
        """Whether what it leaves is nothing."""
        return candidate.excess**2 <= self.allowance(candidate)

    def better(self, candidate: Candidate, other: Candidate) -> bool:
        """Whether a larger candidate is preferred to one that it extends."""
        return candidate.predicts_better(other) and not self.complete(other)

    def fitted(
        self,
        choices: Sequence[Choice],
        guesses: Sequence[Mapping[str, float]],
        parent: Candidate | None = None,
    ) -> Candidate:
        """A candidate, fitted unless it was."""
        key = tuple(sorted(choices))
        if key not in self.tried:
            self.progress("fitting " + (" and ".join(c.name for c in key) or "the parameters"))
            self.tried[key] = fitted(self.model, key, (parent or self.best).fit, guesses)
        return self.tried[key]

    def _drive(self) -> None:
        self.progress("looking at the drive")
        sets = [one for one in self.model.upstream() if one[0]]
        for choices, values in sets:
            one = self.fitted(choices, [values], self.base)
            if one.predicts_better(self.best) and len(one.choices) >= len(self.best.choices):
                self.best = one

    def _forward(self) -> None:
        """A step; alternatives are sought until one leaves nothing at all, as what is within the
        tolerance may be an imitation of what would."""
        self.progress("testing what may be missing")
        found = [*self._scored()]
        if not self._exact(found):
            found += self._extended()
        if not self._exact(found):
            self.progress("looking where effects without derivatives may be")
            found += self._proposed()
        best = max(found, key=lambda one: one.elpd, default=None)
        if best and self.better(best, self.best):
            self.best = best

    def _exact(self, found: Sequence[Candidate]) -> bool:
        best = max(found, key=lambda one: one.elpd, default=None)
        return best is not None and self.complete(best) and best.excess <= 2 * SETTINGS.negligible

    def _scored(self) -> Iterator[Candidate]:
        parent = self.best
        room = SETTINGS.most_effects - len(parent.choices)
        promising = [s for s in scores(parent.fit, min(room, 2)) if s.gain > 0]
        singles = [s for s in promising if len(s.choices) == 1][: SETTINGS.singles]
        pairs = [s for s in promising if len(s.choices) == 2][: SETTINGS.pairs]
        for one in singles:
            yield self.fitted((*parent.choices, *one.choices), [one.guess], parent)
        best = max(
            (self.tried[tuple(sorted((*parent.choices, *one.choices)))] for one in singles),
            key=lambda one: one.elpd,
            default=None,
        )
        if best is None or not self.complete(best):
            for one in pairs:
                yield self.fitted((*parent.choices, *one.choices), [one.guess], parent)

    def _extended(self) -> Iterator[Candidate]:
        """Each effect in a fuller form."""
        parent = self.best
        for choice in parent.choices:
            for form, own in self._forms(choice, fuller=True):
                guesses = [
                    {**{q: parent.fit.values[q] for q in own}, **_more(guess, own)}
                    for guess in self.model.catalogue[choice.name].forms[form].guesses
                ]
                rest = [c for c in parent.choices if c is not choice]
                yield self.fitted((*rest, Choice(choice.name, form)), guesses, parent)

    def _proposed(self) -> Iterator[Candidate]:
        parent = self.best
        if len(parent.choices) >= SETTINGS.most_effects:
            return
        guesses: dict[Choice, list[Mapping[str, float]]] = {}
        for choice, guess in self.model.proposals(parent.fit, parent.effects):
            guesses.setdefault(choice, []).append(guess)
        for choice, some in guesses.items():
            yield self.fitted((*parent.choices, choice), some, parent)

    def _refine(self) -> None:
        """The forms of the effects that predict best, whether or not what is left is anything."""
        fuller = [one for one in self._extended() if one.predicts_better(self.best)]
        self.best = max([self.best, *fuller], key=lambda one: one.elpd)

    def _backward(self) -> None:
        """Drop effects, or parts of them, that predictions do without."""
        while self.best.choices:
            smaller = [one for one in self._fewer(self.best) if not self.better(self.best, one)]
            smaller += [
                one for one in self._simpler(self.best) if not self.best.predicts_better(one)
            ]
            if not smaller:
                return
            self.best = max(smaller, key=lambda one: one.elpd)

    def _fewer(self, candidate: Candidate) -> Iterator[Candidate]:
        for choice in candidate.choices:
            rest = [c for c in candidate.choices if c is not choice]
            yield self.fitted(rest, [{}], candidate)

    def _simpler(self, candidate: Candidate) -> Iterator[Candidate]:
        for choice in candidate.choices:
            rest = [c for c in candidate.choices if c is not choice]
            for form, _ in self._forms(choice, fuller=False):
                yield self.fitted((*rest, Choice(choice.name, form)), [{}], candidate)

    def _forms(self, choice: Choice, *, fuller: bool) -> Iterator[tuple[int, set[str]]]:
        """Forms of an effect with more quantities, or fewer; and the quantities of this one."""
        forms = self.model.catalogue[choice.name].forms
        own = {q.name for q in forms[choice.form].quantities}
        for k, form in enumerate(forms):
            names = {q.name for q in form.quantities}
            if (own < names) if fuller else (names < own):
                yield k, own


def _more(guess: Mapping[str, float], own: set[str]) -> dict[str, float]:
    return {name: value for name, value in guess.items() if name not in own}


def turned(model: Model, candidate: Candidate) -> Candidate:
    """The candidate with values that predict the same and are nearer to what was believed."""
    values = model.equivalent(candidate.fit.values)
    if values is None:
        return candidate
    return fitted(model, candidate.choices, replace(candidate.fit, values=values), [{}])
