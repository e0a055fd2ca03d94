"""Whether an effect joins an explanation: its gain is relevant, certain, and not a value's doing.

An effect joins only if the misfit falls by more than `RELEVANT`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from rr_opt.diagnose.explanation import FLOOR, Explanation, misfit, rms
from rr_opt.diagnose.problem import doubt
from rr_opt.diagnose.rounds import PLAIN, Rounds
from rr_opt.diagnose.values import settled, wrong

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
