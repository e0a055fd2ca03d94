"""A gait as set points at the rate of a controller, and how a servo moves that follows them.

A controller sends an angle every 1/rate seconds and holds it. A servo cannot jump: it is taken to
move at a constant speed from each set point to the next, and to be there when the next one comes.
At a set point its speed changes at a constant acceleration, over an eighth of the time between two
(straight lines with parabolic blends, as trajectory generators of servos have them). A longer or
shorter blend changes little while the steps are a few counts each; many set points a count make
jerks that no servo follows, and the rate they would need says so. A servo that lags moves less;
that needs a model of the servo and is not counted.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.outcome import InputError
from rr_opt.robot.free_gait import FreeGait
from rr_opt.robot.gait import Gait

Array = NDArray[np.float64]

COUNT = math.radians(300) / 1024
"""What one count of the servo CDS5516 is worth: 300 degrees over 1024 counts, rad."""
CENTRE, LAST = 512, 1023
"""The count of phi = 0, and the largest one."""

_FEWEST, _MOST = 8, 20_000
BLEND = 8
"""A blend lasts the time between two set points over this number."""


@dataclass(frozen=True)
class SetPoints:
    """A gait sampled at equal times, a whole number of times in its period.

    gait    as it was asked for
    rate    of the set points, 1/s
    played  the same gait with the period that is played
    angles  phi at 0, 1/rate, 2/rate, ..., rad, (N,)
    """

    gait: Gait
    rate: float
    played: Gait
    angles: Array

    @property
    def counts(self) -> NDArray[np.int_]:
        """The angles as counts of the servo. Raises InputError where it has no count for one."""
        counts = np.round(CENTRE + self.angles / COUNT).astype(int)
        if counts.min() < 0 or counts.max() > LAST:
            worst = math.degrees(self.angles[np.abs(self.angles).argmax()])
            raise InputError(
                f"The gait reaches {worst:.4g} degrees. The servo's counts, 0 to {LAST} with "
                f"{CENTRE} in the middle, cover -150 to 149.7 degrees. Lower the amplitude or "
                "the offset."
            )
        return counts

    @property
    def rounded(self) -> Array:
        """The angles that the counts stand for, rad. Raises InputError as `counts`."""
        return COUNT * (self.counts.astype(float) - CENTRE)


def set_points(gait: Gait, rate: float, *, keep_period: bool = False) -> SetPoints:
    """Sample a gait about `rate` times a second.

    Its period is changed to the nearest whole number of samples; or, keep_period, the rate is.
    Raises InputError for a gait that does not move, and for a rate that gives too few or too many
    of them.
    """
    if gait.amplitude == 0:
        raise InputError(
            "Read a gait with the amplitude 0. Expected one that moves the servo: set points of "
            "one angle drive nothing. Give an amplitude above 0."
        )
    count = round(gait.period * rate)
    if not _FEWEST <= count <= _MOST:
        raise InputError(
            f"--rate: {rate:g} set points a second are {count} in the period of "
            f"{gait.period:.4g} s. Expected {_FEWEST} to {_MOST} of them. Give another rate."
        )
    if keep_period:
        rate, played = count / gait.period, gait
    else:
        played = gait.resized(gait.amplitude, count / rate, gait.offset)
    return SetPoints(gait, rate, played, played.angle(np.arange(count) / rate))


def held(angles: Array, rate: float, blend: int = BLEND) -> FreeGait:
    """How the servo moves that is sent these angles (rad) again and again, `rate` times a second.

    The blend of each corner lies half before and half after its set point; the whole is late by
    that half, which changes no speed.
    """
    rates = (np.roll(angles, -1) - angles) * rate
    jumps = rates - np.roll(rates, 1)
    accelerations = np.zeros((len(angles), blend))
    accelerations[:, 0] = jumps * rate * blend
    before = float(rates[-1])
    return FreeGait(
        period=len(angles) / rate,
        angle0=float(angles[0]) - before / (2 * blend * rate),
        rate0=before,
        accelerations=tuple(map(float, accelerations.ravel())),
    )
