"""A gait as set points of a controller, how a servo moves that follows them, and the cost.

A gait as set points at the rate of a controller, and how a servo moves that follows them.

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

from rr_opt.array import Array
from rr_opt.model.gait import FreeGait, Gait
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import require_friction
from rr_opt.motion.steady_cycle import require_regular, steady_cycle
from rr_opt.outcome import InputError

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


@dataclass(frozen=True)
class Cost:
    """Signed speeds, m/s: of the gait; with its period changed; with its set points held; and with
    them rounded to counts too (None if they are not)."""

    asked: float
    changed: float
    held: float
    rounded: float | None

    @property
    def left(self) -> float:
        """What is left of the speed in the end."""
        return self.held if self.rounded is None else self.rounded

    @property
    def steps(self) -> dict[str, float]:
        """What each step adds to the speed, m/s; below 0 where the robot gets slower."""
        sign = math.copysign(1.0, self.asked)
        steps = {
            "period": sign * (self.changed - self.asked),
            "holding": sign * (self.held - self.changed),
        }
        if self.rounded is not None:
            steps["rounding"] = sign * (self.rounded - self.held)
        return steps


def cost(robot: Robot, points: SetPoints, *, rounded: bool) -> Cost:
    """What each step from the gait to its set points does to the speed.

    Raises InputError for angles beyond the servo's counts, a robot without friction or a gait
    through the singular posture; NotConvergedError for a gait that does not settle.
    """
    require_friction(robot)
    require_regular(robot, points.gait)
    angles = [points.angles, *([points.rounded] if rounded else [])]
    driven = [points.gait, points.played, *(held(each, points.rate) for each in angles)]
    asked, changed, plain, *rest = (steady_cycle(robot, gait).speed for gait in driven)
    return Cost(asked, changed, plain, rest[0] if rest else None)
