"""Play between the servo and platform 2: the joint runs freely between two stops.

The servo turns the stops; the joint stands up to half the play ahead of them or behind. Between
them the servo's torque is zero and the mechanism itself moves the joint. At a stop it takes the
stop's rate at once (plastic impact) and stays while the stop pushes: under inertia it then runs
ahead at the ends of the swing, whose amplitude grows by half the play. The play begins in the
middle.

Stepped by Heun's method over some periods, the last of which repeats. The robot's speed, which
settles slower than that, hardly counts for the joint.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

import casadi as ca
import numpy as np

from rr_opt.physics.drive import Array, Drive, FreeJoint
from rr_opt.physics.effects.effect import Effect, Parameter, Port

_STEPS = 400
"""A period."""
_PERIODS = 5


def _actuate(told: Drive, values: Mapping[str, float], joint: FreeJoint | None = None) -> Drive:
    width = values["width"]
    if width <= 0:
        return told
    dt = told.period / _STEPS
    times: Array = dt * np.arange(_PERIODS * _STEPS + 1.0)
    before = told.at(np.array([-1.0 if told.rest else 0.0]))[:2, 0]
    ahead = _ahead(told.at(times), before, width / 2, dt, joint)
    last = (_PERIODS - 1) * _STEPS
    # What repeats is closed: the two ends of the last period agree to what it still settles.
    ahead[last:] -= (ahead[-1] - ahead[last]) * np.arange(_STEPS + 1) / _STEPS
    rates = np.append(np.diff(ahead), 0.0) / dt
    rates[-1] = rates[last]

    def at(t: Array) -> Array:
        t = np.asarray(t, float)
        here = t / dt
        folded = last + (here - last) % _STEPS
        here = np.clip(np.where(here > last, folded, here), 0.0, None) if told.rest else folded
        k = here.astype(int)
        rate = np.where((t < 0) & told.rest, 0.0, rates[k])
        return told.at(t) + np.array([ahead[k] + rates[k] * dt * (here - k), rate, 0.0 * rate])

    return replace(told, at=at, smooth=False)


def _ahead(servo: Array, before: Array, half: float, dt: float, joint: FreeJoint | None) -> Array:
    """How far ahead of the servo (3, n) the joint is, rad (n,), from phi, dphi before."""
    swing, p = (joint.swing, joint.p) if joint else (_coasting(), ())
    start = np.append(before, 0.0)
    given = np.vstack([servo[:2, 1:], np.full((2, servo.shape[1] - 1), [[half], [dt]])])
    rolled = _roller(swing, servo.shape[1] - 1)(start, given, p)
    return np.append(before[0] - servo[0, 0], np.asarray(rolled)[0] - servo[0, 1:])


@lru_cache
def _coasting() -> ca.Function:
    """The joint of a robot of which nothing is known: it keeps its rate."""
    inputs = [*(ca.SX.sym(name) for name in ("phi", "dphi", "z")), ca.SX.sym("p", 0)]
    return ca.Function("coasting", inputs, [ca.SX(0), ca.SX(0)])


@lru_cache
def _roller(swing: ca.Function, steps: int) -> ca.Function:
    """The joint (phi, dphi, z) from step to step, between stops at rad, turning at rad/s."""
    joint, given = ca.SX.sym("joint", 3), ca.SX.sym("given", 4)
    p = ca.SX.sym("p", swing.numel_in(3))
    stop, rate, half, h = ca.vertsplit(given)

    def slope(y: ca.SX) -> ca.SX:
        ddphi, zdot = swing(y[0], y[1], y[2], p)
        return ca.vertcat(y[1], ddphi, zdot)

    k1 = slope(joint)
    k2 = slope(joint + h * k1)
    phi, dphi, z = ca.vertsplit(joint + h / 2 * (k1 + k2))
    held = ca.fabs(phi - stop) >= half
    end = ca.vertcat(
        ca.fmax(stop - half, ca.fmin(stop + half, phi)), ca.if_else(held, rate, dphi), z
    )
    return ca.Function("step", [joint, given, p], [ca.cse(end)]).mapaccum(steps)


EFFECT = Effect(
    name="servo_backlash",
    family="actuation",
    port=Port.ACTUATION,
    parameters=(Parameter("width", "rad", (0.0, 0.5), 0.02, trials=(0.5,), rough=True),),
    sentence="There is play between the servo and the platform that it turns.",
    actuate=_actuate,
    smooth=False,
)
