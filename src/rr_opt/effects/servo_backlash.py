"""Play between the servo and platform 2: the joint moves freely between two stops.

The servo moves the stops; the joint is up to half the play ahead of them or behind. Between them
the servo exerts no torque and the mechanism itself moves the joint. At a stop it takes the stop's
rate at once (plastic impact) and stays while the stop pushes: under inertia it then overshoots at
the ends of the swing, whose amplitude grows by half the play. Dry friction in the joint holds it
back instead: with enough of it the joint stays where a stop leaves it until the other stop comes,
the play operator of control engineering, and its swing shrinks. It starts in the middle of the
play. A gear that gives is twisted by what the servo has to exert, so that the joint is past a stop
by as much as the stop pushes; its own oscillation is faster than the gait and left out.

Integrated by Heun's method; an impact within a step is located by the parabola through the step.
Between steps the joint's lead is a cubic. Periodic motion repeats as soon as z does, which is
extrapolated to; from rest it is integrated over many periods, the last of which repeats.
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
"""Per period."""
_PERIODS, _FROM_REST = 2, 30
"""Periods integrated for periodic motion, and from rest."""
_EXTRAPOLATIONS, _CLOSED = 3, 1e-6
"""Extrapolations to the periodic z at most, whose error falls like a power of the decay over a
period; and the change of z over a period, m/s, that is none."""
_LOOK, _PAYS = 5, 50_000
"""Calls after which the compile cache is looked into; steps after which compiling pays."""
_INERTIA = 1e-3
"""Of the joint of a robot of which nothing is known, kg m2."""
_RIGID = 1e-9
"""Compliance of a gear that does not give, rad/(N m)."""
_MISSED = 2.0
"""As the fraction of a step at which a stop is hit: it is not."""


_Gear = tuple[float, float, float]
"""Half the play, rad; dry friction in the joint, N m; compliance, rad/(N m)."""


@dataclass(frozen=True)
class _Play:
    """The joint's lead over the servo, step by step.

    dt         s
    lead, rate (n + 1,) rad and rad/s at the ends of the steps
    hit        (n,) fraction of each step at which a stop is hit
    """

    dt: float
    lead: Array
    rate: Array
    hit: Array

    def at(self, k: NDArray[np.intp], fraction: Array) -> Array:
        """Lead and its rate (2, n) after a fraction of step k."""
        a, b = self.lead[k], self.lead[k + 1]
        u, w = self.rate[k] * self.dt, self.rate[k + 1] * self.dt
        bend, twist = 3 * (b - a) - 2 * u - w, u + w - 2 * (b - a)
        lead = a + fraction * (u + fraction * (bend + fraction * twist))
        rate = (u + fraction * (2 * bend + fraction * 3 * twist)) / self.dt
        hit = self.hit[k]
        flight = (b - a - u * hit) / hit**2
        flying = a + fraction * (u + fraction * flight), (u + 2 * fraction * flight) / self.dt
        struck, landed = hit < 1, fraction >= hit
        lead = np.where(struck, np.where(landed, b, flying[0]), lead)
        return np.array([lead, np.where(struck, np.where(landed, 0.0, flying[1]), rate)])

    def jumps(self, half: float) -> Array:
        """Times, s, at which the rate jumps or begins: at an impact, and on leaving a stop."""
        struck = np.flatnonzero(self.hit < 1)
        stopped = np.abs(self.lead) >= (1 - 1e-9) * half
        left = np.flatnonzero(stopped[:-1] & ~stopped[1:])
        return self.dt * np.union1d(struck + self.hit[struck], left)


def _actuate(command: Drive, values: Mapping[str, float], joint: FreeJoint | None = None) -> Drive:
    half, friction = values["width"] / 2, values.get("joint_friction", 0.0)
    gear = half, friction, values.get("compliance", 0.0)
    if half <= 0:
        return command
    dt = command.period / _STEPS
    if command.rest:
        before = np.append(command.at(np.array([-1.0]))[:2, 0], 0.0)
        play, _ = _integrated(command, gear, joint, before, _FROM_REST)
    else:
        play = _periodic(command, gear, joint)
    last = play.hit.size - _STEPS

    def at(t: Array) -> Array:
        t = np.asarray(t, float)
        here = t / dt
        folded = last + (here - last) % _STEPS
        here = np.clip(np.where(here > last, folded, here), 0.0, None) if command.rest else folded
        k = np.minimum(here.astype(int), play.hit.size - 1)
        lead, rate = play.at(k, here - k)
        if command.rest:
            rate = np.where(t < 0, 0.0, rate)
        return command.at(t) + np.array([lead, rate, 0.0 * rate])

    jumps = play.jumps(half)
    own = jumps if command.rest else jumps[jumps > last * dt]
    others = command.jumps_within(0.0, (last + _STEPS) * dt)
    return replace(command, at=at, jumps=np.union1d(own, others))


def _periodic(command: Drive, gear: _Gear, joint: FreeJoint | None) -> _Play:
    """Periodic motion: z at the ends of periods is extrapolated by Aitken's delta-squared."""
    before = np.append(command.at(np.zeros(1))[:2, 0], 0.0)
    play, ends = _integrated(command, gear, joint, before, _PERIODS)
    for _ in range(_EXTRAPOLATIONS):
        first, second = np.diff([before[2], *ends[2]])
        if abs(second) <= _CLOSED:
            break
        before = ends[:, -1]
        converges = 0 < second / first < 1 if first else False
        before[2] += second**2 / (first - second) if converges else 0.0
        play, ends = _integrated(command, gear, joint, before, _PERIODS)
    # The last period is closed: what is left to converge is spread over it.
    last = play.hit.size - _STEPS
    lead = play.lead.copy()
    lead[last:] -= (lead[-1] - lead[last]) * np.arange(_STEPS + 1) / _STEPS
    return replace(play, lead=lead)


def _integrated(
    command: Drive, gear: _Gear, joint: FreeJoint | None, before: Array, periods: int
) -> tuple[_Play, Array]:
    """The play over some periods from phi, dphi and z before, and these at the end of each."""
    dt = command.period / _STEPS
    servo = command.at(dt * np.arange(periods * _STEPS + 1.0))[:2]
    swing, p = (joint.swing, joint.p) if joint else (_coasting(), ())
    n = periods * _STEPS
    given = np.vstack([servo[:, :-1], servo[:, 1:], np.full((4, n), [[dt], *([x] for x in gear)])])
    path = _stepper(swing, n)(np.append(before, _MISSED), given, p)
    lead = np.column_stack([before[:2] - servo[:, 0], path[:2] - servo[:, 1:]])
    return _Play(dt, lead[0], lead[1], path[3]), path[:3, _STEPS - 1 :: _STEPS]


@lru_cache
def _coasting() -> ca.Function:
    """The joint of a robot of which nothing is known: it keeps its rate."""
    inputs = [*(ca.SX.sym(name) for name in ("phi", "dphi", "z")), ca.SX.sym("p", 0)]
    return ca.Function("coasting", inputs, [ca.SX(0), ca.SX(0), ca.SX(1 / _INERTIA)])


@lru_cache
def _stepper(swing: ca.Function, steps: int) -> OftenUsed:
    """The joint (phi, dphi, z) from step to step, and the fraction of the step at which it hits a
    stop; given the servo's angle and rate at both ends, the step, and the gear."""
    joint, given = ca.SX.sym("joint", 4), ca.SX.sym("given", 8)
    p = ca.SX.sym("p", swing.numel_in(3))
    servo, servo_rate, stop, rate, h, half, friction, compliance = ca.vertsplit(given)

    def slope(y: ca.SX) -> ca.SX:
        ddphi, zdot, _ = swing(y[0], y[1], y[2], p)
        return ca.vertcat(y[1], ddphi, zdot)

    start = joint[:3]
    k1 = slope(start)
    k2 = slope(start + h * k1)
    phi, dphi, z = ca.vertsplit(start + h / 2 * (k1 + k2))
    # Friction takes from the rate what it can in the step, and holds what is at rest.
    mobility = swing(joint[0], joint[1], joint[2], p)[2]
    slowed = ca.sign(dphi) * ca.fmax(ca.fabs(dphi) - h * friction * mobility, 0.0)
    phi, dphi = phi + h / 2 * (slowed - dphi), slowed
    side = half * ca.sign(phi - stop)
    # lead = a + u s + f s^2 after a fraction s of the step; a stop is hit where it equals `side`.
    a, u = joint[0] - servo, h * (joint[1] - servo_rate)
    f = phi - stop - a - u
    root = ca.sqrt(ca.fmax(u**2 - 4 * f * (a - side), 0.0))
    toward = u * ca.sign(side) + root
    fraction = 2 * ca.fabs(side - a) / ca.fmax(toward, 1e-300)
    was_stopped = ca.fabs(a) >= (1 - 1e-9) * half
    impact = ca.logic_and(ca.fabs(phi - stop) >= half, ca.logic_not(was_stopped))
    hit = ca.if_else(impact, ca.fmin(fraction, 1.0), _MISSED)
    # What the stop has to exert against where the joint is twists the gear by as much as it gives.
    # Until then the joint swings on it, critically damped, for what is left of the step.
    outward = ca.sign(side)
    free, _, _ = swing(stop + side, rate, z, p)
    push = outward * ((free - (rate - servo_rate) / h) / mobility - friction * ca.sign(rate))
    twist = compliance * push
    left = ca.if_else(impact, h * (1 - hit), h)
    past = ca.if_else(impact, 0.0, ca.fmax(ca.fabs(a) - half, 0.0))
    speed = ca.if_else(impact, outward * (u + 2 * f * hit), ca.fabs(u) * ca.sign(u * outward)) / h
    omega = ca.sqrt(mobility / (compliance + _RIGID))
    decay, bend = ca.exp(-omega * left), speed + omega * (past - twist)
    past = twist + (past - twist + bend * left) * decay
    speed = (speed - omega * bend * left) * decay
    held = ca.logic_and(was_stopped, ca.logic_or(push > 0, past > 0))
    stopped = ca.logic_or(impact, held)
    past = ca.fmax(past, 0.0)
    at_stop = ca.vertcat(stop + side + outward * past, rate + outward * speed)
    end = ca.vertcat(ca.if_else(stopped, at_stop, ca.vertcat(phi, dphi)), z, hit)
    step = ca.Function("play_step", [joint, given, p], [ca.cse(end)])
    return OftenUsed(step.mapaccum(steps), _LOOK, max(_PAYS // steps, _LOOK + 1))


EFFECT = Effect(
    name="servo_backlash",
    family="actuation",
    port=Port.ACTUATION,
    parameters=(
        Parameter(
            *("width", "rad", (0.0, 0.5), 0.02), initial_guesses=(0.5,), model_form_sigma=0.01
        ),
        Parameter("joint_friction", "N m", (0.0, 5.0), 0.05, initial_guesses=(0.3, 2.0)),
        Parameter("compliance", "rad/(N m)", (0.0, 2.0), 0.05, initial_guesses=(0.3,)),
    ),
    sentence="There is play between the servo and the platform that it turns.",
    actuate=_actuate,
    backdrivable=True,
    differentiable=False,
    form_error=0.05,
    forms=(("width",), ("width", "joint_friction"), ("width", "joint_friction", "compliance")),
)
