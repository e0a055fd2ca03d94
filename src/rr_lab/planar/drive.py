"""A gait driven on a rig in the plane.

A wheel turns on its bearing, and its contact has friction where it slips.

The contact slips sideways by s, and along by l = u - h spin, u the speed of the wheel's centre. The
floor resists with one force F shared by both,

    F = -mu N tanh(r)/r (s/s1, l/l1),      r^2 = (s/s1)^2 + (l/l1)^2

which is -mu N s/s1 for small slips and mu N for large ones, in any direction. Without creep
s1 = l1 = ONSET: a friction circle, and a wheel that slides sideways turns more slowly. Creep makes
s1 larger, by mu N times its compliance, so it acts sideways only.

The bearing resists with a torque D spin, D >= 0 evaluated at the current iterate of the spin: dry
friction, for example, is D = torque/(spin^4 + onset^4)^(1/4). Only the wheel's spin inertia J keeps
it turning; it may be zero, as then the torques of floor and bearing balance instantly.

As every force is a positive number times a speed, the iteration converges to the end of the step
however abrupt the friction is.

Newton and Euler for each body, along each coordinate: with p the place and theta the heading of a
body,

    sum over bodies of  p_q' (m p'' - F) + theta_q' (I theta'' - M) = 0,

where p_q is the derivative by the coordinates. Rates and coordinates are integrated by the
second-order backward differentiation formula, which damps what is too fast for the step instead of
following it:

    (3 w - 4 w1 + w2)/(2 dt) = w',      (3 q - 4 q1 + q2)/(2 dt) = w,

w1 and w2 one and two steps ago. The end of a step takes SWEEPS iterations, see `Moment`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import casadi as ca
import numpy as np

from rr_lab.planar.forces import Moment, Pull, bearings, motor, pulls, pushed, turned_by
from rr_lab.planar.layout import PlanarLayout, axis, coordinates, layout, left_of
from rr_lab.rig import WHEELS, Rig, wheel_loads
from rr_lab.run import Conditions, Motion, asked_angle
from rr_opt.array import Array
from rr_opt.model.gait import Gait
from rr_opt.outcome import NotConvergedError

ONSET = 1e-4
"""m/s, the slip at which a contact saturates. With the grip of a rig in which nothing slides it
gives a side creep of some 1e-6 m/(N s)."""

_STILL = 1e-12
"""Relative to ONSET squared: keeps tanh(r)/r finite at zero slip."""


@dataclass(frozen=True)
class Rolling:
    """pulls: on the robot; the wheel's spin is `carried + taken * (speed along `way`)`, rad/s."""

    pulls: tuple[Pull, Pull]
    way: ca.SX
    carried: ca.SX
    taken: ca.SX

    def spin(self, w: ca.SX) -> ca.SX:
        """rad/s, for the coordinates' rates."""
        return self.carried + self.taken * (self.way @ w)


def rolling(
    moment: Moment, rig: Rig, n: int, load: float, bearing: ca.SX, kept: ca.SX, rate: float
) -> Rolling:
    """Spin and forces of wheel n.

    load     N, with which it presses on the floor
    bearing  D, N m s
    kept     rad/s, its spin without torque; rate (1/s): change of the spin per torque
    """
    wheel, h, J = moment.layout.wheels[n], rig.robot.h, rig.J[n]
    ahead = axis(wheel.heading)
    moves = moment.way(wheel.place)
    along, across = ahead.T @ moves, left_of(ahead).T @ moves
    most = rig.mu * load
    s1 = ONSET + rig.creep * most
    side = across @ moment.w / s1
    lag = (along @ moment.w - h * moment.spins[n]) / ONSET
    r = ca.sqrt(side**2 + lag**2 + _STILL)
    grip = most * ca.tanh(r) / r
    # J rate (spin - kept) = h F - D spin with F = (grip/ONSET) (u - h spin), for the spin; and F.
    floor = grip / ONSET
    yields = J * rate + bearing + h**2 * floor
    carried = J * rate * kept / yields
    hold = floor * (J * rate + bearing) / yields
    pulls = Pull(along, hold, floor * h * carried), Pull(across, grip / s1, 0.0)
    return Rolling(pulls, along, carried, h * floor / yields)


SWEEPS = 3
"""Iterations per step. Five are no better; two suffice where nothing slides or strikes."""

SIGNALS = ("asked", "rate", "t", "free", "nudge")
"""Inputs at the end of each step; see `Moment` and `pushed`."""


@dataclass(frozen=True)
class State:
    """Coordinates q (n) and rates w (n) of the layout; angles, rad, and spins, rad/s, of the wheels
    (4)."""

    q: ca.SX
    w: ca.SX
    turns: ca.SX
    spins: ca.SX

    @property
    def parts(self) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
        """All of them, in stacking order: 2 n + 8."""
        return self.q, self.w, self.turns, self.spins

    def then(self, next: State) -> State:
        """The state after these two at constant rates and coordinates."""
        return State(*((4 * b - a) / 3 for a, b in zip(self.parts, next.parts, strict=True)))

    def moved(self, w: ca.SX, spins: ca.SX, dt: float) -> State:
        """The state with these rates instead."""
        ahead = 2 * dt / 3
        return State(self.q + ahead * w, w, self.turns + ahead * spins, spins)


def step_of(rig: Rig, dt: float) -> ca.Function:
    """(states two and one steps ago, SIGNALS at the end of the step) -> the same, dt s later."""
    sweep, n = _sweep(rig, dt), len(coordinates(rig))
    older, old = _symbols(n, "older"), _symbols(n, "old")
    signals = ca.SX.sym("signals", len(SIGNALS))
    # The force-free end of the step, and the first iterate with forces.
    kept = older.then(old)
    w, spins = 2 * old.w - older.w, 2 * old.spins - older.spins
    for _ in range(SWEEPS):
        w, spins = sweep(*kept.moved(w, spins, dt).parts, kept.w, kept.spins, signals)
    new = kept.moved(w, spins, dt)
    return ca.Function(
        "step",
        [ca.vertcat(*older.parts, *old.parts), signals],
        [ca.vertcat(*old.parts, *new.parts)],
        {"cse": True},
    )


def _symbols(n: int, name: str) -> State:
    sizes = (n, n, len(WHEELS), len(WHEELS))
    return State(*(ca.SX.sym(f"{name}{k}", size) for k, size in enumerate(sizes)))


def _sweep(rig: Rig, dt: float) -> ca.Function:
    """(an iterate of State, force-free w and spins, signals) -> better w and spins.

    The iterate enters the forces only; the equations of motion are solved for w.
    """
    built, rate = layout(rig), 3 / (2 * dt)
    guess = replace(_symbols(len(built.names), "guess"), q=built.q)
    kept = _symbols(len(built.names), "kept")
    signals = ca.SX.sym("signals", len(SIGNALS))
    asked, asked_rate, t, free, nudge = ca.vertsplit(signals)
    moment = Moment(built, guess.w, guess.spins, guess.turns, 1 / rate, asked, asked_rate, t, free)
    wheels = [
        rolling(moment, rig, k, load, bearing, kept.spins[k], rate)
        for k, (load, bearing) in enumerate(
            zip(wheel_loads(rig), bearings(moment, rig), strict=True)
        )
    ]
    acting = [*pulls(moment, rig), *(pull for wheel in wheels for pull in wheel.pulls)]
    mass, turned = _inertia(built, guess.w)
    left, right = rate * mass, rate * (mass @ kept.w) - turned + pushed(moment, rig, nudge)
    for pull in acting:
        left += pull.hold * (pull.way.T @ pull.way)
        right += pull.push * pull.way.T
    # Symmetric and positive: every hold is, and a massless coordinate has a damper.
    w = ca.ldl_solve(right, *ca.ldl(left))
    spins = ca.vertcat(*(wheel.spin(w) for wheel in wheels))
    return ca.Function("sweep", [*guess.parts, kept.w, kept.spins, signals], [w, spins])


def _inertia(built: PlanarLayout, w: ca.SX) -> tuple[ca.SX, ca.SX]:
    """The mass matrix (n, n) and the terms from rotating frames (n)."""
    n = built.q.numel()
    mass, turned = ca.SX(n, n), ca.SX(n, 1)
    for body in built.bodies:
        moves, turns = ca.jacobian(body.place, built.q), ca.jacobian(body.heading, built.q)
        mass += body.m * (moves.T @ moves) + body.I * (turns.T @ turns)
        turned += body.m * (moves.T @ ca.jtimes(moves @ w, built.q, w))
    return mass, turned


STEP = 5e-4
"""s. results/lab/README.md shows its accuracy."""

STRIKING = 2.5e-4
"""s, the longest step of a rig with impacts, which take some milliseconds."""

WILD = 1e3
"""m/s or rad/s: faster than any robot."""

_AT_ONCE = 100
"""Samples computed per call."""


@dataclass(frozen=True)
class Clock:
    """The steps of a run's conditions, `every` per sample; `before` samples precede the recording.

    t  command time at the ends of the steps, s, and of two steps before the first
    """

    dt: float
    every: int
    before: int
    t: Array

    @classmethod
    def of(cls, rig: Rig, gait: Gait, conditions: Conditions, step: float) -> Clock:
        """Steps of about `step` s that begin before the command does."""
        every = max(1, round(1 / (conditions.rate * fine_enough(rig, step))))
        dt = 1 / (conditions.rate * every)
        early = (rig.clock - conditions.begin(gait)) * conditions.rate
        before = max(1, math.ceil(early - 1e-6))
        samples = before + round(conditions.seconds * conditions.rate)
        ends = np.arange(-1, samples * every + 1, dtype=float) - before * every
        return cls(dt, every, before, rig.clock + dt * ends)

    @property
    def samples(self) -> slice:
        """The steps at whose ends samples are taken."""
        return slice(self.before * self.every - 1, None, self.every)


def fine_enough(rig: Rig, step: float) -> float:
    """The step actually used if `step` is requested, s: limited by the rig's impacts."""
    return min(step, STRIKING) if rig.play or rig.pin else step


def drive(rig: Rig, gait: Gait, conditions: Conditions, step: float = STEP) -> Motion:
    """Drive a gait and record the motion. Raises NotConvergedError if the simulation fails."""
    clock, begin = Clock.of(rig, gait, conditions, step), conditions.begin(gait)
    asked = asked_angle(rig, gait, begin, clock.t)
    # The difference formula of the integrator, so that commanded and actual rates are comparable.
    rate = (3 * asked[2:] - 4 * asked[1:-1] + asked[:-2]) / (2 * clock.dt)
    t = clock.t[2:]
    nudge = np.zeros(len(t))
    nudge[clock.samples.start + 1 : clock.samples.start + 2] = conditions.nudge / clock.dt
    free = np.where(t > begin + 1e-12, 1.0, 0.0)
    signals = np.stack([asked[2:], rate, t - begin, free, nudge])
    assert len(signals) == len(SIGNALS)
    return _motion(rig, conditions, clock, _run(rig, clock, conditions, asked[1], signals), signals)


def still(rig: Rig, conditions: Conditions, angle: float) -> Array:
    """Two successive states, at rest with the joint at an angle, rad."""
    built = layout(rig)
    state = np.zeros(2 * len(built.names) + 8)
    state[:3], state[built.names.index("phi")] = conditions.pose, angle
    if "shaft" in built.names:
        state[built.names.index("shaft")] = angle
    return np.concatenate([state, state])


def require_tame(rates: Array) -> None:
    """Raise NotConvergedError for huge rates."""
    if not np.abs(rates).max() < WILD:
        raise NotConvergedError(
            "The laboratory's simulation diverged: the planar engine reached huge speeds. Expected "
            "a finite motion. Try a gentler gait, a weaker effect or a smaller step."
        )


def _run(rig: Rig, clock: Clock, conditions: Conditions, angle: float, signals: Array) -> Array:
    """The states (k, samples), including those before the recording, from rest at `angle` rad."""
    built = layout(rig)
    sample = step_of(rig, clock.dt).fold(clock.every)
    samples, part = sample.mapaccum(_AT_ONCE), _AT_ONCE * clock.every
    state, found = ca.DM(still(rig, conditions, angle)), []
    half = state.numel() // 2
    for at in range(0, signals.shape[1], part):
        piece = signals[:, at : at + part]
        given = np.pad(piece, ((0, 0), (0, part - piece.shape[1])), mode="edge")
        made: ca.DM = samples(state, given)
        state = made[:, -1]
        found.append(np.asarray(made)[half:, : piece.shape[1] // clock.every])
    states = np.concatenate(found, axis=1)
    require_tame(states[len(built.names) : 2 * len(built.names)])
    return states


def _motion(
    rig: Rig, conditions: Conditions, clock: Clock, states: Array, signals: Array
) -> Motion:
    built = layout(rig)
    n = len(built.names)
    states, signals = states[:, clock.before - 1 :], signals[:, clock.samples]
    ends = ca.Function("ends", [built.q], list(built.ends))
    one, two = (np.asarray(end).T for end in ends(states[:n]))
    made, drive = built.names.index(turned_by(built)), motor(rig)
    t = np.arange(states.shape[1]) / conditions.rate
    if not conditions.torque:
        return Motion(t, one, two)
    torque = drive.stiffness * (signals[0] - states[made])
    torque += drive.damping * (drive.feedforward * signals[1] - states[n + made])
    return Motion(t, one, two, torque)
