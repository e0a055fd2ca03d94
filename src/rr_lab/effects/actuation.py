"""What the servo makes of its command."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rr_lab.effects.hidden import HiddenEffect, Parameter, Values
from rr_lab.rig import Rig
from rr_opt.array import Array


def _lag(rig: Rig, values: Values) -> None:
    """A follower of first order, tau dy/dt = u - y, or with beta of second.

    Exact for a command that is straight in a step.
    """
    tau, beta = values["tau"], values.get("beta", 0.0)

    def follow(t: Array, angle: Array) -> Array:
        from scipy.signal import cont2discrete, lfilter  # takes a second

        system = [1.0], [beta, tau, 1.0] if beta else [tau, 1.0]
        discrete: Any = cont2discrete(system, t[1] - t[0], method="foh")
        above, below = discrete[:2]
        return np.asarray(lfilter(above[0], below, angle - angle[0])) + angle[0]

    rig.shapers.append(follow)


def _rate_limit(rig: Rig, values: Values) -> None:
    limit = values["rate_limit"]

    def follow(t: Array, angle: Array) -> Array:
        most = limit * (t[1] - t[0])
        made, out = float(angle[0]), np.empty_like(angle)
        for k, asked in enumerate(angle.tolist()):
            made += min(max(asked - made, -most), most)
            out[k] = made
        return out

    rig.shapers.append(follow)


def _backlash(rig: Rig, values: Values) -> None:
    rig.play += values["width"]


def _offset(rig: Rig, values: Values) -> None:
    rig.offset += values["offset"]


ACTUATION = (
    HiddenEffect(
        "servo_lag",
        "the servo follows its command late and smaller, by a first-order lag",
        (Parameter("tau", "s", 0.02, most=0.3),),
        _lag,
        further=frozenset({"beta"}),
    ),
    HiddenEffect(
        "servo_rate_limit",
        "the servo turns no faster than a limit",
        (Parameter("rate_limit", "rad/s", 2.5, neutral=math.inf, most=0.1),),
        _rate_limit,
    ),
    HiddenEffect(
        "servo_backlash",
        "play between the servo and platform 2, with stops at its ends",
        (Parameter("width", "rad", 0.03, most=0.2),),
        _backlash,
    ),
    HiddenEffect(
        "servo_offset",
        "the servo's zero is off",
        (Parameter("offset", "rad", 0.02, most=0.2, signed=True),),
        _offset,
    ),
)
