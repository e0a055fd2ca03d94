"""One step of a rig's motion.

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

from rr_opt.lab.planar.bearings import bearings
from rr_opt.lab.planar.layout import Layout, coordinates, layout
from rr_opt.lab.planar.loads import loads
from rr_opt.lab.planar.moment import Moment
from rr_opt.lab.planar.motor import turning
from rr_opt.lab.planar.pushes import pushed
from rr_opt.lab.planar.soft import bent
from rr_opt.lab.planar.stops import stops
from rr_opt.lab.planar.wheels import rolling
from rr_opt.lab.rig import WHEELS, Rig

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
        for k, (load, bearing) in enumerate(zip(loads(rig), bearings(moment, rig), strict=True))
    ]
    pulls = [turning(moment, rig.robot), *stops(moment, rig), *bent(moment, rig)]
    pulls += [pull for wheel in wheels for pull in wheel.pulls]
    mass, turned = _inertia(built, guess.w)
    left, right = rate * mass, rate * (mass @ kept.w) - turned + pushed(moment, rig, nudge)
    for pull in pulls:
        left += pull.hold * (pull.way.T @ pull.way)
        right += pull.push * pull.way.T
    # Symmetric and positive: every hold is, and what has no mass is held by a damper.
    w = ca.ldl_solve(right, *ca.ldl(left))
    spins = ca.vertcat(*(wheel.spin(w) for wheel in wheels))
    return ca.Function("sweep", [*guess.parts, kept.w, kept.spins, signals], [w, spins])


def _inertia(built: Layout, w: ca.SX) -> tuple[ca.SX, ca.SX]:
    """The mass matrix (n, n) and what turning frames add (n)."""
    n = built.q.numel()
    mass, turned = ca.SX(n, n), ca.SX(n, 1)
    for body in built.bodies:
        moves, turns = ca.jacobian(body.place, built.q), ca.jacobian(body.heading, built.q)
        mass += body.m * (moves.T @ moves) + body.I * (turns.T @ turns)
        turned += body.m * (moves.T @ ca.jtimes(moves @ w, built.q, w))
    return mass, turned
