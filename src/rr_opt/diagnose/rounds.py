"""A round of the search: which effects promise most beside an explanation, fitted.

A linearised pass over all effects (`screen`) ranks them at once. The most promising few are fitted
in windows, and the best of those over whole runs, where small effects add up and show.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from rr_opt.diagnose.explain import Chosen, explain, joined
from rr_opt.diagnose.explanation import FLOOR, Explanation, rms
from rr_opt.diagnose.fit import Fit, solve
from rr_opt.diagnose.model import Model
from rr_opt.diagnose.problem import Problem
from rr_opt.diagnose.screen import Look, Promise, looks, screen

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
