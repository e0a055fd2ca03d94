"""A servo that cannot turn faster than a limit: it falls behind its command and catches up.

Followed in steps of 1/2000 of the period until it repeats, and from then on periodic.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rr_opt.physics.drive import Array, Drive
from rr_opt.physics.effects.effect import Effect, Parameter, Port

_STEPS = 1000
_PERIODS = 5
"""After so many it repeats, as catching up takes less than one."""


def _actuate(told: Drive, values: Mapping[str, float]) -> Drive:
    dt = told.period / _STEPS
    times = dt * np.arange(_PERIODS * _STEPS + 1)
    command = told.at(times)
    most = values["rate_limit"] * dt
    if np.abs(command[1]).max() <= values["rate_limit"] and not told.rest:
        return told
    phi = np.empty_like(times)
    here = told.at(np.array([-1.0]))[0, 0] if told.rest else command[0, 0]
    for k, goal in enumerate(command[0].tolist()):
        here += min(max(goal - here, -most), most)
        phi[k] = here
    last = (_PERIODS - 1) * _STEPS

    def at(t: Array) -> Array:
        t = np.asarray(t, float)
        folded = np.where(t > times[last], times[last] + (t - times[last]) % told.period, t)
        if not told.rest:
            folded = times[last] + t % told.period
        inside = np.interp(folded, times, phi)
        rate = (np.interp(folded + dt, times, phi) - np.interp(folded - dt, times, phi)) / (2 * dt)
        if told.rest:
            inside = np.where(t < 0, told.at(np.array([-1.0]))[0, 0], inside)
            rate = np.where(t < 0, 0.0, rate)
        return np.array([inside, rate, np.zeros_like(rate)])

    return replace(told, at=at, smooth=False)


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
        ),
    ),
    sentence="The servo cannot turn faster than a limit, and falls behind its command.",
    actuate=_actuate,
    smooth=False,
)
