"""Wheels that slip sideways: they creep in proportion to the side force, or slide above a limit.

A wheel whose contact moves sideways at s is pushed back by

    F = -s / sqrt(creep^2 + (s^2 + s0^2)/(mu N)^2)

which is s/creep while that is small against mu N, and mu N beyond. Without creep the jump of dry
sliding is smoothed at s0 = 0.5 mm/s. That lets wheels that hold creep by s0/(mu N), so it has to be
small; below that, derivatives over steps of 2.5 ms lose it. N is the wheel's share of the weight in
the straight posture, from the balance of moments about either axle.

Contacts begin to slide more or less gradually. So sliding is looked for together with creep, which
adds to s0 as a root of squares and stands for however gradual it is.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from rr_opt.physics.effects.effect import Effect, Parameter, Port
from rr_opt.physics.gravity import G
from rr_opt.physics.kinematics import Force, Mechanism

SMOOTHING_SPEED = 5e-4
"""s0, m/s."""


def wheel_loads(p: Mapping[str, ca.SX]) -> dict[int, ca.SX]:
    """The force (N) with which one wheel of platform 1 and one of platform 2 press on the floor."""
    length = p["c1"] + p["c2"]
    on1 = (p["m1"] * (length - p["a1"]) + p["m2"] * p["a2"]) / length
    on2 = p["m1"] + p["m2"] - on1
    return {1: G * on1 / 2, 2: G * on2 / 2}


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    loads = wheel_loads(mechanism.parameters)
    creep, mu = values["creep_compliance"], values["mu"]
    pushes = []
    for wheel in mechanism.wheels:
        square = ca.vertcat(-wheel.direction[1], wheel.direction[0])
        s = mechanism.speeds[wheel.platform]
        most = mu * loads[wheel.platform]
        push = -s / ca.sqrt(creep**2 + (s**2 + SMOOTHING_SPEED**2) / most**2)
        pushes.append(Force(wheel.platform, wheel.point, push * square))
    held = mechanism.held - {"s1", "s2"}
    return replace(mechanism, forces=(*mechanism.forces, *pushes), held=held)


EFFECT = Effect(
    name="lateral_slip",
    family="contact",
    port=Port.CONSTRAINT,
    parameters=(
        Parameter("creep_compliance", "m/(N s)", (0.0, 1.0), 0.002),
        Parameter(
            *("mu", "dimensionless", (0.001, 10.0), 0.1),
            neutral=10.0,
            trials=(3.0, 0.5),
            rough=True,
        ),
    ),
    sentence="The wheels slip sideways under load.",
    enter=_enter,
    stiff=True,
    forms=(("creep_compliance",), ("creep_compliance", "mu")),
    smooth=False,
)
