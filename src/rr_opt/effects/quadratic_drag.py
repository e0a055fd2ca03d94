"""Drag that grows with the square of the rolling speed, shared equally by the four wheels."""

from collections.abc import Mapping

import casadi as ca

from rr_opt.effects.effect import Effect, OperatingRange, Parameter, Port
from rr_opt.mechanics.kinematics import Mechanism, with_wheel_forces

# |u| as sqrt(u^2 + u0^2), u0 = 0.1 mm/s, keeps the second derivative finite at u = 0.
_SMOOTHING_SPEED = 1e-4


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    each = values["coefficient_total"] / len(mechanism.wheels)
    return with_wheel_forces(
        mechanism, lambda _, u: -each * u * ca.sqrt(u**2 + _SMOOTHING_SPEED**2)
    )


def _as_viscous(operated: OperatingRange) -> float:
    """As much drag as the viscous one at the robot's speed."""
    return 2 * (operated.robot.k1 + operated.robot.k2) / operated.speed


EFFECT = Effect(
    name="quadratic_drag",
    family="rolling",
    port=Port.FORCE,
    parameters=(
        Parameter("coefficient_total", "N s^2/m^2", (0.0, 100.0), 0.1, typical_for=_as_viscous),
    ),
    sentence="The wheels resist rolling with a force that grows with the square of the speed.",
    enter=_enter,
    # Air drags at the bodies and not at the wheels.
    form_error=0.05,
)
