"""Search for what is missing: alone, in pairs, in threes; forward by promise, then backward.

Every round begins with a linearised pass over all effects (`screen`), which ranks them at once.
The most promising few are fitted in windows, and the best of those over whole runs, where small
effects add up and show. An effect joins only if the misfit falls by more than `RELEVANT`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace

from rr_opt.diagnose.explain import Chosen, explain, joined
from rr_opt.diagnose.explanation import FLOOR, Explanation, rms
from rr_opt.diagnose.fit import Fit, Problem, doubt, solve
from rr_opt.diagnose.left_out import left_out
from rr_opt.diagnose.model import Model
from rr_opt.diagnose.screen import LUCK, Promise, jumps, screen
from rr_opt.diagnose.values import settled, wrong

RELEVANT = 0.01
"""By so much, in sigma squared per value, an effect has to lower the misfit to be one."""

MOST = 3
"""So many effects together, at most."""

EXACT, ROUGH = 0.005, 0.03
"""Nor is an effect's model: what is left is none by the first share of the misfit of the model as
believed; by the second for an effect of which there are as many models as machines."""

_IN_WINDOWS, _DEAR, _WHOLE = 5, 4, 3
"""How many of a round are fitted in windows, of those the dear ones, and over whole runs."""

_WORTH = 0.05
"""Of what the best promises, any but the first few have to promise that share."""

_PLAIN = 0.05
"""Misfit in windows, in sigma squared, that is plain to see."""

_GAINED = 0.5
"""A third effect is looked for where the second has left no more than that share of the misfit."""

_NEARLY_ALL = 0.9
"""What removes that share of a misfit is not only another way to make a rough model's error."""

_IMITATED = 0.05
"""Values that nobody would believe imitate an effect if they leave less of it, squared."""

_ACROSS = 5.0
"""A recording predicted from the others may leave so many times what is left of all, RMS."""

_AS_MUCH = 0.5
"""Of what the others gain, a dear effect has to promise that share to be looked at beside them."""

_BETTER = 2.0
"""So much, in chi-square, an effect has to be better than wrong values."""

Say = Callable[[str], None]


@dataclass
class Search:
    """A search under way, and all that it tried.

    first  misfit of the model as believed, RMS in sigma
    """

    model: Model
    nominal: Fit
    base: Explanation
    first: float
    say: Say = lambda _: None
    each: Callable[..., Iterable] = map
    tried: list[Explanation] = field(default_factory=list)

    def floor(self, best: Explanation) -> float:
        """A misfit that is none, RMS in sigma, of a model with the effects of `best`."""
        return max(FLOOR, (ROUGH if self.rough(best) else EXACT) * self.first)

    def rough(self, best: Explanation) -> bool:
        """Whether an effect of `best` is one of which there are as many models as machines."""
        return any(q.name in self.model.rough for q in best.whole.quantities)

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
        return min(best, self._otherwise(best), key=lambda one: one.score)

    def _otherwise(self, best: Explanation) -> Explanation:
        """What the search finds without what is at a place at first, if that of `best` is doubtful.

        With its free place a patch follows a few recordings whatever they lack, but each of them is
        then predicted badly from the others.
        """
        across = rms(left_out(best.whole))
        placed = self.model.placed & set(best.names)
        if not placed or across <= _ACROSS * max(rms(best.misfit), FLOOR):
            return best
        others = [one for one in self.tried if len(one.chosen) == 1 and one.names[0] not in placed]
        if not others:
            return best
        return self._backward(self._forward(min(others, key=lambda one: one.score)))

    def _forward(self, best: Explanation) -> Explanation:
        gained = True
        for _ in range(len(best.chosen), MOST):
            explained = rms(best.misfit) <= max(FLOOR, EXACT * self.first)
            if (explained and (best.chosen or not _unbelievable(best))) or not gained:
                break
            found = self._round(best)
            if not found:
                break
            self.tried += found
            better = min(found, key=lambda one: one.score)
            if not _outright(better, best):
                best = self._again(best, better)
            if not self._gains(better, best):
                break
            # What is not there is imitated by one effect after the other, each gaining little.
            gained = not best.chosen or better.misfit < _GAINED * best.misfit
            best = better
        return best

    def _again(self, less: Explanation, more: Explanation) -> Explanation:
        """`less` from where `more` ended, if that is better.

        What joins must not win by a valley that the smaller set could have gone down too.
        """
        whole = less.whole
        values = {q.name: more.whole.values[q.name] for q in whole.quantities}
        problem = Problem(
            self.model, tuple(more.whole.starts), whole.effects, whole.quantities, whole.values
        )
        again = replace(less, whole=solve(problem, values, more.whole.starts))
        if again.score >= less.score:
            return less
        self.tried[:] = [again if one is less else one for one in self.tried]
        return again

    def _round(self, best: Explanation) -> list[Explanation]:
        """The explanations with one effect more that promise most."""
        fit = _sight(best)
        promised = screen(self.model, fit, best.chosen) + self._jumps(best, dear=False)
        promised.sort(key=lambda one: -one.gain)
        least = _WORTH * promised[0].gain if promised else 0.0
        worth = [one for k, one in enumerate(promised) if k < _WHOLE or one.gain > least]
        found = self._fitted(best, worth[:_IN_WINDOWS], _WHOLE)
        # What cannot be linearised is dear, and tried where nothing else will do, or where it
        # promises, from one step, about as much as the others gain.
        dear = self._jumps(best, dear=True)[:_DEAR]
        if min((rms(one.misfit) for one in found), default=math.inf) <= self.floor(best):
            least = _AS_MUCH * max(fit.cost - _same(one, best, fit).cost for one in found)
            dear = [one for one in dear if one.gain > least]
        return found + self._fitted(best, dear, _WHOLE)

    def _jumps(self, best: Explanation, *, dear: bool) -> list[Promise]:
        """The effects that jump, of which each promises more than luck."""
        fit = _sight(best)
        luck = LUCK * doubt(fit.cost, fit.count)
        promised = jumps(self.model, fit, best.chosen, dear=dear)
        return [one for one in promised if one.gain > luck]

    def _fitted(
        self, best: Explanation, promised: Sequence[Promise], most: int
    ) -> list[Explanation]:
        if not promised:
            return []
        self.say(f"fitting {', '.join(one.chosen.name for one in promised)}")
        in_windows = list(
            self.each(_InWindows(self.model, best.chosen, self.nominal, best.windows), promised)
        )
        if _sight(best) is best.windows:
            # Else windows say next to nothing, and what was promised counts.
            in_windows.sort(key=lambda pair: pair[1].cost)
        least = min((fit for _, fit in in_windows), key=lambda fit: fit.cost)
        hopeful = [pair for pair in in_windows[:most] if not _hopeless(pair[1], least)]
        self.say(f"over whole runs: {', '.join(one.name for one, _ in hopeful)}")
        return list(self.each(_Whole(self.model, best.chosen), hopeful))

    def _gains(self, more: Explanation, less: Explanation) -> bool:
        """Whether what `more` adds to `less` is relevant, and certain in spite of model error."""
        relevant = max(RELEVANT, self.floor(less) ** 2 - FLOOR**2)
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
            or not _unbelievable(less)
        ):
            return False
        if more.apart() > _IMITATED:
            return False
        released = settled(self.model, less)
        let_go = _free(released) - _free(less)
        added = len(more.whole.quantities) - len(less.whole.quantities)
        price = (added - let_go) * math.log(less.whole.count)
        return more.strain + price < released.strain - _BETTER

    def _backward(self, best: Explanation) -> Explanation:
        for one in best.chosen if len(best.chosen) > 1 else ():
            without = self._without(best, one)
            if not _outright(best, without):
                without = self._again(without, best)
            if not self._gains(best, without):
                return self._backward(without)
        return best

    def _looked_for_again(self, best: Explanation) -> Explanation:
        """One that leaves something, with what is at a place looked for again beside the others.

        It was found where it made up best for what they had not yet accounted for.
        """
        if len(best.chosen) < 2 or rms(best.misfit) <= self.floor(best):
            return best
        for one in best.chosen:
            if one.name in self.model.placed:
                without = self._without(best, one)
                places = [p for p in self._jumps(without, dear=True) if p.chosen.name == one.name]
                found = self._fitted(without, places, _WHOLE)
                self.tried += found
                best = min([best, *found], key=lambda tried: tried.score)
        return best

    def _without(self, best: Explanation, one: Chosen) -> Explanation:
        """The explanation that leaves one effect out, as it was tried or as it is now."""
        rest = tuple(other for other in best.chosen if other.name != one.name)
        tried = next((tried for tried in self.tried if tried.chosen == rest), None)
        if tried is None:
            self.say(f"leaving out {one.name}")
            fit = explain(self.model, rest, self.nominal, best.windows)
            tried = Explanation(rest, fit, joined(self.model, fit))
            self.tried.append(tried)
        return tried


@dataclass(frozen=True)
class _InWindows:
    model: Model
    have: tuple[Chosen, ...]
    nominal: Fit
    fit: Fit

    def __call__(self, promise: Promise) -> tuple[Chosen, Fit]:
        """The effect beside those that are there."""
        one, every = promise.chosen, (*self.have, promise.chosen)
        return one, explain(self.model, every, self.nominal, self.fit, promise.begins)


@dataclass(frozen=True)
class _Whole:
    model: Model
    have: tuple[Chosen, ...]

    def __call__(self, pair: tuple[Chosen, Fit]) -> Explanation:
        """The fit over whole runs, from that over windows."""
        one, fit = pair
        return Explanation((*self.have, one), fit, joined(self.model, fit))


def _unbelievable(best: Explanation) -> bool:
    """Whether it takes a value that is not what it was believed to be."""
    return any(not q.free for q in wrong(best.whole))


def _free(one: Explanation) -> int:
    return sum(q.free for q in one.whole.quantities)


def _sight(best: Explanation) -> Fit:
    """The fit to look out from for what is missing.

    What is plain in windows is nearly linear there. What is not adds up over whole runs, and is
    small enough to be linear over them.
    """
    seen = best.windows.cost / best.windows.count - 1.0
    return best.windows if seen > _PLAIN else best.whole


def _same(one: Explanation, best: Explanation, sight: Fit) -> Fit:
    """The fit of an explanation that is over what another was looked out from."""
    return one.windows if sight is best.windows else one.whole


def _hopeless(fit: Fit, best: Fit) -> bool:
    """Whether even in windows far more is left than with another effect."""
    left = fit.cost / fit.count - 1.0
    return left > 0.1 and left > 20 * (best.cost / best.count - 1.0)


def _outright(more: Explanation, less: Explanation) -> bool:
    """Whether `more` wins in windows already, which have no valleys to go down."""
    wins = less.windows.cost - more.windows.cost
    return wins > 0.3 * (less.whole.cost - more.whole.cost) and more.misfit < FLOOR
