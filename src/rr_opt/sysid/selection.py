"""Stepwise selection: which effects are missing.

A round of the search: which effects promise most beside an explanation, fitted.

A linearised pass over all effects (`screen`) ranks them at once. The most promising few are fitted
in windows, and the best of those over whole runs, where small effects add up and show.

Whether an effect joins an explanation: its gain is relevant, certain, and not a value's doing.

An effect joins only if the misfit falls by more than `RELEVANT`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TypeVar

from rr_opt.sysid.candidate import (
    FLOOR,
    Chosen,
    Explanation,
    explain,
    joined,
    left_out,
    misfit,
    rms,
)
from rr_opt.sysid.least_squares import Fit, Problem, doubt, solve
from rr_opt.sysid.model import Model
from rr_opt.sysid.score_test import Look, Promise, looks, screen
from rr_opt.sysid.values import settled, wrong
from rr_opt.sysid.verdict import LEFT

EXACT, ROUGH = 0.005, 0.03
"""Nor is an effect's model: what is left is none by the first share of the misfit without it, by
the second for an effect of which there are as many models as machines."""

_IN_WINDOWS, _DEAR, _WHOLE = 5, 4, 3
"""How many of a round are fitted in windows, of those the dear ones, and over whole runs."""

_WORTH = 0.05
"""Of what the best promises, any but the first few have to promise that share."""

PLAIN = 0.05
"""Misfit in windows, in sigma squared, that is plain to see."""

_AS_MUCH = 0.5
"""Of what the others gain, a dear effect has to promise that share to be looked at beside them."""

_MUCH_WORSE = 3.0
"""A dear effect that in windows plainly leaves so many times what another does is not tried on."""

Say = Callable[[str], None]
T = TypeVar("T")


@dataclass(frozen=True)
class Rounds:
    """What every round of a search begins with.

    large  misfit without what is missing, RMS in sigma
    """

    model: Model
    nominal: Fit
    large: float
    say: Say = lambda _: None
    each: Callable[..., Iterable] = map

    def floor(self, best: Explanation) -> float:
        """A misfit that is none, RMS in sigma, of a model with the effects of `best`."""
        return max(FLOOR, (ROUGH if self.rough(best) else EXACT) * self.large)

    def rough(self, best: Explanation) -> bool:
        """Whether an effect of `best` is one of which there are as many models as machines."""
        return any(q.name in self.model.rough for q in best.whole.quantities)

    def next_to(
        self, best: Explanation, without: frozenset[str] = frozenset()
    ) -> list[Explanation]:
        """The explanations with one effect more that promise most.

        without  dear ones that are not looked for
        """
        fit = _sight(best)
        promised = screen(self.model, fit, best.chosen)
        promised += _more_than_luck(self._looks(best, dear=False))
        promised.sort(key=lambda one: -one.gain)
        least = _WORTH * promised[0].gain if promised else 0.0
        worth = [one for k, one in enumerate(promised) if k < _WHOLE or one.gain > least]
        # What cannot be linearised is dear to look for: beside the fits, as they need one another
        # for nothing.
        if worth:
            self._say_fitting(worth[:_IN_WINDOWS])
        looking = [one for one in self._looks(best, dear=True) if one.name not in without]
        tried = [self._in_windows(best, one) for one in worth[:_IN_WINDOWS]]
        done = list(self.each(carried_out, [*looking, *tried]))
        found = self._over_whole_runs(best, done[len(looking) :])
        dear = _more_than_luck(done[: len(looking)])[:_DEAR]
        # It is tried where nothing else will do, or where it promises, from one step, about as much
        # as the others gain.
        if min((rms(one.misfit) for one in found), default=math.inf) <= self.floor(best):
            least = _AS_MUCH * max(fit.cost - _same(one, best, fit).cost for one in found)
            dear = [one for one in dear if one.gain > least]
        return found + self.fitted(best, dear, found)

    def looked_for(self, best: Explanation, name: str) -> list[Promise]:
        """What one dear effect promises beside an explanation, if it is more than luck."""
        return _more_than_luck(look for look in self._looks(best, dear=True) if look.name == name)

    def _looks(self, best: Explanation, *, dear: bool) -> list[Look]:
        return looks(self.model, _sight(best), best.chosen, dear=dear)

    def fitted(
        self, best: Explanation, promised: Sequence[Promise], found: Sequence[Explanation] = ()
    ) -> list[Explanation]:
        """The explanation with each of these beside it, the best of them over whole runs.

        found  with others beside it: what is plainly worse than those is not fitted over whole runs
        """
        if not promised:
            return []
        self._say_fitting(promised)
        done = list(self.each(carried_out, [self._in_windows(best, one) for one in promised]))
        if found and _sight(best) is best.windows:
            least = _MUCH_WORSE * min(_left(one.windows) for one in found)
            done = [pair for pair in done if _left(pair[1]) <= max(PLAIN, least)]
        return self._over_whole_runs(best, done)

    def _say_fitting(self, promised: Sequence[Promise]) -> None:
        self.say(f"fitting {', '.join(one.chosen.name for one in promised)}")

    def _in_windows(self, best: Explanation, promise: Promise) -> _InWindows:
        return _InWindows(self.model, best.chosen, self.nominal, best.windows, promise)

    def _over_whole_runs(
        self, best: Explanation, in_windows: list[tuple[Chosen, Fit]]
    ) -> list[Explanation]:
        """The best of those fitted in windows, over whole runs."""
        if not in_windows:
            return []
        if _sight(best) is best.windows:
            # Else windows say next to nothing, and what was promised counts.
            in_windows.sort(key=lambda pair: pair[1].cost)
        least = min((fit for _, fit in in_windows), key=lambda fit: fit.cost)
        hopeful = [pair for pair in in_windows[:_WHOLE] if not _hopeless(pair[1], least)]
        self.say(f"over whole runs: {', '.join(one.name for one, _ in hopeful)}")
        return list(
            self.each(carried_out, [_Whole(self.model, best, one, fit) for one, fit in hopeful])
        )


def _more_than_luck(found: Iterable[Sequence[Promise] | Look]) -> list[Promise]:
    """The effects that jump, of which each promises more than luck; most first."""
    every = [one for look in found for one in (look() if isinstance(look, Look) else look)]
    return sorted((one for one in every if one.gain > one.luck), key=lambda one: -one.gain)


def carried_out(task: Callable[[], T]) -> T:
    """Do a task, here or in another process."""
    return task()


@dataclass(frozen=True)
class _InWindows:
    model: Model
    have: tuple[Chosen, ...]
    nominal: Fit
    fit: Fit
    promise: Promise

    def __call__(self) -> tuple[Chosen, Fit]:
        """The effect beside those that are there."""
        one, every = self.promise.chosen, (*self.have, self.promise.chosen)
        return one, explain(self.model, every, self.nominal, self.fit, self.promise.begins)


@dataclass(frozen=True)
class _Whole:
    model: Model
    less: Explanation
    one: Chosen
    fit: Fit

    def __call__(self) -> Explanation:
        """The fit over whole runs, from that over windows.

        One that ends higher than the fit without the effect went astray, and is made again from
        there.
        """
        whole, less = joined(self.model, self.fit), self.less.whole
        if whole.cost > less.cost + 1.0:
            values = {**self.fit.values, **less.values}
            problem = Problem(self.model, tuple(less.starts), whole.effects, whole.quantities)
            again = solve(problem, values, less.starts, steps=40)
            whole = min(whole, again, key=lambda fit: fit.cost)
        return Explanation((*self.less.chosen, self.one), self.fit, whole)


def _sight(best: Explanation) -> Fit:
    """The fit to look out from for what is missing.

    What is plain in windows is nearly linear there. What is not adds up over whole runs, and is
    small enough to be linear over them.
    """
    return best.windows if _left(best.windows) > PLAIN else best.whole


def _same(one: Explanation, best: Explanation, sight: Fit) -> Fit:
    """The fit of an explanation that is over what another was looked out from."""
    return one.windows if sight is best.windows else one.whole


def _hopeless(fit: Fit, best: Fit) -> bool:
    """Whether even in windows far more is left than with another effect."""
    return _left(fit) > 0.1 and _left(fit) > 20 * _left(best)


def _left(fit: Fit) -> float:
    """What a fit leaves, in sigma squared per value."""
    return fit.cost / fit.count - 1.0


RELEVANT = 0.01
"""By so much, in sigma squared per value, an effect has to lower the misfit to be one."""

_LITTLE = 0.1
"""In windows, an effect that leaves no more than that share of the misfit is there."""

_NEARLY_ALL = 0.9
"""What removes that share of a misfit is not only another way to make a rough model's error."""

_IMITATED = 0.05
"""Values that nobody would believe imitate an effect if they leave less of it, squared."""

_BETTER = 2.0
"""So much, in chi-square, an effect has to be better than wrong values."""


@dataclass(frozen=True)
class Judge:
    """What is weighed against what the model as believed leaves.

    first  misfit of the model as believed, RMS in sigma
    """

    rounds: Rounds
    first: float

    def gains(self, more: Explanation, less: Explanation) -> bool:
        """Whether what `more` adds to `less` is relevant, and certain in spite of model error."""
        relevant = max(RELEVANT, self.rounds.floor(less) ** 2 - FLOOR**2)
        sure = less.score - more.score > 20 * doubt(more.whole.cost, more.whole.count)
        if sure and rms(less.misfit) > FLOOR:
            gain = less.misfit - more.misfit
            if gain > relevant or gain > max(RELEVANT, _NEARLY_ALL * less.misfit):
                return True
        return self._believable(more, less)

    def _believable(self, more: Explanation, less: Explanation) -> bool:
        """Whether parameters explain the data, but with values that nobody would believe.

        An effect stands for that if with it they are likelier than with the wrong ones let go, and
        if what it does is what values do.
        """
        if (
            rms(less.misfit) > 2 * FLOOR
            or more.misfit > less.misfit + 1e-3
            or not self.doubtful(less)
        ):
            return False
        if more.apart() > _IMITATED:
            return False
        released = settled(self.rounds.model, less)
        let_go = _free(released) - _free(less)
        added = len(more.whole.quantities) - len(less.whole.quantities)
        price = (added - let_go) * math.log(less.whole.count)
        return more.strain + price < released.strain - _BETTER

    def doubtful(self, best: Explanation) -> bool:
        """Whether it takes a value that is not what it was believed to be, to make up for more than
        what every machine of the kind does otherwise than its model."""
        told = self.first > max(FLOOR, self.rounds.model.inexact)
        return told and any(not q.free for q in wrong(best.whole))


def outright(more: Explanation, less: Explanation) -> bool:
    """Whether `more` wins in windows already, which have no valleys to go down."""
    wins = less.windows.cost - more.windows.cost
    return wins > 0.3 * (less.whole.cost - more.whole.cost) and more.misfit < FLOOR


def plain(more: Explanation, less: Explanation) -> bool:
    """Whether windows show plainly that `more` leaves little of what `less` does."""
    before, after = misfit(less.windows), misfit(more.windows)
    return before > PLAIN and after < _LITTLE * before


def _free(one: Explanation) -> int:
    return sum(q.free for q in one.whole.quantities)


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
