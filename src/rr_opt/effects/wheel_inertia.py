"""The wheels' own moment of inertia about their axles, which spins up as they roll."""

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from rr_opt.effects.effect import Effect, OperatingRange, Parameter, Port
from rr_opt.mechanics.kinematics import Mechanism, Rotor


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    h = mechanism.parameters["h"]
    wheels = tuple(
        Rotor(values["J"], mechanism.rolling_speed(wheel) / h) for wheel in mechanism.wheels
    )
    return replace(mechanism, rotors=mechanism.rotors + wheels)


def _of_mass(operated: OperatingRange) -> float:
    """Four wheels that act like a tenth of the robot's mass: J/h^2 each."""
    robot = operated.robot
    return 0.1 * (robot.platform1.m + robot.platform2.m) * robot.h**2 / 4


EFFECT = Effect(
    name="wheel_inertia",
    family="rolling",
    port=Port.MASS,
    parameters=(Parameter("J", "kg m^2", (0.0, 1e-2), 1e-6, typical_for=_of_mass),),
    sentence="Spinning the wheels about their axles takes kinetic energy of its own.",
    enter=_enter,
)
