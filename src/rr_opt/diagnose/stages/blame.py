"""Which of several stages that share one equation is to blame.

Their columns overlap, so each is tested with the others fitted along. Where several could explain
all that is wrong, none of these tests sees anything. So of those that explain it alone the first is
taken that does so as well as the best; and only if none does, the first without which the others
are worse off.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rr_opt.diagnose.stages.gram import Gram, Worth

FALSE_ALARM = 0.01
"""Chance that any stage is called guilty where none is."""

FLOOR = 0.1
"""A fault of less is none, RMS in sigma."""

MODEL_ERROR = 0.05
"""So much of a fault's size may come from how it is described; less is not held against a stage."""

CLEAR = 25.0
"""Chi-square beyond noise by which one explanation is better than another."""

_LEAST = 0.25
"""A stage to blame is worth so much of the one that is worth most: half its size."""


@dataclass(frozen=True)
class Blame:
    """worth: of each stage with the others fitted along; guilty: the first to blame, if any.

    alone  what the guilty one is worth without the others
    """

    worth: Mapping[str, Worth]
    guilty: str
    alone: Worth


def blame(gram: Gram, names: Sequence[str], limit: float, *, wrong: bool) -> Blame:
    """Test each, upstream first.

    limit  the chance of noise alone below which a stage counts
    wrong  whether what all of them explain together is large enough to matter
    """
    every = gram.together(names)
    worth = {one: gram.worth(one, [n for n in names if n != one]) for one in names}
    alone = {one: gram.together((one,)) for one in names}
    if not wrong or every.p > limit:
        return Blame(worth, "", Worth(0.0, 0))
    # A stage may leave what is none, or what comes from how it is described, and explain all.
    described = MODEL_ERROR**2 * every.beyond
    enough = every.beyond - max(FLOOR**2 * gram.count, described)
    able = [one for one in names if alone[one].beyond >= enough and alone[one].p < limit]
    if able:
        best = max(alone[one].beyond for one in able) - max(CLEAR, described)
        first = next(one for one in able if alone[one].beyond >= best)
    else:
        most = max(w.beyond for w in worth.values())
        seen = [one for one in names if worth[one].p < limit and worth[one].beyond > _LEAST * most]
        first = seen[0] if seen else max(names, key=lambda one: alone[one].chi2)
    return Blame(worth, first, alone[first])
