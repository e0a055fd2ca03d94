"""One step of a rig's motion.

A wheel on the floor: it turns on its bearing, and its contact rubs where it slips.

The contact slips sideways by s, and along by l = u - h spin, u the speed of the wheel's centre. The
floor pushes it back with one force F that is shared by both,

    F = -mu N tanh(r)/r (s/s1, l/l1),      r^2 = (s/s1)^2 + (l/l1)^2

which is -mu N s/s1 for small slips and mu N for large ones, whatever their direction. Without creep
s1 = l1 = ONSET: a friction circle, and a wheel that slides sideways turns more slowly. Creep makes
s1 larger, by mu N times its compliance, so it acts sideways alone.

The bearing resists with a torque D spin, D >= 0 of the spin as it is guessed: dry friction, for
one, is D = torque/(spin^4 + onset^4)^(1/4). Only the wheel's spin inertia J keeps it turning; it
may be none, as then the torques of floor and bearing balance at once.

As every force is a positive number times a speed, the guesses close in on the step's end however
sharply friction sets in.

Newton and Euler for each body, along each coordinate: with p the place and theta the heading of a
body,

    sum over bodies of  p_q' (m p'' - F) + theta_q' (I theta'' - M) = 0,

where p_q is the derivative by the coordinates. Rates and coordinates are stepped by the backward
differentiation formula of second order, which damps what is too fast for the step and does not
have to follow it:

    (3 w - 4 w1 + w2)/(2 dt) = w',      (3 q - 4 q1 + q2)/(2 dt) = w,

w1 and w2 a step and two steps ago. The step's end is guessed SWEEPS times, see `Moment`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import casadi as ca

from rr_lab.planar.forces import Moment, Pull, bearings, pulls, pushed
from rr_lab.planar.layout import PlanarLayout, axis, coordinates, layout, left_of
from rr_lab.rig import WHEELS, Rig, wheel_loads

ONSET = 1e-4
"""m/s, over which a contact begins to slip. With the grip of a rig in which nothing slides it makes
a side creep of some 1e-6 m/(N s)."""

_STILL = 1e-12
"""Of ONSET squared: keeps tanh(r)/r finite where nothing slips."""


@dataclass(frozen=True)
class Rolling:
    """pulls on the robot; the wheel's spin is `carried + taken * (speed along `way`)`, rad/s."""

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
    """What wheel n does.

    load     N, with which it presses on the floor
    bearing  D, N m s
    kept     rad/s, the spin that it has without torque; rate (1/s) is what a torque changes it by
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
"""Guesses of a step's end. Five do no better; two do as well where nothing slides or strikes."""

SIGNALS = ("asked", "rate", "t", "free", "nudge")
"""What is given at the end of each step; see `Moment` and `pushed`."""


@dataclass(frozen=True)
class State:
    """Coordinates q (n) and rates w (n) of the layout; turns, rad, and spins, rad/s, of the wheels
    (4)."""

    q: ca.SX
    w: ca.SX
    turns: ca.SX
    spins: ca.SX

    @property
    def parts(self) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
        """All of them, as they are stacked: 2 n + 8."""
        return self.q, self.w, self.turns, self.spins

    def then(self, next: State) -> State:
        """What would come after these two with rates and coordinates standing still."""
        return State(*((4 * b - a) / 3 for a, b in zip(self.parts, next.parts, strict=True)))

    def moved(self, w: ca.SX, spins: ca.SX, dt: float) -> State:
        """What comes instead, with these rates."""
        ahead = 2 * dt / 3
        return State(self.q + ahead * w, w, self.turns + ahead * spins, spins)


def step_of(rig: Rig, dt: float) -> ca.Function:
    """(states two steps ago and one step ago, SIGNALS at its end) -> the same a step of dt s on."""
    sweep, n = _sweep(rig, dt), len(coordinates(rig))
    older, old = _symbols(n, "older"), _symbols(n, "old")
    signals = ca.SX.sym("signals", len(SIGNALS))
    # The end that there would be without forces, and the first guess of what they make of it.
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
    """(a guessed State, w and spins without forces, signals) -> better w and spins.

    The guess enters the forces alone; the equations of motion are solved for w.
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
    # Symmetric and positive: every hold is, and a coordinate without mass has a damper.
    w = ca.ldl_solve(right, *ca.ldl(left))
    spins = ca.vertcat(*(wheel.spin(w) for wheel in wheels))
    return ca.Function("sweep", [*guess.parts, kept.w, kept.spins, signals], [w, spins])


def _inertia(built: PlanarLayout, w: ca.SX) -> tuple[ca.SX, ca.SX]:
    """The mass matrix (n, n) and what turning frames add (n)."""
    n = built.q.numel()
    mass, turned = ca.SX(n, n), ca.SX(n, 1)
    for body in built.bodies:
        moves, turns = ca.jacobian(body.place, built.q), ca.jacobian(body.heading, built.q)
        mass += body.m * (moves.T @ moves) + body.I * (turns.T @ turns)
        turned += body.m * (moves.T @ ca.jtimes(moves @ w, built.q, w))
    return mass, turned
