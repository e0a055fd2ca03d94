"""Wheels that slip sideways: they creep in proportion to the side force, or slide above a limit.

A wheel whose contact moves sideways at s is pushed back by

    F = -s / sqrt(creep^2 + (s^2 + s0^2)/(mu N)^2)

which is s/creep while that is small against mu N, and mu N beyond. Without creep the jump of dry
sliding is smoothed at s0 = 0.5 mm/s. That lets wheels that hold creep by s0/(mu N), so it has to be
small; below that, derivatives over steps of 2.5 ms lose it. N is the wheel's share of the weight in
the straight posture, from the balance of moments about either axle: at 0.9 rad it is another by a
half per cent.

The friction of a contact has one direction, against its slip. So a wheel that slides sideways lags
behind its rolling too, by as much as its bearing resists: it turns more slowly, resists less, and
is held less against the side. With the limit mu N sideways and mu N/e along (the friction ellipse;
a circle for e = 1), a lag of e u, and R(w) the resistance of the wheel at the rolling speed w,

    F_side = -s/Y,    -e R(w - e u) = u/Y,    Y = sqrt(creep^2 + (s^2 + u^2 + s0^2)/(mu N)^2)

e is `mu_ratio`; e = 0 leaves rolling as it is. The two wheels of an axle, which slide sideways
together, are given the same u.

Contacts begin to slide more or less gradually. So sliding is looked for together with creep, which
adds to s0 as a root of squares and stands for however gradual it is.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.kinematics import Force, G, Mechanism

SMOOTHING_SPEED = 2.5e-4
"""s0, m/s."""
_ITERATIONS = 4
"""Of Newton's method for u, from 0. They do not overshoot, and end within 1 % of it up to where a
wheel's resistance is 0.9 of what its contact can hold."""


def wheel_loads(p: Mapping[str, ca.SX]) -> dict[int, ca.SX]:
    """The force (N) with which one wheel of platform 1 and one of platform 2 press on the floor."""
    length = p["c1"] + p["c2"]
    on1 = (p["m1"] * (length - p["a1"]) + p["m2"] * p["a2"]) / length
    on2 = p["m1"] + p["m2"] - on1
    return {1: G * on1 / 2, 2: G * on2 / 2}


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    e = values["mu_ratio"]
    pushes = []
    for platform, load in wheel_loads(mechanism.parameters).items():
        wheels = [
            (wheel, mechanism.rolling_speed(wheel))
            for wheel in mechanism.wheels
            if wheel.platform == platform
        ]
        s, most = mechanism.speeds[platform], values["mu"] * load
        at_rest = values["creep_compliance"] ** 2 + (s**2 + SMOOTHING_SPEED**2) / most**2
        lag = ca.SX.sym("lag")
        resistance = sum((wheel.resists(w - e * lag) for wheel, w in wheels), ca.SX(0)) / 2
        u = _lag(resistance, lag, e, at_rest, most)
        push = -s / ca.sqrt(at_rest + (u / most) ** 2)
        for wheel, w in wheels:
            square = ca.vertcat(-wheel.direction[1], wheel.direction[0])
            eased = wheel.resists(w - e * u) - wheel.resists(w)
            vector = push * square + eased * wheel.direction
            pushes.append(Force(wheel.platform, wheel.point, vector))
    held = mechanism.held - {"s1", "s2"}
    return replace(mechanism, forces=(*mechanism.forces, *pushes), held=held)


def _lag(resistance: ca.SX, lag: ca.SX, e: ca.SX, at_rest: ca.SX, most: ca.SX) -> ca.SX:
    """u, m/s, for a wheel's resistance (N) as it depends on `lag`; Y^2 is at_rest + (u/most)^2."""
    by_lag = ca.jacobian(resistance, lag)
    asked, eases = (-e * ca.substitute(part, lag, 0) for part in (resistance, by_lag))
    u = ca.SX(0)
    for _ in range(_ITERATIONS):
        yields = ca.sqrt(at_rest + (u / most) ** 2)
        left = asked + eases * u - u / yields
        u += left / (at_rest / yields**3 - eases)
    return u


EFFECT = Effect(
    name="lateral_slip",
    family="contact",
    port=Port.CONSTRAINT,
    parameters=(
        Parameter("creep_compliance", "m/(N s)", (0.0, 1.0), 0.002),
        Parameter(
            *("mu", "dimensionless", (0.001, 10.0), 0.1),
            neutral=10.0,
            trials=tuple(15.0 * 0.73**k for k in range(22)),
            rough=True,
            vague=0.03,
        ),
        Parameter("mu_ratio", "dimensionless", (0.0, 1.0), 1.0, trials=(1.0,), rough=True),
    ),
    sentence="The wheels slip sideways under load.",
    enter=_enter,
    stiff=True,
    forms=(
        ("creep_compliance",),
        ("creep_compliance", "mu"),
        ("creep_compliance", "mu", "mu_ratio"),
    ),
    smooth=False,
)
