"""Wheels that slip sideways: they creep in proportion to the side force, or slide above a limit.

A wheel whose contact moves sideways at s is pushed back by

    F = -s / sqrt(creep^2 + (s^2 + s0^2)/(mu N)^2)

which is s/creep while that is small against mu N, and mu N beyond. Without creep the jump of dry
sliding is smoothed at s0 = 0.1 mm/s. With it wheels that hold creep at s0/(mu N), so it has to be
small. N is the wheel's share of the weight in the straight posture, from the balance of moments
about either axle; at 0.9 rad it differs by half a per cent.

Friction of a contact acts against its slip, in one direction. So a wheel that slides sideways also
lags behind pure rolling, by as much as its bearing resists: it turns more slowly, resists less, and
is held less against the side. With limits mu N sideways and mu N/e along (the friction ellipse; a
circle for e = 1), a lag of e u, and R(w) the resistance of the wheel at the rolling speed w,

    F_side = -s/Y,    -e R(w - e u) = u/Y,    Y = sqrt(creep^2 + (s^2 + u^2 + s0^2)/(mu N)^2)

e is `mu_ratio`; e = 0 leaves rolling as it is. R is all that the floor does to the wheel: dry
friction and patches too. About w it is taken as linear, as dry friction is until the wheel stops,
or as constant where it falls with the speed. A wheel does not turn backwards: one that resists more
than its contact can hold is dragged along at e u = w, by u/(e Y).

Contacts begin to slide more or less gradually, and physics engines that are given the same friction
differ by about a tenth in the breakaway force. So sliding is fitted together with creep, which adds
to s0 as a root of squares and stands for how gradual the onset is.
"""

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.kinematics import Force, Mechanism, Wheel, wheel_loads

SMOOTHING_SPEED = 1e-4
"""s0, m/s."""
_ITERATIONS = 4
"""Newton iterations for u, from 0. They do not overshoot, and end within 1 % of u as long as a
wheel's resistance is at most 0.9 of what its contact can hold."""
_NONE = 1e-9
"""Keeps a lag finite that e = 0 leaves without a limit."""


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    e, loads = values["mu_ratio"], wheel_loads(mechanism.parameters)
    pushes = []
    for wheel in mechanism.wheels:
        s, grip = mechanism.speeds[wheel.platform], values["mu"] * loads[wheel.platform]
        w = mechanism.rolling_speed(wheel)
        at_rest = values["creep_compliance"] ** 2 + (s**2 + SMOOTHING_SPEED**2) / grip**2
        lag = _lag(wheel, w, e, at_rest, grip)
        Y = ca.sqrt(at_rest + (e * lag / grip) ** 2)
        sideways = ca.vertcat(-wheel.direction[1], wheel.direction[0])
        relief = (e > 0) * (-lag / Y - wheel.resistance(w))
        vector = -s / Y * sideways + relief * wheel.direction
        pushes.append(Force(wheel.platform, wheel.point, vector))
    constrained = mechanism.constrained - {"s1", "s2"}
    return replace(mechanism, forces=(*mechanism.forces, *pushes), constrained=constrained)


def _lag(wheel: Wheel, w: ca.SX, e: ca.SX, at_rest: ca.SX, grip: ca.SX) -> ca.SX:
    """u/e, m/s, of a wheel whose axle moves at w along it; Y^2 is at_rest + (u/grip)^2."""
    speed = ca.SX.sym("speed")
    law = wheel.resistance(speed)
    R, slope = (
        ca.substitute(part, speed, w) for part in (law, ca.fmin(ca.jacobian(law, speed), 0))
    )
    most = ca.fabs(w) / (e**2 + _NONE)
    lag = ca.SX(0)
    for _ in range(_ITERATIONS):
        Y = ca.sqrt(at_rest + (e * lag / grip) ** 2)
        residual = e**2 * slope * lag - R - lag / Y
        lag += residual / (at_rest / Y**3 - e**2 * slope)
        lag = ca.fmax(-most, ca.fmin(lag, most))
    return lag


EFFECT = Effect(
    name="lateral_slip",
    family="contact",
    port=Port.FORCE,
    parameters=(
        Parameter("creep_compliance", "m/(N s)", (0.0, 20.0), 0.002),
        Parameter(
            *("mu", "dimensionless", (0.001, 10.0), 0.1),
            neutral=10.0,
            guess_from_data=True,
            model_form_sigma=0.03,
            sharp=True,
        ),
        Parameter("mu_ratio", "dimensionless", (0.0, 1.0), 1.0, costly=True),
    ),
    sentence="The wheels slip sideways under load.",
    enter=_enter,
    stiff=True,
    forms=(
        ("creep_compliance",),
        ("creep_compliance", "mu"),
        ("creep_compliance", "mu", "mu_ratio"),
    ),
    differentiable=False,
    tangent="lateral_creep",
    form_error=0.1,
)
