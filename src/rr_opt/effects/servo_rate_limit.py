"""A servo that cannot turn faster than a limit: it falls behind its command and catches up.

It keeps to the command until that turns faster than the limit, goes on at the limit, and keeps to
the command again from where they meet. These times are found one after the other over some
periods, the last of which repeats; between them the angle is known exactly.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from rr_opt.array import Array
from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.drive import Drive, FreeJoint

_STEPS = 500
"""A period, on which to look for a time that is then refined."""
_PERIODS = 10
"""After so many it repeats: with half the rate that is asked for after one, a fifth after ten."""


class _Stretch(NamedTuple):
    """From time t (s) and angle y (rad) the servo turns at `rate` (rad/s), or keeps to its command
    (0)."""

    t: float
    y: float
    rate: float


def _actuate(told: Drive, values: Mapping[str, float], _: FreeJoint | None = None) -> Drive:
    limit = values["rate_limit"]
    times: Array = told.period / _STEPS * np.arange(_PERIODS * _STEPS + 1.0)
    command = told.at(times)
    if np.abs(command[1]).max() <= limit:
        return told
    before = float(told.at(np.array([-1.0]))[0, 0]) if told.rest else float(command[0, 0])
    starts, angles, rates = np.array(_stretches(told, limit, times, command, before)).T
    repeats = times[-1] - told.period

    def at(t: Array) -> Array:
        t = np.asarray(t, float)
        folded = repeats + (t - repeats) % told.period
        if told.rest:
            folded = np.where(t > repeats, folded, t)
        k = np.maximum(np.searchsorted(starts, folded, side="right") - 1, 0)
        turning = angles[k] + rates[k] * (folded - starts[k]), rates[k], np.zeros_like(folded)
        return np.where((rates[k] == 0) | (folded < 0), told.at(t), np.array(turning))

    return replace(told, at=at, jumps=starts[1:])


def _stretches(
    told: Drive, limit: float, times: Array, command: Array, before: float
) -> list[_Stretch]:
    """What the servo does, one thing after the other, from the first of the times on."""
    k, here = 0, _Stretch(float(times[0]), before, 0.0)
    if before != command[0, 0]:
        here = here._replace(rate=float(np.copysign(limit, command[0, 0] - before)))
    made = [here]
    while True:
        if here.rate:
            k, t = _meeting(told, times, command, here, k)
        else:
            k, t = _parting(told, limit, times, command, k)
        if k == len(times):
            return made
        angle, rate, _ = told.at(np.array([t]))[:, 0].tolist()
        fast = not here.rate or abs(rate) > limit
        here = _Stretch(t, angle, float(np.copysign(limit, rate)) if fast else 0.0)
        made.append(here)


def _parting(told: Drive, limit: float, times: Array, command: Array, k: int) -> tuple[int, float]:
    """Where the command begins to turn too fast: the index after it, and the time."""
    fast = np.flatnonzero(np.abs(command[1, k:]) > limit)
    if not len(fast):
        return len(times), 0.0
    k += int(fast[0])
    if k == 0:
        return 0, float(times[0])
    return k, _crossing(lambda t: abs(told.at(np.array([t]))[1, 0]) - limit, times[k - 1], times[k])


def _meeting(
    told: Drive, times: Array, command: Array, here: _Stretch, k: int
) -> tuple[int, float]:
    """Where the command is met again."""
    behind = np.sign(here.rate) * (command[0, k:] - here.y - here.rate * (times[k:] - here.t))
    met = np.flatnonzero((behind[1:] <= 0) & (times[k + 1 :] > here.t))
    if not len(met):
        return len(times), 0.0
    k += int(met[0]) + 1

    def gap(t: float) -> float:
        return told.at(np.array([t]))[0, 0] - here.y - here.rate * (t - here.t)

    return k, _crossing(gap, max(times[k - 1], here.t), times[k])


def _crossing(gap: Callable[[float], float], low: float, high: float) -> float:
    """Where `gap` changes sign, by false position (the Illinois rule)."""
    at_low, at_high = gap(low), gap(high)
    for _ in range(8):
        if at_low * at_high >= 0:
            break
        middle = (low * at_high - high * at_low) / (at_high - at_low)
        there = gap(middle)
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
            natural=lambda setting: setting.rate,
            trials=(0.9, 0.6),
            vague=1e-4,
        ),
    ),
    sentence="The servo cannot turn faster than a limit, and falls behind its command.",
    actuate=_actuate,
    smooth=False,
)
