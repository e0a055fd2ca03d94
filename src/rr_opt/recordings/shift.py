"""From a recording's own clock to the command's, by two fits one after the other."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.recordings.clock_fit import ClockFit

Array = NDArray[np.float64]

_SURE = 3.0
_COVERED = 1.959964
_LOSS = 1e-3
"""phi may move by so much less than the servo's shaft before play is suspected."""


@dataclass(frozen=True)
class Shift:
    """The command's time is t + offset + drift (t - t_mid).

    offset, drift  s, and s per s; sigma: their standard deviations
    play           by how much of the offset phi may be late behind the servo's shaft, s, as what
                   gives between them makes phi move less
    applied        whether the recording was moved: only if the offset or the drift is surely there
    """

    offset: float
    drift: float
    sigma: tuple[float, float]
    t_mid: float
    play: float
    applied: bool

    def of(self, t: Array) -> Array:
        """The command's times of the recording's times t (n,), s."""
        return t + self.offset + self.drift * (t - self.t_mid)

    def interval(self, which: int = 0) -> tuple[float, float]:
        """95 % interval of the offset (0), s, or of the drift (1)."""
        value, half = (self.offset, self.drift)[which], _COVERED * self.sigma[which]
        return value - half, value + half

    def __str__(self) -> str:
        low, high = self.interval()
        return (
            f"t {self.offset:+.5f} s (95 %: {low:+.5f} to {high:+.5f} s), and gains "
            f"{1e6 * self.drift:+.3g} +- {_COVERED * 1e6 * self.sigma[1]:.2g} us a second"
        )


def shift_of(log: ClockFit, goal: ClockFit, period: float, *, rest: bool) -> Shift:
    """The two fits as one; the capture's time to the log's, and the log's to the command's.

    rest: the command has a beginning. Otherwise it is the same a period (s) later, and the shift
    nearest to none is told.
    """
    since = log.t_mid + log.offset - goal.t_mid
    offset = log.offset + goal.offset + goal.drift * since
    if not rest:
        offset -= period * round(offset / period)
    drift = (1 + log.drift) * (1 + goal.drift) - 1
    sigma = (
        math.hypot(log.sigma[0], goal.sigma[0], since * goal.sigma[1]),
        math.hypot(log.sigma[1], goal.sigma[1]),
    )
    loses = log.scale < 1 - max(_LOSS, _SURE * log.sigma[2])
    play = math.acos(max(log.scale, 0.0)) * period / (2 * math.pi) if loses else 0.0
    sure = abs(offset) > max(_SURE * sigma[0], play) or (
        abs(drift) > _SURE * sigma[1] and not loses
    )
    return Shift(offset, drift, sigma, log.t_mid, play, sure)
