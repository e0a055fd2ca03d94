"""What the servo makes of its command."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rr_lab.effects.hidden_effect import Setting, Values
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


FUNCTIONS = (
    _lag,
    _second_order,
    _p_loop,
    _damped,
    _delay,
    _rate_limit,
    _below_the_fastest,
    _backlash,
    _frictional,
    _compliant,
)
