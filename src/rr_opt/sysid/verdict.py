"""From what was fitted to a verdict."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from rr_opt.sysid.candidate import FLOOR, Explanation, certain, rms
from rr_opt.sysid.diagnosis import Estimate, Finding, Verdict
from rr_opt.sysid.least_squares import doubt

LEFT = 0.35
"""More misfit than this on the held-out recordings, RMS in sigma, is not explained."""

SHARE, SHARE_OF_ROUGH = 0.02, 0.1
"""Nor is more than this share of the misfit that the parameters alone leave; the second where an
effect is rough."""

NEAR, SHARE_OF_NOMINAL = 0.5, 0.05
"""Where the held-out recordings are predicted to within the first, RMS in sigma beyond the noise,
the second share is enough of the misfit of the model as believed, which parameters imitate."""

_ALIKE = 3.0
"""Recordings that were fitted are as inexact as those that were not: of these no more than so many
times what is left of the others, RMS, is put down to that."""

_LIKELY = 2.33
"""Noise reaches so many standard deviations once in a hundred."""


def verdict_of(
    best: Explanation,
    base: Explanation,
    nominal: float,
    held: tuple[float, float],
    inexact: float,
    *,
    moved: bool,
    rough: bool,
    systematic: bool,
) -> Verdict:
    """The verdict.

    nominal  misfit of the model as believed, RMS in sigma beyond the noise, in fitted or held-out
             recordings, where it is more
    held     the same of the held-out recordings, with the parameters alone and with everything
    inexact  misfit of the model as believed that says nothing about its values, and of held-out
             recordings that says nothing about what is missing
    moved    whether a parameter left what was known of it
    rough    whether an effect is one of which there are as many models as machines
    systematic  whether what is left with the effects still depends on something
    """
    if not best.chosen:
        left = certain(base.misfit, base.whole.count, _LIKELY)
        if left > FLOOR:
            return "unexplained"
        if held[0] > max(LEFT, inexact):
            # Parameters may be bent to what no machine has of its model exactly, and then predict
            # worse than those that were believed.
            return "consistent" if nominal <= max(LEFT, inexact) else "unexplained"
        return "parameters" if moved and nominal > max(FLOOR, inexact) else "consistent"
    excused = min(inexact, max(NEAR, _ALIKE * rms(best.misfit)))
    apart = held[1] if held[1] > excused else 0.0
    left = max(certain(best.misfit, best.whole.count), apart)
    before = max(rms(base.misfit), held[0])
    explained = left <= max(LEFT, (SHARE_OF_ROUGH if rough else SHARE) * before)
    if held[1] <= NEAR and left <= SHARE_OF_NOMINAL * nominal:
        explained = True
    return "missing_physics" if explained and not systematic else "unexplained"


def confidence(best: Explanation, rivals: Sequence[Explanation], without: float) -> float:
    """How sure the names are, against all rivals, in the light of what model error is left.

    without  misfit without any effect, RMS in sigma: as `FLOOR` counts as none, so much of it is
             not shown to be an effect's, and something outside the catalogue may imitate the rest
    """
    wider = doubt(best.whole.cost, best.whole.count)
    against = sum(
        math.exp(-min(max(rival.score - best.score, 0.0) / (2 * wider), 700.0)) for rival in rivals
    )
    shown = 1.0 - (FLOOR / without) ** 2 if without > FLOOR else 1.0
    return shown / (1.0 + against)


def finding(name: str, sure: float, intervals: Mapping[str, Estimate], removes: float) -> Finding:
    """An accepted effect as the answer tells it."""
    own = {
        key.split(".", 1)[1]: value
        for key, value in intervals.items()
        if key.startswith(f"{name}.")
    }
    return Finding(name, sure, own, removes, minor=removes < 0.05)
