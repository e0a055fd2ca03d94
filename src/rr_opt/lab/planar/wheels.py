"""A wheel on the floor: it turns on its bearing, and its contact rubs where it slips.

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
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from rr_opt.lab.planar.layout import axis, left_of
from rr_opt.lab.planar.moment import Moment, Pull
from rr_opt.lab.rig import Rig

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
