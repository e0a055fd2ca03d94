"""What the servo makes of its command: a lag, an offset, a limited rate."""

import cmath
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from rr_opt.array import Array
from rr_opt.effects.effect import Effect, Parameter, Port, Values
from rr_opt.mechanics.drive import Drive, FreeJoint
from rr_opt.model.servo_command import LinearServo

_SAMPLES = 512
_FIRST_ORDER = 1e-6
"""A smaller beta, in units of tau squared, decays within any step."""
_NEGLIGIBLE = 1e-10
"""A smaller term, relative to the largest, is left out."""


def _servo_lag(command: Drive, values: Values, _: FreeJoint | None = None) -> Drive:
    """The servo follows late and with a smaller swing: beta phi" + tau phi' + phi = command.

    Without beta it is a first-order lag. The command is a Fourier series, to which the lag responds
    term by term with 1/(1 + i w tau - w^2 beta). From rest the response is that to the periodic
    command plus free terms that make up for the difference in angle and rate at t = 0, and decay.
    """
    tau, beta = values["tau"], values.get("beta", 0.0)
    if tau <= 0:
        return command
    grid = command.period * np.arange(_SAMPLES) / _SAMPLES
    terms = np.fft.rfft(command.at(grid)[0]) / _SAMPLES
    terms[1:] *= 2
    kept = np.flatnonzero(np.abs(terms) > _NEGLIGIBLE * np.abs(terms).max())
    omega = 2 * np.pi * kept / command.period
    response = terms[kept] / (1 + 1j * omega * tau - omega**2 * beta)
    derivatives = np.array([np.ones_like(omega), 1j * omega, -(omega**2)])

    def steady(t: Array) -> Array:
        turning = np.exp(1j * omega[:, None] * np.asarray(t)[None])
        return ((derivatives * response) @ turning).real

    if not command.rest:
        return replace(command, at=steady)
    before = command.at(np.array([-1.0]))[0, 0]
    angle, rate, _ = steady(np.array([0.0]))[:, 0]
    rates, amounts = _free_response(tau, beta, before - angle, -rate)

    def from_rest(t: Array) -> Array:
        since = np.maximum(np.asarray(t, float), 0.0)
        free = (amounts * rates ** np.arange(3)[:, None]) @ np.exp(rates[:, None] * since)
        still = np.array([[before], [0.0], [0.0]])
        return np.where(np.asarray(t) < 0, still, steady(t) + free.real)

    return replace(command, at=from_rest)


def _free_response(tau: float, beta: float, angle: float, rate: float) -> tuple[Array, Array]:
    """Rates (1/s) and amounts (rad) of the exponentials that start from this angle and rate."""
    if beta < _FIRST_ORDER * tau**2:
        return np.array([-1 / tau]), np.array([angle])
    # A double root is split by a hair, which changes nothing that counts.
    apart = cmath.sqrt(tau**2 - 4 * beta) or 1e-6 * tau
    rates = np.array([-tau + apart, -tau - apart]) / (2 * beta)
    first = (rate - rates[1] * angle) / (rates[0] - rates[1])
    return rates, np.array([first, angle - first])


SERVO_LAG = Effect(
    name="servo_lag",
    family="actuation",
    port=Port.ACTUATION,
    parameters=(
        Parameter("tau", "s", (0.0, 0.5), 0.02),
        Parameter("beta", "s^2", (0.0, 0.05), 2e-4),
    ),
    sentence="The servo follows its command late, and with a smaller swing.",
    actuate=_servo_lag,
    linear=lambda values: LinearServo(values["tau"], values.get("beta", 0.0)),
    forms=(("tau",), ("tau", "beta")),
)


def _servo_offset(command: Drive, values: Values, _: FreeJoint | None = None) -> Drive:
    shift = np.array([[values["offset"]], [0.0], [0.0]])
    return replace(command, at=lambda t: command.at(t) + shift)


SERVO_OFFSET = Effect(
    name="servo_offset",
    family="actuation",
    port=Port.ACTUATION,
    parameters=(Parameter("offset", "rad", (-0.5, 0.5), 0.02),),
    sentence="The servo's zero is off: the angle is the commanded one and a constant.",
    actuate=_servo_offset,
    linear=lambda values: LinearServo(shift=values["offset"]),
)


_STEPS = 500
"""Steps per period on which a time is bracketed before it is refined."""
_PERIODS = 10
"""Periods until it repeats: one with half the rate that is commanded, ten with a fifth."""


class _Segment(NamedTuple):
    """From time t (s) and angle y (rad) on the servo turns at `rate` (rad/s); 0: it follows its
    command."""

    t: float
    y: float
    rate: float


class _Limited(NamedTuple):
    """A command, sampled: angle, rate and acceleration (3, n) at the times (n,), s."""

    drive: Drive
    limit: float
    times: Array
    sampled: Array

    def segments(self, before: float) -> list[_Segment]:
        """What the servo does from the first of the times on, where its angle is `before`."""
        first = self.sampled[0, 0]
        here = _Segment(float(self.times[0]), before, 0.0)
        if before != first:
            here = here._replace(rate=float(np.copysign(self.limit, first - before)))
        segments, k = [here], 0
        while True:
            k, t = self._meeting(here, k) if here.rate else self._parting(k)
            if k == len(self.times):
                return segments
            angle, rate, _ = self.drive.at(np.array([t]))[:, 0].tolist()
            fast = not here.rate or abs(rate) > self.limit
            here = _Segment(t, angle, float(np.copysign(self.limit, rate)) if fast else 0.0)
            segments.append(here)

    def _parting(self, k: int) -> tuple[int, float]:
        """When the command begins to turn too fast: the index after that, and the time."""
        fast = np.flatnonzero(np.abs(self.sampled[1, k:]) > self.limit)
        if not len(fast):
            return len(self.times), 0.0
        k += int(fast[0])
        if k == 0:
            return 0, float(self.times[0])

        def excess(t: float) -> float:
            return abs(self.drive.at(np.array([t]))[1, 0]) - self.limit

        return k, _root(excess, self.times[k - 1], self.times[k])

    def _meeting(self, here: _Segment, k: int) -> tuple[int, float]:
        """When the command is met again."""
        times = self.times[k:]
        behind = np.sign(here.rate) * (self.sampled[0, k:] - here.y - here.rate * (times - here.t))
        met = np.flatnonzero((behind[1:] <= 0) & (times[1:] > here.t))
        if not len(met):
            return len(self.times), 0.0
        k += int(met[0]) + 1

        def gap(t: float) -> float:
            return self.drive.at(np.array([t]))[0, 0] - here.y - here.rate * (t - here.t)

        return k, _root(gap, max(self.times[k - 1], here.t), self.times[k])


def _servo_rate_limit(command: Drive, values: Values, _: FreeJoint | None = None) -> Drive:
    """The servo follows the command until that turns faster than the limit, continues at the limit,
    and follows the command again from where they meet. These times are found one after the other
    over some periods, the last of which repeats; between them the angle is known exactly.
    """
    limit = values["rate_limit"]
    times: Array = command.period / _STEPS * np.arange(_PERIODS * _STEPS + 1.0)
    limited = _Limited(command, limit, times, command.at(times))
    if np.abs(limited.sampled[1]).max() <= limit:
        return command
    before = command.at(np.array([-1.0])) if command.rest else limited.sampled
    starts, angles, rates = np.array(limited.segments(float(before[0, 0]))).T
    repeats = times[-1] - command.period

    def at(t: Array) -> Array:
        t = np.asarray(t, float)
        folded = repeats + (t - repeats) % command.period
        if command.rest:
            folded = np.where(t > repeats, folded, t)
        k = np.maximum(np.searchsorted(starts, folded, side="right") - 1, 0)
        turning = angles[k] + rates[k] * (folded - starts[k]), rates[k], np.zeros_like(folded)
        return np.where((rates[k] == 0) | (folded < 0), command.at(t), np.array(turning))

    return replace(command, at=at, jumps=starts[1:])


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    """Where a function changes sign, by false position (the Illinois rule)."""
    at_low, at_high = function(low), function(high)
    for _ in range(8):
        if at_low * at_high >= 0:
            break
        middle = (low * at_high - high * at_low) / (at_high - at_low)
        there = function(middle)
        if there * at_high < 0:
            low, at_low = high, at_high
        else:
            at_low /= 2
        high, at_high = middle, there
    return float(high)


SERVO_RATE_LIMIT = Effect(
    name="servo_rate_limit",
    family="actuation",
    port=Port.ACTUATION,
    parameters=(
        Parameter(
            *("rate_limit", "rad/s", (0.1, 100.0), 3.0),
            neutral=100.0,
            typical_for=lambda operated: operated.rate,
            initial_guesses=(0.9, 0.6),
            model_form_sigma=1e-4,
        ),
    ),
    sentence="The servo cannot turn faster than a limit, and falls behind its command.",
    actuate=_servo_rate_limit,
    linear=lambda values: LinearServo(rate=values["rate_limit"]),
    differentiable=False,
)
