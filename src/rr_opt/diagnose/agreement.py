"""Do recordings that were held out contradict an explanation, or tell what the others left open?

Two recordings along one side of a patch do not tell how wide it is, and one that goes around it is
then predicted wrong, through no fault of the explanation. So it is fitted to all recordings: where
values that those fitted first allow as well leave nothing in the others, these contradict nothing.
Nor do they often tell whether a patch is round or has a straight border, which says what is behind
the edge that was seen: then those held out tell.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from scipy.stats import chi2

from rr_opt.diagnose.explanation import Explanation
from rr_opt.diagnose.fit import Fit, solve
from rr_opt.diagnose.model import Array, Model, Piece
from rr_opt.diagnose.problem import Problem, doubt

_CHANCE = 1e-3
"""Of values that are right to lie so far from those fitted first."""

_TIE = 6.0
"""A lead in score by which odds are 20 to 1; less does not tell one form from another."""


def together(model: Model, best: Explanation, starts: Mapping[Piece, Array]) -> Fit | None:
    """An explanation fitted to all recordings; none if those fitted first speak against it.

    starts  of the recordings, whole, as far as they are known
    """
    first = best.whole
    problem = Problem(model, tuple(starts), first.effects, first.quantities)
    fit = solve(problem, first.values, starts)
    after = sum(fit.normals[piece].cost for piece in first.starts)
    allowed = chi2.isf(_CHANCE, len(first.quantities)) * doubt(first.cost, first.count)
    return fit if after - first.cost <= allowed else None


def other_forms(best: Explanation, tried: Sequence[Explanation]) -> list[Explanation]:
    """The same effects in other forms, which the recordings fitted do not tell from these."""
    tie = _TIE * doubt(best.whole.cost, best.whole.count)
    return [
        one
        for one in tried
        if set(one.names) == set(best.names)
        and set(one.chosen) != set(best.chosen)
        and one.score < best.score + tie
    ]
