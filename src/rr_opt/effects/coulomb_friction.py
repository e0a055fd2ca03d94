"""Dry (Coulomb) friction at the wheels: a force that resists rolling, whatever the speed.

The jump of the sign at u = 0 is smoothed to tanh(u/u0). At u0 = 2 mm/s the wheels of a robot that
moves at decimetres per second spend about a per cent of their time inside the smoothed part, and
the equations stay differentiable, which an optimiser needs. Against recordings it matters: of two
plants whose friction sets in over 2 mm/s and over a tenth of that, each predicted with the u0 of
the other gives an axle's force half as large or twice as large as it is. So in predictions u0 is a
parameter, `onset`, to which the change of speed that the friction makes in 2 ms is added: with the
steps of 3 ms at most that are taken with such forces, the slope at u = 0 is 1.5 over the step, half
of what a Runge-Kutta step of order 4 tolerates. With 5 ms, recordings of slow robots with strong
friction, which are inside the smoothed part for long, seemed to disagree on its size.
"""

from collections.abc import Callable, Mapping

import casadi as ca

from rr_opt.effects.effect import Effect, OperatingRange, Parameter, Port
from rr_opt.mechanics.kinematics import Mechanism, with_resistance

SMOOTHING_SPEED = 0.002
"""u0, m/s, for an optimiser, and where `onset` is not given."""
_STEP = 2e-3
"""s; within a step of this length friction does not reverse a speed."""


def steady_in_a_step(mechanism: Mechanism, force: ca.SX) -> ca.SX:
    """The change of speed (m/s) that a force makes in 2 ms."""
    return _STEP * force / (mechanism.parameters["m1"] + mechanism.parameters["m2"])


def dry(
    mechanism: Mechanism, values: Mapping[str, ca.SX], share: Callable[[ca.SX], ca.SX | float]
) -> Mechanism:
    """Add dry friction at every wheel: a share of `force1` or `force2` at each speed, m/s."""
    u0 = SMOOTHING_SPEED
    if mechanism.for_prediction:
        every = 2 * (values["force1"] + values["force2"])
        u0 = values["onset"] + steady_in_a_step(mechanism, every)
    return with_resistance(
        mechanism, lambda wheel, u: -values[f"force{wheel.platform}"] * share(u) * ca.tanh(u / u0)
    )


def viscous(operated: OperatingRange) -> float:
    """The viscous force on a wheel at the robot's speed, N."""
    return (operated.robot.k1 + operated.robot.k2) / 2 * operated.speed


FORCES = (
    Parameter("force1", "N", (0.0, 10.0), 0.02, aliases=("F1",), typical_for=viscous),
    Parameter("force2", "N", (0.0, 10.0), 0.02, aliases=("F2",), typical_for=viscous),
    Parameter(
        *("onset", "m/s", (2e-4, 0.05), 1e-3), neutral=SMOOTHING_SPEED, initial_guesses=(1.0,)
    ),
)
"""Friction of a wheel of either platform, and the speed over which it sets in."""

EFFECT = Effect(
    name="coulomb_friction",
    family="rolling",
    port=Port.FORCE,
    parameters=FORCES,
    sentence="Each wheel resists rolling with a force that does not depend on its speed.",
    enter=lambda mechanism, values: dry(mechanism, values, lambda _: 1.0),
    near_discontinuous=True,
    lookalikes=("dragged_cable", "stribeck_friction"),
)
