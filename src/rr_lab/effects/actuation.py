"""What the servo makes of its command."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rr_lab.effects.hidden_effect import HiddenEffect, Parameter, Setting, Values, adds
from rr_lab.rig import Motor, Rig, swing_inertia
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


def _second_order(rig: Rig, values: Values) -> None:
    """The damping ratio zeta stays as the lag tau = 2 zeta/omega grows."""
    tau = values["tau"]
    _lag(rig, {"tau": tau, "beta": (tau / (2 * values["zeta"])) ** 2})


def _p_loop(rig: Rig, values: Values) -> None:
    """A motor as soft as its lag says, which the load's torque deflects too."""
    tau, zeta = values["tau"], values["zeta"]
    stiffness = swing_inertia(rig.robot) * (2 * zeta / tau) ** 2
    rig.motor = Motor(stiffness, stiffness * tau, feedforward=0.0)


def _damped(setting: Setting, values: Values) -> Values:
    """A servo that hardly overshoots: damping ratio 0.5 to 1.2."""
    return {**values, "zeta": float(setting.rng.uniform(0.5, 1.2))}


def _delay(rig: Rig, values: Values) -> None:
    late = values["delay"]
    rig.shapers.append(lambda t, angle: np.interp(t - late, t, angle))


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


def _below_the_fastest(setting: Setting, _: Values) -> Values:
    """Just below the fastest rate of the commands."""
    fastest = max(gait.peak_rate for gait in setting.gaits)
    return {"rate_limit": float(fastest * setting.rng.uniform(0.8, 0.95))}


def _backlash(rig: Rig, values: Values) -> None:
    rig.play += values["width"]
    rig.hinge_dry += values.get("joint_friction", 0.0)
    if "gear_stiffness" in values:
        rig.gear = values["gear_stiffness"]


def _frictional(setting: Setting, values: Values) -> Values:
    """Friction from about the torque of the load's own inertia, where it begins to hold the load in
    the play, to well above."""
    largest = max(gait.amplitude * gait.angular_frequency**2 for gait in setting.gaits)
    inertial = swing_inertia(setting.robot) * largest
    friction = inertial * math.exp(setting.rng.uniform(math.log(0.5), math.log(4.0)))
    return {**values, "joint_friction": float(friction)}


def _compliant(setting: Setting, values: Values) -> Values:
    """A gear that the joint's friction twists by 2 to 15 mrad."""
    drawn = _frictional(setting, values)
    twist = math.exp(setting.rng.uniform(math.log(2e-3), math.log(15e-3)))
    return {**drawn, "gear_stiffness": float(drawn["joint_friction"] / twist)}


_TAU = Parameter("tau", "s", 0.02, most=0.3)
_ZETA = Parameter("zeta", "1", 0.8, neutral=None, plant=True)
_DELAY = Parameter("delay", "s", 0.02, most=0.3, plant=True)
_BETA = Parameter("beta", "s^2", 2e-4, neutral=None)
_RATE = Parameter("rate_limit", "rad/s", 2.5, neutral=math.inf, most=0.1)
_WIDTH = Parameter("width", "rad", 0.03, most=0.2)
_FRICTION = Parameter("joint_friction", "N m", 0.1, neutral=None, plant=True)
_GEAR = Parameter("gear_stiffness", "N m/rad", 20.0, neutral=None, plant=True)
_OFFSET = Parameter("offset", "rad", 0.02, most=0.2, signed=True)

ACTUATION = (
    HiddenEffect("servo_lag",
                 "the servo follows its command late and smaller, by a first-order lag",
                 (_TAU,), _lag, "first_order", also=(_BETA,)),
    HiddenEffect("servo_lag", "the servo follows its command late, by a second-order lag",
                 (_TAU, _ZETA), _second_order, "second_order", draw=_damped),
    HiddenEffect("servo_lag",
                 "the servo's position loop is soft: late, and deflected by the load",
                 (_TAU, _ZETA), _p_loop, "p_loop", draw=_damped),
    HiddenEffect("servo_lag", "the servo follows its command late, by a pure delay",
                 (_DELAY,), _delay, "delay", same_as=("clock_offset",)),
    HiddenEffect("servo_rate_limit", "the servo turns no faster than a limit",
                 (_RATE,), _rate_limit, draw=_below_the_fastest),
    HiddenEffect("servo_backlash",
                 "play between the servo and platform 2, with stops at its ends; the joint turns "
                 "freely",
                 (_WIDTH,), _backlash, "inertial", also=(_FRICTION, _GEAR)),
    HiddenEffect("servo_backlash",
                 "play between the servo and platform 2, and dry friction in the joint, which "
                 "holds the load until a flank of the gear pushes it on",
                 (_WIDTH, _FRICTION), _backlash, "frictional", draw=_frictional),
    HiddenEffect("servo_backlash",
                 "play between the servo and platform 2, dry friction in the joint, and a gear "
                 "that twists under it",
                 (_WIDTH, _FRICTION, _GEAR), _backlash, "frictional_compliant", draw=_compliant),
    HiddenEffect("servo_offset", "the servo's zero is off", (_OFFSET,), adds("offset", "offset")),
)  # fmt: skip
