"""Stepwise selection of effects, by cross-validation over recordings.

Effects of the drive come first, from the drive's own recording. In forward steps score tests
suggest effects, fits confirm them, and the machine proposes those that no derivative reveals.
Backward steps drop effects that the predictions do not need. A model is complete when the misfit
of its whole-run simulation is within the form error of its effects and recordings agree on its
values.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from rr_opt.formatting import words_of
from rr_opt.sysid.candidates import Candidate, first, fitted, quantities_of, weights
from rr_opt.sysid.estimation import predicted, solve
from rr_opt.sysid.machine import MachineModel
from rr_opt.sysid.model import ChannelNoise, Choice
from rr_opt.sysid.remainder import Dependence, dependences
from rr_opt.sysid.score_test import Score, scores, with_all
from rr_opt.sysid.settings import SETTINGS

Progress = Callable[[str], None]


@dataclass
class Selection:
    """A search, and every candidate that was fitted in it.

    base  the nominal model with its parameters fitted
    best  the candidate that was chosen
    lookalikes  of the best one's effects: candidates that have one in its place and predict no
                better
    """

    model: MachineModel
    base: Candidate
    progress: Progress = lambda _: None
    tried: dict[tuple[Choice, ...], Candidate] = field(default_factory=dict)
    lookalikes: Sequence[Candidate] = ()
    _compared: set[tuple[Candidate, tuple[Choice, ...]]] = field(default_factory=set)
    _plausibles: dict[Candidate, bool] = field(default_factory=dict)
    _contested: Candidate | None = None

    def __post_init__(self) -> None:
        self.best = self.tried[()] = self.base

    @classmethod
    def begun(cls, model: MachineModel, base: Candidate, progress: Progress) -> Selection:
        """A search that has begun with the effects of the drive."""
        selection = cls(model, base, progress)
        if not selection.insignificant(base):
            model.prepare([with_all(base.fit)])
        selection.drive()
        return selection

    def again(self, noise: Sequence[ChannelNoise]) -> Selection:
        """Start over with other noise."""
        model = self.model.with_noise(noise)
        base = first(model, self.base.fit.problem.by_run)
        return self.begun(model, base, self.progress)

    def run(self) -> Candidate:
        """Run the search; returns the chosen candidate."""
        # The drive's own recording may show effects that the motion does not need.
        self._backward(self._better)
        seen: list[Candidate] = []
        while self.best not in seen and not self._enough(self.best):
            seen.append(self.best)
            if len(self.best.choices) < SETTINGS.most_effects and not self._close(self.best):
                self._forward()
            self._backward(self._better)
            if self.insignificant(self.best) and not self._enough(self.best):
                self._contest()
        self._backward(self.needed)
        self._contest()
        return self.best

    def complete(self, candidate: Candidate) -> bool:
        """Whether its misfit is insignificant and its values are plausible."""
        return self.insignificant(candidate) and self._plausible(candidate)

    def _plausible(self, candidate: Candidate) -> bool:
        """Whether the fitted recordings agree on its values: where they do not, something else is
        missing, and they may show what."""
        if candidate not in self._plausibles:
            self._plausibles[candidate] = candidate.plausible(self.base)
        return self._plausibles[candidate]

    def insignificant(self, candidate: Candidate) -> bool:
        """Whether its misfit over whole runs is within the tolerance (`none` with effects,
        `negligible` without), the machine's form error and chance together."""
        chance = 2 * math.sqrt(2 / max(candidate.fit.samples, 1))
        least = SETTINGS.none if candidate.choices else SETTINGS.negligible
        most = least**2 + self.model.form_error**2 + chance
        # Segments that need not join have a smaller misfit than whole runs.
        return candidate.fit.excess**2 <= 2 * most and candidate.excess**2 <= most

    def _better(self, candidate: Candidate, other: Candidate) -> bool:
        """Whether it predicts better than another one that is not good enough."""
        return candidate.predicts_better(other) and not self._enough(other)

    def _enough(self, candidate: Candidate) -> bool:
        """Whether it is complete. From the nominal model nothing may be certainly missing either,
        and it must predict held-out recordings, as these may show plainly what the fitted ones
        hardly do."""
        return self.complete(candidate) and (
            bool(candidate.choices)
            or (self.foreseen and not any(one.certain for one in self.dependences))
        )

    @cached_property
    def dependences(self) -> Sequence[Dependence]:
        """What unknown inputs would explain beside the nominal model."""
        fit = self.base.fit
        return dependences(fit, *self.model.unknown_inputs(fit))

    @cached_property
    def foreseen(self) -> bool:
        """Whether the nominal model predicts the held-out recordings."""
        fit, model = self.base.fit, self.model
        held = [k for k, run in enumerate(model.runs) if run.held_out]
        most = SETTINGS.none**2 + model.form_error**2
        return not held or predicted(fit, held, fit.values).excess ** 2 <= most

    def needed(self, candidate: Candidate, other: Candidate) -> bool:
        """Whether it also leaves nothing, if what the other misses more may be the form error of
        that one's effects."""
        return self._better(candidate, other) and (
            not self._close(other, candidate.excess, SETTINGS.removed) or self.complete(candidate)
        )

    def _close(self, candidate: Candidate, left: float = 0.0, sigmas: float = 1.0) -> bool:
        """Whether it has effects, and its misfit, beyond what is left by another, is within so many
        of their form errors."""
        errors, beyond = candidate.form_errors.values(), candidate.excess**2 - left**2
        return bool(errors) and beyond <= (sigmas * max(errors) * self.base.excess) ** 2

    def fitted(
        self,
        choices: Sequence[Choice],
        guesses: Sequence[Mapping[str, float]],
        parent: Candidate | None = None,
    ) -> Candidate:
        """The candidate with these effects, fitted unless it was before."""
        key = tuple(sorted(choices))
        if key not in self.tried:
            self.progress("fitting " + (" and ".join(c.name for c in key) or "the parameters"))
            rival = min((one.fit for one in self.tried.values()), key=lambda fit: fit.deviance)
            begun, nested = [*guesses], self._nested(key)
            if nested:
                known = {q: nested.fit.values[q] for q in nested.fit.problem.names}
                begun.append({**guesses[0], **known})
            self.tried[key] = fitted(self.model, key, (parent or self.best).fit, begun, rival)
        return self.tried[key]

    def _nested(self, key: Sequence[Choice]) -> Candidate | None:
        """The best candidate that is nested in this one, which therefore fits no worse."""
        names = {q.name for q in quantities_of(self.model, key)}
        nested = [
            one for one in self.tried.values() if one.choices and names > set(one.fit.problem.names)
        ]
        return min(nested, key=lambda one: one.fit.deviance, default=None)

    def drive(self) -> None:
        """Try effects of the drive, from its own recording."""
        self.progress("testing the actuation")
        for choices, values in self.model.upstream():
            if not choices:
                continue
            one = self.fitted(choices, [values], self.base)
            if one.predicts_better(self.best) and len(one.choices) >= len(self.best.choices):
                self.best = one

    def _forward(self) -> None:
        """A forward step; the search is widened until one candidate clearly wins: two effects are
        tried at once only where no single one does."""
        self.progress("testing candidate effects")
        promising = self._promising()
        found = [*self._scored(promising, 1)]
        if not self._settled(found):
            found += self._extended()
        if not self._settled(found):
            self.progress("searching for effects without derivatives")
            found += self._proposed()
        if not self._settled(found):
            found += self._scored(promising, 2)
        step = _best(found)
        if step and step.predicts_better(self.best):
            self.best = step

    def _settled(self, found: Sequence[Candidate]) -> bool:
        """Whether one more effect is complete and predicts better than all alternatives. If not, it
        may imitate an effect that was not tried yet."""
        best = _best(found)
        if best is None or not self.complete(best):
            return False
        others = [one for one in found if one.effects != best.effects]
        return all(best.predicts_better(one) for one in (self.best, *others))

    def _promising(self) -> list[Score]:
        room = SETTINGS.most_effects - len(self.best.choices)
        return [one for one in scores(self.best.fit, min(room, 2)) if one.gain > 0]

    def _scored(self, promising: Sequence[Score], size: int) -> Iterator[Candidate]:
        """The most promising sets of so many further effects."""
        some = [one for one in promising if len(one.choices) == size][: SETTINGS.promising]
        yield from self._added((one.choices, [one.guess]) for one in some)

    def _added(
        self, asked: Iterable[tuple[Sequence[Choice], Sequence[Mapping[str, float]]]]
    ) -> Iterator[Candidate]:
        """The best candidate with further effects, started from guesses of their values."""
        parent, every = self.best, [*asked]
        self.model.prepare((*parent.effects, *(c.name for c in more)) for more, _ in every)
        for more, guesses in every:
            yield self.fitted((*parent.choices, *more), guesses, parent)

    def _extended(self) -> Iterator[Candidate]:
        """Each effect in a fuller form."""
        parent = self.best
        for choice in parent.choices:
            rest = [c for c in parent.choices if c is not choice]
            forms = [*self._forms(choice, fuller=True)]
            if not forms:
                continue
            others = [name for name in self.model.catalogue if name != choice.name]
            proposed = self.model.proposals(parent.fit, others)
            for form, own in forms:
                fuller = Choice(choice.name, form)
                guesses = [guess for one, guess in proposed if one == fuller]
                guesses = guesses or self.model.catalogue[choice.name].forms[form].guesses
                if not guesses:
                    continue
                known = {q: parent.fit.values[q] for q in own}
                more = [{**guess, **known} for guess in guesses]
                yield self.fitted((*rest, fuller), more, parent)

    def _proposed(self) -> Iterator[Candidate]:
        parent = self.best
        if len(parent.choices) >= SETTINGS.most_effects:
            return
        guesses: dict[Choice, list[Mapping[str, float]]] = {}
        for choice, guess in self.model.proposals(parent.fit, parent.effects):
            guesses.setdefault(choice, []).append(guess)
        self.model.prepare((*parent.effects, one.name) for one in guesses)
        for one, own in guesses.items():
            yield self._asked((*parent.choices, one), own, parent)

    def _asked(
        self, choices: Sequence[Choice], guesses: Sequence[Mapping[str, float]], parent: Candidate
    ) -> Candidate:
        """The candidate with these effects; if it was fitted before, the better of that and of one
        from another parent's values and these guesses."""
        key = tuple(sorted(choices))
        if (parent, key) not in self._compared:
            self._compared.add((parent, key))
            known = self.tried.get(key)
            if known is None:
                return self.fitted(key, guesses, parent)
            again = fitted(self.model, key, parent.fit, guesses, known.fit)
            if not again.given_up and again.fit.deviance < known.fit.deviance:
                self.tried[key] = again
        return self.tried[key]

    def _contest(self) -> None:
        """Try the lookalikes of the answer's effects in their place: an effect imitates the one
        that predicts better."""
        if self.best is self._contested:
            return
        best, every = self.best, [*self._lookalikes()]
        self._contested = best
        better = [one for one in every if self._beats(one, best)]
        self.lookalikes = [one for one in every if one not in better]
        if better:
            self.tried |= {one.choices: one for one in better}
            self.best = max(better, key=lambda one: one.elpd)
            self._backward(self.needed)

    @staticmethod
    def _beats(one: Candidate, best: Candidate) -> bool:
        """Whether a lookalike predicts better: certainly, or a little, and is likelier."""
        likelier = one.fit.deviance < best.fit.deviance
        better = one.predicts_better(best) or (one.elpd > best.elpd and likelier)
        return better and not one.given_up

    def _lookalikes(self) -> Iterator[Candidate]:
        """Each in the place of its effect, and of that and one more."""
        catalogue, best = self.model.catalogue, self.best
        for choice in best.choices:
            others = [one for one in best.choices if one is not choice]
            fewer = [[x for x in others if x is not one] for one in others]
            # One that the nominal model has is no candidate.
            for name in (one for one in catalogue[choice.name].lookalikes if one in catalogue):
                self.progress(f"comparing {words_of(choice.name)} with {words_of(name)}")
                # The effect's values under its name: a fit takes those that it has.
                same = {
                    quantity.replace(choice.name, name): value
                    for quantity, value in best.fit.values.items()
                    if quantity.startswith(f"{choice.name}.")
                }
                for form, info in enumerate(catalogue[name].forms):
                    guesses = [{**guess, **same} for guess in info.guesses]
                    for rest in (others, *fewer):
                        if name in (one.name for one in rest):
                            continue
                        choices = (*rest, Choice(name, form))
                        made = fitted(self.model, choices, best.fit, guesses, best.fit)
                        yield made
                        # Fewer effects fit no better.
                        if rest is others and made.given_up:
                            break

    @property
    def weighted(self) -> list[tuple[Candidate, float]]:
        """The candidates whose fits ended, with their predictive weights."""
        ended = [one for one in (*self.tried.values(), *self.lookalikes) if not one.given_up]
        return list(zip(ended, weights(ended).tolist(), strict=True))

    def alike(self) -> list[Candidate]:
        """The candidates that predict about as well as the best."""
        return [
            one
            for one in self.tried.values()
            if one.choices and not one.given_up and not self.best.predicts_better(one)
        ]

    def _backward(self, needed: Callable[[Candidate, Candidate], bool]) -> None:
        """Drop effects, or parts, that the full set can spare: two may be needed only jointly."""
        whole = self.best
        while self.best.choices:
            spare = [one for one in self._fewer(self.best) if not needed(whole, one)]
            fewer = [self._ended(one) if one.given_up else one for one in spare]
            simpler = (one for one in self._simpler(self.best) if not whole.predicts_better(one))
            best = _best(fewer) or _best(simpler)
            if best is None:
                return
            self.best = best

    def _fewer(self, whole: Candidate) -> Iterator[Candidate]:
        """The candidates with one effect less. Before one counts as worse it is also fitted from
        the whole's values, as its own search may have ended in another minimum."""
        parts = [tuple(c for c in whole.choices if c is not one) for one in whole.choices]
        self.model.prepare(tuple(c.name for c in part) for part in parts)
        for part in parts:
            known = self.tried.get(part)
            if known and not (part and whole.predicts_better(known)):
                yield known
            else:
                yield self._asked(part, [{}], whole)

    def _simpler(self, candidate: Candidate) -> Iterator[Candidate]:
        for choice in candidate.choices:
            rest = [c for c in candidate.choices if c is not choice]
            for form, _ in self._forms(choice, fuller=False):
                yield self.fitted((*rest, Choice(choice.name, form)), [{}], candidate)

    def _ended(self, part: Candidate) -> Candidate:
        """A part that was given up, fitted to the end: it need not fit as well as the whole."""
        self.tried[part.choices] = fitted(self.model, part.choices, part.fit, [{}])
        return self.tried[part.choices]

    def _forms(self, choice: Choice, *, fuller: bool) -> Iterator[tuple[int, set[str]]]:
        """The next larger, or smaller, forms of an effect, and the present form's quantities."""
        forms = self.model.catalogue[choice.name].forms
        every = [{q.name for q in form.quantities} for form in forms]
        own = every[choice.form]
        others = {k: one for k, one in enumerate(every) if (own < one if fuller else one < own)}
        for k, one in others.items():
            between = (own < x < one if fuller else one < x < own for x in others.values())
            if not any(between):
                yield k, own


def _best(candidates: Iterable[Candidate]) -> Candidate | None:
    """The one that predicts best, of those that were not given up."""
    ended = (one for one in candidates if not one.given_up)
    return max(ended, key=lambda one: one.elpd, default=None)


def turned(model: MachineModel, candidate: Candidate) -> Candidate:
    """The candidate with equivalent values that are nearer to the nominal ones, if any that fit as
    well."""
    fit = candidate.fit
    values = model.equivalent(fit.values)
    if values is None:
        return candidate
    again = solve(fit.problem, values, fit.states)
    # Not the deviances: the volumes of equivalent values differ.
    losses = [sum(e.value for e in one.evidences.values()) for one in (again, fit)]
    worse = losses[0] - losses[1] > 2 * SETTINGS.evidence
    return candidate if worse else Candidate(candidate.choices, again)
