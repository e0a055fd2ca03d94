"""Search for what is missing: alone, in pairs, in threes; forward by promise, then backward."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from rr_opt.diagnose.explain import Chosen, explain, joined
from rr_opt.diagnose.explanation import FLOOR, Explanation, misfit, rms
from rr_opt.diagnose.fit import Fit, solve
from rr_opt.diagnose.judge import Judge, outright, plain
from rr_opt.diagnose.left_out import left_out
from rr_opt.diagnose.model import Model
from rr_opt.diagnose.problem import Problem
from rr_opt.diagnose.rounds import EXACT, Rounds, Say, carried_out
from rr_opt.diagnose.verdict import LEFT

MOST = 3
"""So many effects together, at most."""

_GAINED = 0.5
"""A third effect is looked for where the second has left no more than that share of the misfit."""

_ACROSS = 5.0
"""A recording predicted from the others may leave so many times what is left of all, RMS."""


@dataclass
class Search:
    """A search under way, and all that it tried.

    first  misfit of the model as believed, RMS in sigma
    been   the rounds it has been through: next to what, without what, and what was found
    again  what was fitted once more from where a larger one ended: the two, and what came of it
    """

    model: Model
    nominal: Fit
    base: Explanation
    first: float
    say: Say = lambda _: None
    each: Callable[..., Iterable] = map
    tried: list[Explanation] = field(default_factory=list)
    been: list[tuple[Explanation, frozenset[str], list[Explanation]]] = field(default_factory=list)
    again: list[tuple[Explanation, Explanation, Explanation]] = field(default_factory=list)

    @cached_property
    def nameless(self) -> Fit | None:
        """The parameters with a term beside them that has no name, where the machine has one."""
        self.say("fitting a term without a name")
        return self.model.nameless(self.base.whole, self.nominal)

    @property
    def large(self) -> float:
        """The misfit of which a small share is none, RMS in sigma: what values make up for is not
        what is missing."""
        return min(self.first, rms(self.base.misfit))

    @property
    def rounds(self) -> Rounds:
        """Its rounds."""
        return Rounds(self.model, self.nominal, self.large, self.say, self.each)

    @property
    def judge(self) -> Judge:
        """What tells whether an effect joins."""
        return Judge(self.rounds, self.first)

    def run(self) -> Explanation:
        """The best explanation, the base itself where nothing relevant is missing."""
        self.tried.append(self.base)
        forward = self._forward(self.base)
        best = self._backward(forward)
        if len(best.chosen) < len(forward.chosen):
            # What came first only imitated the others, and has left its place to one more.
            best = self._backward(self._forward(best))
        moved = self._looked_for_again(best)
        best = best if moved is best else self._backward(moved)
        best = self._simpler(min(best, self._otherwise(best), key=lambda one: one.score))
        return self._imitated(best)

    def _simpler(self, best: Explanation) -> Explanation:
        """The explanation with a simpler form of an effect, where that does as well: what another
        form had more was of use while something else was missing."""
        for one in best.chosen:
            own = {q.name for q in one.of(self.model).quantities}
            for k, form in enumerate(self.model.catalogue[one.name].forms):
                names = {q.name for q in form.quantities}
                if not names < own:
                    continue
                chosen = tuple(Chosen(one.name, k) if c is one else c for c in best.chosen)
                quantities = tuple(q for q in best.whole.quantities if q.name not in own - names)
                starts = best.whole.starts
                problem = Problem(self.model, tuple(starts), best.names, quantities)
                values = {q.name: best.whole.values[q.name] for q in quantities}
                simpler = replace(best, chosen=chosen, whole=solve(problem, values, starts))
                if simpler.score < best.score:
                    self.tried.append(simpler)
                    best = simpler
        return best

    def _imitated(self, best: Explanation) -> Explanation:
        """The explanation with what an effect only imitates in its place, where that does better:
        a round that found the one may not have come to fit the other."""
        for one in best.chosen:
            for name in self.model.catalogue[one.name].imitates:
                other = Chosen(name)
                more = len(other.of(self.model).quantities) > len(one.of(self.model).quantities)
                if name not in best.names and not more:
                    chosen = tuple(other if each is one else each for each in best.chosen)
                    best = min(best, self._with(chosen, best), key=lambda each: each.score)
        return best

    def _otherwise(self, best: Explanation) -> Explanation:
        """What the search finds without what imitates much at first, if that of `best` is doubtful.

        With its free place a patch follows a few recordings whatever they lack, but each of them is
        then predicted badly from the others. And wheels that slide do much of what others do, but
        leave something that nothing beside them accounts for. They are not looked for again, as
        that is the dearest part of a round.
        """
        across = rms(left_out(best.whole))
        doubtful = self.model.placed & set(best.names)
        if across <= _ACROSS * max(rms(best.misfit), FLOOR):
            doubtful = frozenset[str]()
        if rms(best.misfit) > max(LEFT, self.rounds.floor(best)):
            doubtful |= self.model.dear & set(best.names)
        if not doubtful:
            return best
        others = [
            one for one in self.tried if len(one.chosen) == 1 and one.names[0] not in doubtful
        ]
        if not others:
            return best
        first = min(others, key=lambda one: one.score)
        return self._backward(self._forward(first, without=doubtful))

    def _forward(self, best: Explanation, without: frozenset[str] = frozenset()) -> Explanation:
        gained, sure = True, best
        for _ in range(len(best.chosen), MOST):
            explained = rms(best.misfit) <= max(FLOOR, EXACT * self.large)
            if (explained and (best.chosen or not self.judge.doubtful(best))) or not gained:
                break
            # Three that do what one term does better than two would only take its shape.
            if len(best.chosen) == MOST - 1 and self._nameless_does_better(best):
                break
            found = self._next_to(best, without)
            if not found:
                break
            better = min(found, key=lambda one: one.score)
            if not outright(better, best):
                again = self._again(best, better)
                best, sure = again, again if sure is best else sure
            if self.judge.gains(better, best):
                # What is not there is imitated by one effect after the other, each gaining little.
                gained = not best.chosen or better.misfit < _GAINED * best.misfit
                best = sure = better
            else:
                # While another is missing, a fit over whole runs may not keep what windows show.
                shown = [one for one in found if plain(one, best)]
                if not shown:
                    break
                best = min(shown, key=lambda one: one.windows.cost)
        return sure

    @property
    def nameless_does(self) -> bool:
        """Whether a term without a name explains the recordings by itself."""
        return self.nameless is not None and rms(misfit(self.nameless)) <= self.rounds.floor(
            self.base
        )

    def _nameless_does_better(self, best: Explanation) -> bool:
        """Whether a term without a name leaves less by itself."""
        return self.nameless is not None and misfit(self.nameless) < best.misfit

    def _next_to(self, best: Explanation, without: frozenset[str]) -> list[Explanation]:
        """The explanations with one effect more that promise most, looked for once."""
        for been, spared, found in self.been:
            if been is best and spared <= without:
                return [one for one in found if not without & set(one.names)]
        found = self.rounds.next_to(best, without)
        self.been.append((best, without, found))
        self.tried += found
        return found

    def _again(self, less: Explanation, more: Explanation) -> Explanation:
        """`less` from where `more` ended, if that is better.

        What joins must not win by a valley that the smaller set could have gone down too.
        """
        for one, other, came in self.again:
            if one is less and other is more:
                return came
        whole = less.whole
        values = {q.name: more.whole.values[q.name] for q in whole.quantities}
        problem = Problem(
            self.model, tuple(more.whole.starts), whole.effects, whole.quantities, whole.values
        )
        again = replace(less, whole=solve(problem, values, more.whole.starts))
        came = min(less, again, key=lambda one: one.score)
        self.again.append((less, more, came))
        self.tried[:] = [came if one is less else one for one in self.tried]
        return came

    def _backward(self, best: Explanation) -> Explanation:
        if len(best.chosen) < 2:
            return best
        self._try([_rest(best, one) for one in best.chosen], best)
        for one in best.chosen:
            without = self._with(_rest(best, one), best)
            if not outright(best, without):
                without = self._again(without, best)
            if not self.judge.gains(best, without):
                return self._backward(without)
        return best

    def _looked_for_again(self, best: Explanation) -> Explanation:
        """One that leaves something, with what is at a place looked for again beside the others.

        It was found where it made up best for what they had not yet accounted for; what was found
        beside them is where it is. Where a term without a name leaves less than they do together,
        they are not what it lies beside.
        """
        if len(best.chosen) < 2 or rms(best.misfit) <= self.rounds.floor(best):
            return best
        if self._nameless_does_better(best):
            return best
        for one in best.chosen:
            known = any(
                been.chosen == _rest(best, one) and one.name not in spared
                for been, spared, _ in self.been
            )
            if one.name in self.model.placed and not known:
                without = self._with(_rest(best, one), best)
                places = self.rounds.looked_for(without, one.name)
                found = self.rounds.fitted(without, places)
                self.tried += found
                best = min([best, *found], key=lambda tried: tried.score)
        return best

    def _with(self, chosen: tuple[Chosen, ...], best: Explanation) -> Explanation:
        """The explanation with these effects, as it was tried, or fitted from where `best` is."""
        self._try([chosen], best)
        return next(one for one in self.tried if one.chosen == chosen)

    def _try(self, every: Sequence[tuple[Chosen, ...]], best: Explanation) -> None:
        """Fit each of some sets of effects that was not tried, side by side."""
        tried = {one.chosen for one in self.tried}
        new = [chosen for chosen in every if chosen not in tried]
        if new:
            names = (" and ".join(one.name for one in chosen) for chosen in new)
            self.say(f"fitting {', '.join(names)}")
            tasks = [_Fitted(self.model, chosen, self.nominal, best.windows) for chosen in new]
            self.tried += self.each(carried_out, tasks)


@dataclass(frozen=True)
class _Fitted:
    model: Model
    chosen: tuple[Chosen, ...]
    nominal: Fit
    windows: Fit

    def __call__(self) -> Explanation:
        """These effects, from where another fit has them."""
        fit = explain(self.model, self.chosen, self.nominal, self.windows)
        return Explanation(self.chosen, fit, joined(self.model, fit))


def _rest(best: Explanation, one: Chosen) -> tuple[Chosen, ...]:
    return tuple(other for other in best.chosen if other.name != one.name)
