"""A servo with a limited rate: it falls behind its command and catches up.

It follows the command until that turns faster than the limit, continues at the limit, and follows
the command again from where they meet. These times are found one after the other over some periods,
the last of which repeats; between them the angle is known exactly.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from rr_opt.array import Array
from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.drive import Drive, FreeJoint
from rr_opt.model.servo_command import LinearServo

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
            angle, rate = self._between(k)(t)
            fast = not here.rate or abs(rate) > self.limit
            here = _Segment(t, angle, float(np.copysign(self.limit, rate)) if fast else 0.0)
            segments.append(here)

    def _between(self, k: int) -> Callable[[float], tuple[float, float]]:
        """The command's angle and rate between sample k - 1 and k, by Hermite's quintic."""
        k = max(k, 1)
        begin, h = float(self.times[k - 1]), float(self.times[k] - self.times[k - 1])
        (y, y1), (v, v1), (a, a1) = (self.sampled[:, k - 1 : k + 1] * [[1], [h], [h**2]]).tolist()
        off, turn, bend = y1 - y - v - a / 2, v1 - v - a, a1 - a
        c3 = 10 * off - 4 * turn + bend / 2
        c4, c5 = 7 * turn - 15 * off - bend, 6 * off - 3 * turn + bend / 2

        def at(t: float) -> tuple[float, float]:
            s = (t - begin) / h
            angle = y + s * (v + s * (a / 2 + s * (c3 + s * (c4 + s * c5))))
            rate = v + s * (a + s * (3 * c3 + s * (4 * c4 + s * 5 * c5)))
            return angle, rate / h

        return at

    def _parting(self, k: int) -> tuple[int, float]:
        """When the command begins to turn too fast: the index after that, and the time."""
        fast = np.flatnonzero(np.abs(self.sampled[1, k:]) > self.limit)
        if not len(fast):
            return len(self.times), 0.0
        k += int(fast[0])
        if k == 0:
            return 0, float(self.times[0])

        command = self._between(k)

        def excess(t: float) -> float:
            return abs(command(t)[1]) - self.limit

        return k, _root(excess, self.times[k - 1], self.times[k])

    def _meeting(self, here: _Segment, k: int) -> tuple[int, float]:
        """When the command is met again."""
        times = self.times[k:]
        behind = np.sign(here.rate) * (self.sampled[0, k:] - here.y - here.rate * (times - here.t))
        met = np.flatnonzero((behind[1:] <= 0) & (times[1:] > here.t))
        if not len(met):
            return len(self.times), 0.0
        k += int(met[0]) + 1

        command = self._between(k)

        def gap(t: float) -> float:
            return command(t)[0] - here.y - here.rate * (t - here.t)

        return k, _root(gap, max(self.times[k - 1], here.t), self.times[k])


def _actuate(command: Drive, values: Mapping[str, float], _: FreeJoint | None = None) -> Drive:
    limit = values["rate_limit"]
    times: Array = command.period / _STEPS * np.arange(_PERIODS * _STEPS + 1.0)
    limited = _Limited(limit, times, command.at(times))
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


EFFECT = Effect(
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
    actuate=_actuate,
    linear=lambda values: LinearServo(rate=values["rate_limit"]),
    differentiable=False,
)
