"""Play between the servo and platform 2: the joint moves freely between two stops.

The servo moves the stops; the joint is up to half the play ahead of them or behind. Between them
the servo exerts no torque and the mechanism itself moves the joint. At a stop it takes the stop's
rate at once (plastic impact) and stays while the stop pushes: under inertia it then overshoots at
the ends of the swing, whose amplitude grows by half the play. Dry friction in the joint holds it
back instead: with enough of it the joint stays where a stop leaves it until the other stop comes,
the play operator of control engineering, and its swing shrinks. It starts in the middle of the
play. A gear that gives is twisted by what the servo has to exert, so that the joint is past a stop
by as much as the stop pushes; its own oscillation is faster than the gait and left out.

Integrated by Heun's method while free, by the midpoint rule at a stop; a step ends where the
servo's rate jumps. An impact within a step is located by the parabola through the step. Between
steps the joint's lead is a cubic, but in a step with an impact a parabola before and one after it.
Periodic motion repeats as soon as z does, which is extrapolated to; from rest it is integrated over
many periods, the last of which repeats.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.drive import Drive, FreeJoint
from rr_opt.mechanics.recurrence import Course, Recurrence

_STEPS = 240
"""Per period."""
_PERIODS, _FROM_REST = 2, 30
"""Periods integrated for periodic motion, and from rest."""
_EXTRAPOLATIONS, _CLOSED = 3, 1e-6
"""Most extrapolations to the periodic z, whose error falls like a power of the decay over a
period; and the change of z over a period, m/s, that counts as none."""
_INERTIA = 1e-3
"""Inertia of the joint of an unknown robot, kg m2."""
_RIGID = 1e-9
"""Compliance of a rigid gear, rad/(N m): small, but not 0, so that the joint leaves a stop that
would pull, whatever the rounding."""
_BESIDE = 1e-9
"""Before and after a jump of the servo's rate, s."""
_MISSED = 2.0
"""Fraction of a step at which a stop is hit, where none is."""


_Gear = tuple[float, float, float]
"""Half the play, rad; dry friction in the joint, N m; compliance, rad/(N m)."""


@dataclass(frozen=True)
class _Play:
    """The joint's lead over the servo, step by step.

    half   half the play, rad
    times  (n + 1,) s, the ends of the steps
    lead   (n + 1,) rad at the ends of the steps
    rates  (2, n) rad/s at the beginning and the end of each step
    hit    (n,) fraction of each step at which a stop is hit
    """

    half: float
    times: Array
    lead: Array
    rates: Array
    hit: Array

    @cached_property
    def _lengths(self) -> Array:
        return np.diff(self.times)

    @cached_property
    def _cubics(self) -> Array:
        """Coefficients (4, n) of the lead over each step, until it hits a stop."""
        a, b = self.lead[:-1], self.lead[1:]
        u, w = self.rates * self._lengths
        bend, twist = 3 * (b - a) - 2 * u - w, u + w - 2 * (b - a)
        struck = self.hit < 1
        # Past the stop, where a gear that gives may be at the end of the step, it is twisted.
        flight = (np.copysign(self.half, b) - a - u * self.hit) / self.hit**2
        return np.array([a, u, np.where(struck, flight, bend), np.where(struck, 0.0, twist)])

    def at(self, t: Array) -> Array:
        """Lead and its rate (2, n)."""
        k = np.clip(np.searchsorted(self.times, t, side="right") - 1, 0, self.hit.size - 1)
        length = self._lengths[k]
        fraction = (t - self.times[k]) / length
        a, u, bend, twist = self._cubics.take(k, axis=1)
        lead = a + fraction * (u + fraction * (bend + fraction * twist))
        rate = (u + fraction * (2 * bend + fraction * 3 * twist)) / length
        landed = np.flatnonzero(fraction >= self.hit[k])
        k, to_go = k[landed], 1 - fraction[landed]
        # From the stop to the end of the step, where lead and rate are given.
        end, w, rest = self.lead[k + 1], self.rates[1, k] * self._lengths[k], 1 - self.hit[k]
        bend = (np.copysign(self.half, end) - end + w * rest) / np.maximum(rest, 1e-9) ** 2
        lead[landed] = end + to_go * (to_go * bend - w)
        rate[landed] = (w - 2 * to_go * bend) / self._lengths[k]
        return np.array([lead, rate])

    @property
    def jumps(self) -> Array:
        """Times, s, at which the rate jumps or begins: at an impact, and on leaving a stop."""
        struck = np.flatnonzero(self.hit < 1)
        stopped = np.abs(self.lead) >= (1 - 1e-9) * self.half
        left = np.flatnonzero(stopped[:-1] & ~stopped[1:])
        hits = self.times[struck] + self.hit[struck] * self._lengths[struck]
        return np.union1d(hits, self.times[left])


def _actuate(command: Drive, values: Mapping[str, float], joint: FreeJoint | None = None) -> Drive:
    return _actuate_all([command], [values], [joint])[0]


def _actuate_all(
    commands: Sequence[Drive],
    values: Sequence[Mapping[str, float]],
    joints: Sequence[FreeJoint | None],
) -> list[Drive]:
    """Several at once, which are integrated side by side."""
    gears = [
        (one["width"] / 2, one.get("joint_friction", 0.0), one.get("compliance", 0.0))
        for one in values
    ]
    loose = [k for k, (half, _, _) in enumerate(gears) if half > 0]
    out = list(commands)
    for rest in (True, False):
        some = [k for k in loose if commands[k].rest == rest]
        runs = [_Servo.of(commands[k], gears[k], joints[k]) for k in some]
        plays = _from_rest(runs) if rest else _periodic(runs)
        for k, play in zip(some, plays, strict=True):
            out[k] = _driven(commands[k], play)
    return out


def _driven(command: Drive, play: _Play) -> Drive:
    T, last = command.period, play.times[-1 - _STEPS]
    # The last period is closed: its remaining gap is spread over it.
    drift = 0.0 if command.rest else (play.lead[-1] - play.lead[-1 - _STEPS]) / T

    def at(t: Array) -> Array:
        t = np.asarray(t, float)
        # The last period repeats: `floor`, as `%` takes ten times as long.
        periods = np.floor((t - last) / T)
        if command.rest:
            periods = np.maximum(periods, 0.0)
        here = np.maximum(t, 0.0) - T * periods if command.rest else t - T * periods
        lead, rate = play.at(here)
        lead, rate = lead - drift * (here - last), rate - drift
        if command.rest:
            rate = np.where(t < 0, 0.0, rate)
        return command.at(t) + np.array([lead, rate, 0.0 * rate])

    jumps = play.jumps
    own = jumps if command.rest else jumps[jumps >= last]
    others = command.jumps_within(0.0, play.times[-1])
    return replace(command, at=at, jumps=np.union1d(own, others))


@dataclass(frozen=True)
class _Servo:
    """Its angle (n + 1,) at the ends of the steps of the periods, its rates (2, n) at the beginning
    and the end of each, their times (n + 1,), s, its gear and the joint; and what that begins from:
    phi, dphi and z."""

    angle: Array
    rates: Array
    times: Array
    gear: _Gear
    joint: FreeJoint | None
    first: Array

    @classmethod
    def of(cls, command: Drive, gear: _Gear, joint: FreeJoint | None) -> _Servo:
        """That follows a command."""
        times, k = _ends_of_steps(command)
        angle, rate = command.at(times)[:2]
        rates = np.array([rate[:-1], rate[1:]])
        begins, ends = k[k < rate.size - 1], k[k > 0]
        rates[0, begins] = command.at(times[begins] + _BESIDE)[1]
        rates[1, ends - 1] = command.at(times[ends] - _BESIDE)[1]
        first = np.array([angle[0], rates[0, 0]])
        if command.rest:
            first = command.at(np.array([-1.0]))[:2, 0]
        return cls(angle, rates, times, gear, joint, np.append(first, 0.0))

    @cached_property
    def inputs(self) -> Array:
        """Of each step (steps, 8)."""
        begin, end = self.rates
        path = [self.angle[:-1], begin, self.angle[1:], end, np.diff(self.times)]
        return np.column_stack([*path, np.broadcast_to(self.gear, (end.size, 3))])

    def play(self, before: Array, states: Array) -> _Play:
        """From phi, dphi and z before, and the states after each step."""
        phi, dphi = np.vstack([before[:2], states[:, :2]]).T
        lead, rates = phi - self.angle, np.array([dphi[:-1], dphi[1:]]) - self.rates
        half, _, compliance = self.gear
        if not compliance:
            # A rigid stop gives the joint its rate at once.
            at = np.sign(lead) * (np.abs(lead) >= (1 - 1e-9) * half)
            rates[0, (at[:-1] != 0) & (at[:-1] == at[1:])] = 0.0
        return _Play(half, self.times, lead, rates, states[:, 3])


def _ends_of_steps(command: Drive) -> tuple[Array, NDArray[np.intp]]:
    """Times, s, at the ends of the steps of the periods that are integrated, and which of them are
    jumps of the command's rate: each takes the nearest time that those before it leave."""
    dt, steps = command.period / _STEPS, (_FROM_REST if command.rest else _PERIODS) * _STEPS
    times = dt * np.arange(steps + 1.0)
    jumps = command.jumps_within(0.0 if command.rest else -dt / 2, times[-1] - dt / 2)
    order = np.arange(jumps.size)
    k = np.maximum(np.rint(jumps / dt).astype(int), 1 if command.rest else 0)
    k = order + np.maximum.accumulate(k - order)
    within = k < steps
    times[k[within]], k = jumps[within], k[within]
    # The last period ends as it begins.
    times[-1] = times[-1 - _STEPS] + command.period
    return times, np.append(k, steps) if steps - _STEPS in k else k


def _from_rest(servos: Sequence[_Servo]) -> list[_Play]:
    before = [one.first for one in servos]
    return [
        servo.play(start, states)
        for servo, start, states in zip(servos, before, _integrated(servos, before), strict=True)
    ]


def _periodic(servos: Sequence[_Servo]) -> list[_Play]:
    """Periodic motion: z at the ends of periods is extrapolated by Aitken's delta-squared."""
    before = [one.first for one in servos]
    states = _integrated(servos, before)
    for _ in range(_EXTRAPOLATIONS):
        begun, open_by = {}, {}
        for k, path in enumerate(states):
            ends = path[_STEPS - 1 :: _STEPS, 2]
            first, second = np.diff([before[k][2], *ends])
            if abs(second) <= _CLOSED:
                continue
            begun[k], open_by[k] = path[-1, :3].copy(), abs(second)
            converges = 0 < second / first < 1 if first else False
            begun[k][2] += second**2 / (first - second) if converges else 0.0
        if not begun:
            break
        again = _integrated([servos[k] for k in begun], [*begun.values()])
        for k, path in zip(begun, again, strict=True):
            # With little friction the extrapolated speed may be far off.
            if abs(path[-1, 2] - path[_STEPS - 1, 2]) <= open_by[k]:
                before[k], states[k] = begun[k], path
    return [
        servo.play(start, path) for servo, start, path in zip(servos, before, states, strict=True)
    ]


def _integrated(servos: Sequence[_Servo], before: Sequence[Array]) -> list[Array]:
    """phi, dphi, z and the fraction at which a stop is hit (steps, 4) after each step, from phi,
    dphi and z before."""
    if not servos:
        return []
    swing = servos[0].joint.swing if servos[0].joint else _coasting()
    return _stepper(swing)(
        [
            Course(
                np.append(start, _MISSED),
                servo.inputs,
                np.array(servo.joint.p if servo.joint else (), float),
            )
            for servo, start in zip(servos, before, strict=True)
        ]
    )


@lru_cache
def _coasting() -> ca.Function:
    """The joint of an unknown robot: it keeps its rate."""
    inputs = [*(ca.SX.sym(name) for name in ("phi", "dphi", "z")), ca.SX.sym("p", 0)]
    return ca.Function("coasting", inputs, [ca.SX(0), ca.SX(0), ca.SX(1 / _INERTIA)])


@lru_cache
def _stepper(swing: ca.Function) -> Recurrence:
    """The joint (phi, dphi, z) from step to step, and the fraction of the step at which it hits a
    stop; given the servo's angle and rate at both ends, the step, and the gear."""
    joint, given = ca.SX.sym("joint", 4), ca.SX.sym("given", 8)
    p = ca.SX.sym("p", swing.numel_in(3))
    servo, servo_rate, stop, rate, h, half, friction, compliance = ca.vertsplit(given)
    before, rate_before, z_before, _ = ca.vertsplit(joint)

    def slowed(speed: ca.SX, mobility: ca.SX) -> ca.SX:
        """Friction takes from the rate what it can in the step, and holds what is at rest."""
        return ca.sign(speed) * ca.fmax(ca.fabs(speed) - h * friction * mobility, 0.0)

    ddphi1, zdot1, mobility1 = swing(before, rate_before, z_before, p)
    ahead = slowed(rate_before + h * ddphi1, mobility1)
    phi, z = before + h * rate_before, z_before + h * zdot1
    ddphi2, zdot2, mobility2 = swing(phi, ahead, z, p)
    dphi = slowed(rate_before + h / 2 * (ddphi1 + ddphi2), (mobility1 + mobility2) / 2)
    phi = before + h / 2 * (rate_before + dphi)
    side = half * ca.sign(phi - stop)
    outward = ca.sign(side)
    # lead = a + u s + f s^2 after a fraction s of the step; a stop is hit where it equals `side`.
    a, u = before - servo, h * (rate_before - servo_rate)
    f = phi - stop - a - u
    root = ca.sqrt(ca.fmax(u**2 - 4 * f * (a - side), 0.0))
    toward = u * outward + root
    fraction = 2 * ca.fabs(side - a) / ca.fmax(toward, 1e-300)
    # At this stop: in a fast step the joint may cross from the other one.
    was_stopped = a * outward >= (1 - 1e-9) * half
    impact = ca.logic_and(ca.fabs(phi - stop) >= half, ca.logic_not(was_stopped))
    hit = ca.if_else(impact, ca.fmin(fraction, 1.0), _MISSED)
    # The push of the stop, in the middle of the step, twists the gear by its compliance. The joint
    # approaches this twist, critically damped, in the rest of the step.
    middle, middle_rate = (servo + stop) / 2 + side, (servo_rate + rate) / 2
    free, zdot, mobility = swing(middle, middle_rate, z_before + h / 2 * zdot1, p)
    push = (free - (rate - servo_rate) / h) / mobility - friction * ca.sign(middle_rate)
    push = outward * push
    give = compliance + _RIGID
    twist = give * push
    left = ca.if_else(impact, h * (1 - hit), h)
    past = ca.if_else(impact, 0.0, ca.fmax(ca.fabs(a) - half, 0.0))
    speed = ca.if_else(impact, outward * (u + 2 * f * hit), outward * u) / h
    omega = ca.sqrt(mobility / give)
    decay, bend = ca.exp(-omega * left), speed + omega * (past - twist)
    past = twist + (past - twist + bend * left) * decay
    speed = (speed - omega * bend * left) * decay
    held = ca.logic_and(was_stopped, ca.logic_or(push > 0, past > 0))
    stopped = ca.logic_or(impact, held)
    past = ca.fmax(past, 0.0)
    at_stop = ca.vertcat(stop + side + outward * past, rate + outward * speed)
    # z as the joint moves: free until an impact, and with the stop from then on.
    flown = ca.if_else(impact, hit, ca.if_else(held, 0.0, 1.0))
    z = z_before + h * (flown * (zdot1 + flown * (zdot2 - zdot1) / 2) + (1 - flown) * zdot)
    end = ca.vertcat(ca.if_else(stopped, at_stop, ca.vertcat(phi, dphi)), z, hit)
    step = ca.Function("play_step", [joint, given, p], [ca.cse(end)])
    return Recurrence(step)


EFFECT = Effect(
    name="servo_backlash",
    family="actuation",
    port=Port.ACTUATION,
    parameters=(
        Parameter(
            *("width", "rad", (0.0, 0.5), 0.02), initial_guesses=(0.5,), model_form_sigma=0.01
        ),
        Parameter("joint_friction", "N m", (0.0, 5.0), 0.05, initial_guesses=(0.3, 2.0)),
        Parameter(
            *("compliance", "rad/(N m)", (0.0, 2.0), 0.05), initial_guesses=(0.3,), sharp=True
        ),
    ),
    sentence="There is play between the servo and the platform it turns.",
    actuate=_actuate,
    actuate_all=_actuate_all,
    frees_joint=True,
    differentiable=False,
    form_error=0.05,
    forms=(("width",), ("width", "joint_friction"), ("width", "joint_friction", "compliance")),
)
