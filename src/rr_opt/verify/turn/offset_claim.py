"""Does the sign of the offset set the direction of the turn, and a larger one a smaller radius?

The paper says both. Each half is held against every gait of a map.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.model.gait import SineGait
from rr_opt.verify.turn.chart import TurnMap

_LEVEL = 1e-5
"""A radius has to grow by this much, relative, to count as growing."""


@dataclass(frozen=True)
class SignClaim:
    """Of the gaits at phi0 > 0 that keep every limit: how many there are, and how many of them
    drive forward and turn left, and so on. The claim holds if all turn to one side.

    exception   of the rarer side, the gait with the least offset; None if there is none
    """

    gaits: int
    forward_left: int
    forward_right: int
    backward_left: int
    backward_right: int
    exception: SineGait | None

    @property
    def holds(self) -> bool:
        """Every offset of one sign turns to one side."""
        return self.exception is None

    @property
    def rarer(self) -> int:
        """Gaits that turn to the rarer side."""
        left = self.forward_left + self.backward_left
        return min(left, self.gaits - left)

    @property
    def holds_each_way(self) -> bool:
        """Every offset of one sign turns to one side among the gaits that drive the same way."""
        return not (
            (self.forward_left and self.forward_right)
            or (self.backward_left and self.backward_right)
        )


@dataclass(frozen=True)
class RadiusClaim:
    """Of the curves of one amplitude and period: on how many the radius grows somewhere as the
    offset does.

    first    the least offset from which one grows, and its gait; None if none does
    factor   the most by which a radius exceeds the smallest at a lesser offset; inf where the
             turn changes sides on the way
    worst    the gait there
    """

    curves: int
    growing: int
    first: SineGait | None
    factor: float
    worst: SineGait | None

    @property
    def holds(self) -> bool:
        """No radius grows."""
        return self.growing == 0


def sign_claim(seen: TurnMap) -> SignClaim:
    """Hold the first half of the claim against a map."""
    kept = seen.keeps & (seen.offset > 0) & (seen.heading != 0)
    left, ahead = seen.heading > 0, seen.speed > 0
    count = [int((kept & way & turn).sum()) for way in (ahead, ~ahead) for turn in (left, ~left)]
    rarer = kept & (left if count[0] + count[2] <= count[1] + count[3] else ~left)
    first = None
    if rarer.any():
        where = np.argwhere(rarer)
        first = _gait(seen, where[np.argmin(where[:, 2])])
    return SignClaim(int(kept.sum()), count[0], count[1], count[2], count[3], first)


def radius_claim(seen: TurnMap) -> RadiusClaim:
    """Hold the second half of the claim against a map."""
    curvature = np.where(seen.keeps & (seen.offset > 0), seen.curvature, np.nan)
    curves = growing = 0
    first: SineGait | None = None
    worst: SineGait | None = None
    factor = 1.0
    for i, j in np.ndindex(curvature.shape[:2]):
        along = curvature[i, j]
        at = np.flatnonzero(np.isfinite(along))
        if len(at) < 2:
            continue
        curves += 1
        # Through straight the radius grows without bound before the turn changes sides.
        sides = np.sign(along[at])
        size = np.abs(along[at])
        grown = np.maximum.accumulate(size) / size
        changed = np.flatnonzero(sides[1:] != sides[:-1])
        grows = np.flatnonzero(size[1:] < size[:-1] * (1 - _LEVEL))
        begins = min([*grows, *changed], default=None)
        if begins is None:
            continue
        growing += 1
        start = _gait(seen, np.array([i, j, at[begins]]))
        if first is None or start.offset < first.offset:
            first = start
        most = np.inf if len(changed) else float(grown.max())
        if most > factor:
            where = at[changed[0] + 1] if len(changed) else at[int(grown.argmax())]
            factor, worst = most, _gait(seen, np.array([i, j, where]))
    return RadiusClaim(curves, growing, first, factor, worst)


def _gait(seen: TurnMap, index: NDArray[np.int_]) -> SineGait:
    i, j, k = (int(part) for part in index)
    return SineGait(float(seen.amplitude[i]), float(seen.period[j]), float(seen.offset[k]))
