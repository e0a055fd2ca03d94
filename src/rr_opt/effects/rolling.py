"""What resists rolling beside the paper's viscous friction, and the inertia of the wheels in it."""

from dataclasses import replace

import casadi as ca

from rr_opt.effects.effect import Effect, OperatingRange, Parameter, Port, Symbols
from rr_opt.mechanics.kinematics import Mechanism, Rotor, with_resistance, with_wheel_forces

SMOOTHING_SPEED = 0.002
"""u0, m/s, for an optimiser, and where `onset` is not given."""
_REVERSING = 5e-3
"""s; within a step of this length friction does not reverse a speed."""


def _coulomb_friction(mechanism: Mechanism, values: Symbols) -> Mechanism:
    """Dry (Coulomb) friction at the wheels: a force that resists rolling, whatever the speed.

    The jump of the sign at u = 0 is smoothed to tanh(u/u0). At u0 = 2 mm/s the wheels of a robot
    that moves at decimetres per second spend about a per cent of their time inside the smoothed
    part, and the equations stay differentiable, which an optimiser needs. Against recordings it
    matters: of two plants whose friction sets in over 2 mm/s and over a tenth of that, each
    predicted with the u0 of the other gives an axle's force half as large or twice as large as it
    is. So in predictions u0 is a parameter, `onset`, to which the change of speed that the friction
    makes in 5 ms is added.
    """
    u0 = SMOOTHING_SPEED
    if mechanism.for_prediction:
        p, forces = mechanism.parameters, 2 * (values["force1"] + values["force2"])
        u0 = values["onset"] + _REVERSING * forces / (p["m1"] + p["m2"])
    return with_resistance(
        mechanism, lambda wheel, u: -values[f"force{wheel.platform}"] * ca.tanh(u / u0)
    )


def _viscous(operated: OperatingRange) -> float:
    """The viscous force on a wheel at the robot's speed."""
    return (operated.robot.k1 + operated.robot.k2) / 2 * operated.speed


COULOMB_FRICTION = Effect(
    name="coulomb_friction",
    family="rolling",
    port=Port.FORCE,
    parameters=(
        Parameter("force1", "N", (0.0, 10.0), 0.02, aliases=("F1",), typical_for=_viscous),
        Parameter("force2", "N", (0.0, 10.0), 0.02, aliases=("F2",), typical_for=_viscous),
        Parameter(
            *("onset", "m/s", (2e-4, 0.05), 1e-3), neutral=SMOOTHING_SPEED, initial_guesses=(1.0,)
        ),
    ),
    sentence="Each wheel resists rolling with a force that does not depend on its speed.",
    enter=_coulomb_friction,
    near_discontinuous=True,
)


# |u| as sqrt(u^2 + u0^2), u0 = 0.1 mm/s, keeps the second derivative finite at u = 0.
_ROUND = 1e-4


def _quadratic_drag(mechanism: Mechanism, values: Symbols) -> Mechanism:
    each = values["coefficient_total"] / len(mechanism.wheels)
    return with_wheel_forces(mechanism, lambda _, u: -each * u * ca.sqrt(u**2 + _ROUND**2))


def _as_viscous(operated: OperatingRange) -> float:
    """As much drag as the viscous one at the robot's speed."""
    return 2 * (operated.robot.k1 + operated.robot.k2) / operated.speed


QUADRATIC_DRAG = Effect(
    name="quadratic_drag",
    family="rolling",
    port=Port.FORCE,
    parameters=(
        Parameter("coefficient_total", "N s^2/m^2", (0.0, 100.0), 0.1, typical_for=_as_viscous),
    ),
    sentence="The wheels resist rolling with a force that grows with the square of the speed.",
    enter=_quadratic_drag,
    # Air drags at the bodies and not at the wheels.
    form_error=0.05,
)


KNOTS = (0.0, 0.125, 0.25, 0.5, 1.0)
"""Where the forces are given, as fractions of `speed`."""

_ROUNDING = 1 / 64


def _rolling_force_curve(mechanism: Mechanism, values: Symbols) -> Mechanism:
    """Rolling resistance as an empirical curve of speed, where no physical law is known.

    Each wheel resists with force0 at rest, and with force1 to force4 at 1/8, 1/4, 1/2 and all of
    `speed`; straight in between, constant beyond. The corners are rounded over a 64th of `speed`,
    and the jump at u = 0 is smoothed like that of dry friction.
    """
    forces = [values[f"force{k}"] for k in range(len(KNOTS))]

    def law(_: object, u: ca.SX) -> ca.SX:
        part = ca.sqrt((u / values["speed"]) ** 2 + _ROUNDING**4)
        curve = forces[0]
        for k in range(len(KNOTS) - 1):
            slope = (forces[k + 1] - forces[k]) / (KNOTS[k + 1] - KNOTS[k])
            curve += slope * (_beyond(part - KNOTS[k]) - _beyond(part - KNOTS[k + 1]))
        return -curve * ca.tanh(u / SMOOTHING_SPEED)

    return with_wheel_forces(mechanism, law)


def _beyond(x: ca.SX) -> ca.SX:
    """x where it is positive, else 0, with a round corner."""
    return (x + ca.sqrt(x**2 + _ROUNDING**2)) / 2


ROLLING_FORCE_CURVE = Effect(
    name="rolling_force_curve",
    family="rolling",
    port=Port.FORCE,
    parameters=(
        Parameter("speed", "m/s", (1e-3, 100.0), 0.2, neutral=0.2),
        *(Parameter(f"force{k}", "N", (-10.0, 10.0), 0.02) for k in range(len(KNOTS))),
    ),
    sentence="Each wheel resists rolling with a force that is given at five speeds.",
    enter=_rolling_force_curve,
    candidate=False,
)


def _left_right_drag(mechanism: Mechanism, values: Symbols) -> Mechanism:
    k = mechanism.parameters
    return with_resistance(
        mechanism,
        lambda wheel, u: (
            -k[f"k{wheel.platform}"] * wheel.side * values[f"asymmetry{wheel.platform}"] * u
        ),
    )


LEFT_RIGHT_DRAG = Effect(
    name="left_right_drag",
    family="rolling",
    port=Port.FORCE,
    parameters=(
        Parameter("asymmetry1", "dimensionless", (-1.0, 1.0), 0.2),
        Parameter("asymmetry2", "dimensionless", (-1.0, 1.0), 0.2),
    ),
    sentence="The left wheels roll less easily than the right ones, or more easily.",
    enter=_left_right_drag,
)


def _wheel_inertia(mechanism: Mechanism, values: Symbols) -> Mechanism:
    h = mechanism.parameters["h"]
    wheels = tuple(
        Rotor(values["J"], mechanism.rolling_speed(wheel) / h) for wheel in mechanism.wheels
    )
    return replace(mechanism, rotors=mechanism.rotors + wheels)


def _of_mass(operated: OperatingRange) -> float:
    """Four wheels that act like a tenth of the robot's mass: J/h^2 each."""
    robot = operated.robot
    return 0.1 * (robot.platform1.m + robot.platform2.m) * robot.h**2 / 4


WHEEL_INERTIA = Effect(
    name="wheel_inertia",
    family="rolling",
    port=Port.MASS,
    parameters=(Parameter("J", "kg m^2", (0.0, 1e-2), 1e-6, typical_for=_of_mass),),
    sentence="Turning the wheels about their axles takes energy of its own.",
    enter=_wheel_inertia,
)
