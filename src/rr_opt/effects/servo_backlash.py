"""Play between the servo and platform 2: the joint runs freely between two stops.

The servo turns the stops; the joint stands up to half the play ahead of them or behind. Between
them the servo's torque is zero and the mechanism itself moves the joint. At a stop it takes the
stop's rate at once (plastic impact) and stays while the stop pushes: under inertia it then runs
ahead at the ends of the swing, whose amplitude grows by half the play. The play begins in the
middle.

Stepped by Heun's method; where the joint hits a stop within a step, that time is found from the
parabola through the step. Between the steps its way is a cubic. A robot that has been driven for
ever repeats itself as soon as z does, which is extrapolated to; one that starts from rest is
stepped over many periods, the last of which repeats.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.compile_cache import OftenUsed
from rr_opt.mechanics.drive import Drive, FreeJoint

_STEPS = 240
"""A period."""
_PERIODS, _FROM_REST = 3, 30
"""Stepped in a row: by a robot that was driven for ever, and by one that starts from rest."""
_ROUNDS = 3
"""So often the periodic z is extrapolated to; it settles like a power of one period's decay."""
_FEW, _PAYS = 5, 50_000
"""Calls that take as long as to look for what was compiled before; steps, as long as to compile."""
_MISSED = 2.0
"""As the part of a step after which a stop is hit: it is not."""


@dataclass(frozen=True)
class _Play:
    """How far the joint is ahead of the servo, from step to step.

    ahead, rate  (n + 1,) rad and rad/s at the ends of the steps of dt s
    hit          (n,) part of a step after which a stop is hit
    """

    dt: float
    ahead: Array
    rate: Array
    hit: Array

    def at(self, k: NDArray[np.intp], part: Array) -> Array:
        """Ahead and its rate (2, n) after a part of step k."""
        a, b = self.ahead[k], self.ahead[k + 1]
        u, w = self.rate[k] * self.dt, self.rate[k + 1] * self.dt
        bend, twist = 3 * (b - a) - 2 * u - w, u + w - 2 * (b - a)
        way = a + part * (u + part * (bend + part * twist))
        rate = (u + part * (2 * bend + part * 3 * twist)) / self.dt
        hit = self.hit[k]
        flight = (b - a - u * hit) / hit**2
        into = a + part * (u + part * flight), (u + 2 * part * flight) / self.dt
        struck, there = hit < 1, part >= hit
        way = np.where(struck, np.where(there, b, into[0]), way)
        return np.array([way, np.where(struck, np.where(there, 0.0, into[1]), rate)])

    def turns(self, half: float) -> Array:
        """When the rate jumps or sets in, s from the first step: at a hit, and leaving a stop."""
        struck = np.flatnonzero(self.hit < 1)
        held = np.abs(self.ahead) >= (1 - 1e-9) * half
        left = np.flatnonzero(held[:-1] & ~held[1:])
        return self.dt * np.union1d(struck + self.hit[struck], left)


def _actuate(told: Drive, values: Mapping[str, float], joint: FreeJoint | None = None) -> Drive:
    width = values["width"]
    if width <= 0:
        return told
    dt = told.period / _STEPS
    play = _from_rest(told, width / 2, joint) if told.rest else _for_ever(told, width / 2, joint)
    last = play.hit.size - _STEPS

    def at(t: Array) -> Array:
        t = np.asarray(t, float)
        here = t / dt
        folded = last + (here - last) % _STEPS
        here = np.clip(np.where(here > last, folded, here), 0.0, None) if told.rest else folded
        k = np.minimum(here.astype(int), play.hit.size - 1)
        way, rate = play.at(k, here - k)
        if told.rest:
            rate = np.where(t < 0, 0.0, rate)
        return told.at(t) + np.array([way, rate, 0.0 * rate])

    turns = play.turns(width / 2)
    own = turns if told.rest else turns[turns > last * dt]
    return replace(told, at=at, jumps=np.union1d(own, told.jumps_within(0.0, (last + _STEPS) * dt)))


def _from_rest(told: Drive, half: float, joint: FreeJoint | None) -> _Play:
    before = np.append(told.at(np.array([-1.0]))[:2, 0], 0.0)
    return _stepped(told, half, joint, before, _FROM_REST)[0]


def _for_ever(told: Drive, half: float, joint: FreeJoint | None) -> _Play:
    """Of periods in a row z at the ends tells where it settles: Aitken's delta-squared."""
    before = np.append(told.at(np.zeros(1))[:2, 0], 0.0)
    for _ in range(_ROUNDS):
        play, ends = _stepped(told, half, joint, before, _PERIODS)
        first, second = np.diff(ends[2, -3:])
        settles = 0 < second / first < 1 if first else False
        before = ends[:, -1]
        before[2] += second**2 / (first - second) if settles else 0.0
    play, _ = _stepped(told, half, joint, before, _PERIODS)
    # What repeats is closed: the two ends of the last period agree to what it still settles.
    last = play.hit.size - _STEPS
    way = play.ahead.copy()
    way[last:] -= (way[-1] - way[last]) * np.arange(_STEPS + 1) / _STEPS
    return replace(play, ahead=way)


def _stepped(
    told: Drive, half: float, joint: FreeJoint | None, before: Array, periods: int
) -> tuple[_Play, Array]:
    """The play over some periods from phi, dphi and z before, and these at every period's end."""
    dt = told.period / _STEPS
    servo = told.at(dt * np.arange(periods * _STEPS + 1.0))[:2]
    swing, p = (joint.swing, joint.p) if joint else (_coasting(), ())
    n = periods * _STEPS
    given = np.vstack([servo[:, :-1], servo[:, 1:], np.full((2, n), [[half], [dt]])])
    rolled = _roller(swing, n)(np.append(before, _MISSED), given, p)
    ahead = np.column_stack([before[:2] - servo[:, 0], rolled[:2] - servo[:, 1:]])
    return _Play(dt, ahead[0], ahead[1], rolled[3]), rolled[:3, _STEPS - 1 :: _STEPS]


@lru_cache
def _coasting() -> ca.Function:
    """The joint of a robot of which nothing is known: it keeps its rate."""
    inputs = [*(ca.SX.sym(name) for name in ("phi", "dphi", "z")), ca.SX.sym("p", 0)]
    return ca.Function("coasting", inputs, [ca.SX(0), ca.SX(0)])


@lru_cache
def _roller(swing: ca.Function, steps: int) -> OftenUsed:
    """The joint (phi, dphi, z) from step to step, and the part of the step after which it hits a
    stop, from the servo's angle and rate at both ends, half the play, and the step."""
    joint, given = ca.SX.sym("joint", 4), ca.SX.sym("given", 6)
    p = ca.SX.sym("p", swing.numel_in(3))
    servo, servo_rate, stop, rate, half, h = ca.vertsplit(given)

    def slope(y: ca.SX) -> ca.SX:
        ddphi, zdot = swing(y[0], y[1], y[2], p)
        return ca.vertcat(y[1], ddphi, zdot)

    start = joint[:3]
    k1 = slope(start)
    k2 = slope(start + h * k1)
    phi, dphi, z = ca.vertsplit(start + h / 2 * (k1 + k2))
    held = ca.fabs(phi - stop) >= half
    side = half * ca.sign(phi - stop)
    # ahead = a + u s + f s^2 after a part s of the step; a stop is hit where it is at its side.
    a, u = joint[0] - servo, h * (joint[1] - servo_rate)
    f = phi - stop - a - u
    root = ca.sqrt(ca.fmax(u**2 - 4 * f * (a - side), 0.0))
    toward = u * ca.sign(side) + root
    part = 2 * ca.fabs(side - a) / ca.fmax(toward, 1e-300)
    was_held = ca.fabs(a) >= (1 - 1e-9) * half
    new = ca.logic_and(held, ca.logic_not(was_held))
    hit = ca.if_else(new, ca.fmin(part, 1.0), _MISSED)
    end = ca.vertcat(ca.if_else(held, stop + side, phi), ca.if_else(held, rate, dphi), z, hit)
    step = ca.Function("play_step", [joint, given, p], [ca.cse(end)])
    return OftenUsed(step.mapaccum(steps), _FEW, max(_PAYS // steps, _FEW + 1))


EFFECT = Effect(
    name="servo_backlash",
    family="actuation",
    port=Port.ACTUATION,
    parameters=(
        Parameter("width", "rad", (0.0, 0.5), 0.02, trials=(0.5,), rough=True, vague=0.01),
    ),
    sentence="There is play between the servo and the platform that it turns.",
    actuate=_actuate,
    loose=True,
    smooth=False,
)
