"""The joint motion that a servo makes of its command, and problems posed for the joint.

Gaits are optimised as the angle of the joint, for which lag, zero and rate limit of the servo are
bounds, not physics. Only play is more: its effect depends on how the robot moves.
"""

from dataclasses import replace
from functools import reduce

import numpy as np

from rr_opt.effects import CATALOGUE
from rr_opt.mechanics.drive import Drive, commanded
from rr_opt.model.gait import FourierGait, Gait
from rr_opt.model.problem import Interval, Problem
from rr_opt.model.robot import Robot
from rr_opt.model.servo_command import CommandBounds, LinearServo
from rr_opt.motion.floor_motion import free_joint

_PERIODS = 257
"""Periods of a range at which the least and largest gain are sought."""
_ROOM = 1e-3
"""Relative margin of the joint's bounds, so that only the command's own bounds are active."""


def linear_servo(robot: Robot) -> LinearServo:
    """The robot's servo without its play."""
    uses = [(CATALOGUE[use.name].linear, use.values) for use in robot.physics]
    parts = (linear(values) for linear, values in uses if linear)
    return reduce(_in_series, parts, LinearServo())


def _in_series(one: LinearServo, other: LinearServo) -> LinearServo:
    # A robot lists each effect once, so at most one of them lags.
    return LinearServo(
        one.tau + other.tau,
        one.beta + other.beta,
        one.shift + other.shift,
        min(one.rate, other.rate),
    )


def servo_limited(problem: Problem) -> Problem:
    """The problem with the rate that its robot's servo reaches as a limit."""
    rate = min(problem.limits.rate, linear_servo(problem.robot).rate)
    limited = replace(problem, limits=replace(problem.limits, rate=rate))
    return limited.read_from(problem.name, problem.sha256)


def for_joint(problem: Problem) -> Problem:
    """The problem posed for the joint; itself where the servo follows its command exactly."""
    servo = linear_servo(problem.robot)
    if problem.command or servo == LinearServo():
        return problem
    gait, amplitude = problem.gait, problem.gait.amplitude
    if servo.lags and gait.shape == "sine":
        gains = servo.gain(np.geomspace(gait.period.low, gait.period.high, _PERIODS))
        room = 0.0 if amplitude.fixed and gait.period.fixed else _ROOM
        amplitude = Interval(
            amplitude.low * float(gains.min()) * (1 - room),
            amplitude.high * float(gains.max()) * (1 + room),
        )
    offset = Interval(gait.offset.low + servo.shift, gait.offset.high + servo.shift)
    return replace(
        servo_limited(problem),
        gait=replace(gait, amplitude=amplitude, offset=offset),
        command=CommandBounds(gait.amplitude, servo),
    ).read_from(problem.name, problem.sha256)


_HARMONICS = 24
"""The n-th harmonic of an angle whose rate jumps falls as 1/n^2: truncation changes the speed by
less than a thousandth."""
_SAMPLES = 2048
_SETTLED = 20
"""Periods after which the servo's motion repeats."""


def servo_drive(robot: Robot, gait: Gait) -> Drive:
    """phi(t) that the servo makes of a gait, its effects applied one after the other in the
    catalogue's order, whatever the robot's."""
    drive, joint = commanded(gait, False), free_joint(robot)
    values = {use.name: use.values for use in robot.physics}
    for name, effect in CATALOGUE.items():
        if effect.actuate and name in values:
            drive = effect.actuate(drive, values[name], joint)
    return drive


def servo_made(robot: Robot, gait: Gait) -> Gait:
    """The periodic motion that the servo makes of a gait: the gait itself without effects, one of
    the same shape if the servo is linear, else a sum of harmonics."""
    uses = [use for use in robot.physics if CATALOGUE[use.name].actuate]
    servo = linear_servo(robot)
    if all(CATALOGUE[use.name].linear for use in uses):
        made = servo.response_to(gait) if uses else gait
        if max(made.peak_rate, gait.peak_rate) <= servo.rate:
            return made
    t = gait.period * (_SETTLED + np.arange(_SAMPLES) / _SAMPLES)
    part = np.fft.rfft(servo_drive(robot, gait).at(t)[0]) / _SAMPLES
    sizes = part[1 : _HARMONICS + 1]
    return FourierGait(
        gait.period,
        float(part[0].real),
        tuple((-2 * sizes.imag).tolist()),
        tuple((2 * sizes.real).tolist()),
    )
