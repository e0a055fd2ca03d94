"""A gait as set points of a controller, the motion of a servo that follows them, and their cost.

A controller sends an angle every 1/rate seconds and holds it. A servo cannot jump: it is taken to
move at constant speed from each set point to the next, and to be there when the next one comes. At
a set point its speed changes at a constant acceleration, over an eighth of the time between two
(straight lines with parabolic blends, as trajectory generators of servos use). A longer or shorter
blend changes little while each step is a few counts of the servo; many set points per count make
jerks that no servo follows, as the rate they need shows. Effects of the servo on this motion, such
as a lag, count if `physics` lists them.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.model.gait import FreeGait, Gait
from rr_opt.model.problem import LARGEST_EXCESS, Limits
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import require_friction
from rr_opt.motion.servo import servo_made
from rr_opt.motion.steady_cycle import grip_needed, peak_torque, require_regular, steady_cycle
from rr_opt.outcome import InputError

COUNT = math.radians(300) / 1024
"""One count of the servo CDS5516, rad: 300 degrees over 1024 counts."""
CENTRE, LAST = 512, 1023
"""The count of phi = 0, and the largest one."""

_FEWEST, _MOST, _USUAL = 8, 20_000, 125.0
BLEND = 8
"""Time between two set points over the duration of a blend."""


@dataclass(frozen=True)
class SetPoints:
    """A gait sampled at equal times, a whole number of times per period.

    gait    as it was asked for
    rate    of the set points, 1/s
    played  the gait with the period in which the set points are played
    angles  phi at 0, 1/rate, 2/rate, ..., rad, (N,)
    """

    gait: Gait
    rate: float
    played: Gait
    angles: Array

    @property
    def counts(self) -> NDArray[np.int_]:
        """The angles as counts of the servo. Raises InputError if they exceed its range."""
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


def usual_rate(rate_limit: float = math.inf) -> float:
    """Of set points, 1/s: the most, up to 125, at which a rate limit (rad/s) is a whole number of
    counts a step, so that rounding to counts takes no gait beyond it."""
    counts = rate_limit / COUNT
    return counts / math.ceil(counts / _USUAL) if math.isfinite(counts) else _USUAL


def set_points(gait: Gait, rate: float, *, keep_period: bool = False) -> SetPoints:
    """Sample a gait about `rate` times a second.

    Its period is changed to the nearest whole number of samples; with keep_period, the rate is.
    Raises InputError for a gait that does not move, and for a rate that gives too few or too many
    samples.
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


def interpolated(angles: Array, rate: float, blend: int = BLEND) -> FreeGait:
    """The motion of a servo that is sent these angles (rad) periodically, `rate` times a second.

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


def excess(robot: Robot, limits: Limits, gait: Gait) -> float:
    """By how much the steady motion of a gait breaks the worst limit, relative to it.

    Raises NotConvergedError for a gait that does not settle.
    """
    joint = servo_made(robot, gait)
    steady = steady_cycle(robot, joint)
    reached = {
        "angle": joint.peak_angle,
        "rate": joint.peak_rate,
        "torque": peak_torque(steady),
        "singularity": float(robot.S1(joint.peak_angle)),
        "grip": max(grip_needed(steady, robot)),
    }
    return limits.worst(reached)[1]


_HALVINGS = 12
"""The amplitude is found to 1/4096."""


def within_limits(
    robot: Robot, limits: Limits, points: SetPoints, *, rounded: bool = False
) -> SetPoints:
    """The set points with the amplitude lowered until they are within the limits.

    rounded: also the steps between the counts that they are rounded to.
    Raises InputError if no amplitude does.
    """
    times, played = np.arange(len(points.angles)) / points.rate, points.played

    def scaled(share: float) -> SetPoints:
        lower = played.resized(share * played.amplitude, played.period, played.offset)
        return replace(points, played=lower, angles=lower.angle(times))

    def kept(candidate: SetPoints) -> bool:
        steps = candidate.rounded if rounded else candidate.angles
        too_fast = interpolated(steps, points.rate).peak_rate / (limits.rate or math.inf) - 1
        return max(too_fast, excess(robot, limits, candidate.played)) <= LARGEST_EXCESS

    if kept(points):
        return points
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if kept(scaled(middle)) else (low, middle)
    if not low:
        raise InputError(
            "No amplitude keeps the set points within the limits. Expected steps of one count to "
            "be enough. Lower --rate, raise the limits, or give --no-within-limits."
        )
    return scaled(low)


def lag(angles: Array, rate: float, rate_limit: float) -> float:
    """How far a servo that is sent these angles periodically, and turns at rate_limit, is behind.

    rad, the largest in a period.
    """
    step, at, worst = rate_limit / rate, float(angles[0]), 0.0
    for target in np.tile(angles, 2):
        at += float(np.clip(target - at, -step, step))
        worst = max(worst, abs(target - at))
    return worst


@dataclass(frozen=True)
class Cost:
    """Signed speeds, m/s, after each step from a gait to its set points.

    nominal       of the gait
    resampled     with its period changed to a whole number of set points
    interpolated  with the servo moving from set point to set point
    rounded       with the set points rounded to counts too; None if they are not
    """

    nominal: float
    resampled: float
    interpolated: float
    rounded: float | None

    @property
    def final(self) -> float:
        """After all steps."""
        return self.interpolated if self.rounded is None else self.rounded

    @property
    def steps(self) -> dict[str, float]:
        """What each step adds to the speed, m/s; below 0 where the robot gets slower."""
        sign = math.copysign(1.0, self.nominal)
        steps = {
            "period": sign * (self.resampled - self.nominal),
            "holding": sign * (self.interpolated - self.resampled),
        }
        if self.rounded is not None:
            steps["rounding"] = sign * (self.rounded - self.interpolated)
        return steps


def cost(robot: Robot, points: SetPoints, *, rounded: bool) -> Cost:
    """The effect of each step from the gait to its set points on the speed.

    Raises InputError for angles beyond the servo's counts, a robot without friction or a gait
    through the singular posture; NotConvergedError for a gait that does not settle.
    """
    require_friction(robot)
    require_regular(robot, servo_made(robot, points.gait))
    angles = [points.angles, *([points.rounded] if rounded else [])]
    gaits = [points.gait, points.played, *(interpolated(each, points.rate) for each in angles)]
    speeds = [steady_cycle(robot, servo_made(robot, gait)).speed for gait in gaits]
    return Cost(*speeds[:3], rounded=speeds[3] if rounded else None)
