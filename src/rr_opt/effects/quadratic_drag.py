"""Drag that grows with the square of the speed, of the wheels or of the platforms.

The wheels' is shared equally by the four of them. Air or water drags at a platform with -k |v| v at
its centre of mass. As the platform turns it drags at strips of the sides, x from the middle, that
move at |x| w: with k/(2 r) for a unit of length of each, r half the length, the moment is
-(k r^3/2) |w| w. The platforms are taken for boxes of one shape, so r^2 = 1.5 I/m, and share the
coefficient as their faces, by r^2.
"""

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from rr_opt.effects.effect import Effect, OperatingRange, Parameter, Port
from rr_opt.mechanics.kinematics import Force, Mechanism, with_wheel_forces

# |u| as sqrt(u^2 + u0^2), u0 = 0.1 mm/s, keeps the second derivative finite at u = 0.
_SMOOTHING_SPEED = 1e-4


def _size(squared: ca.SX) -> ca.SX:
    return ca.sqrt(squared + _SMOOTHING_SPEED**2)


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    each = values["coefficient_total"] / len(mechanism.wheels)
    at_wheels = with_wheel_forces(mechanism, lambda _, u: -each * u * _size(u**2))
    p = mechanism.parameters
    squares = {i: 1.5 * p[f"I{i}"] / p[f"m{i}"] for i in (1, 2)}
    forces = at_wheels.forces
    for body in mechanism.bodies:
        i, frame = body.platform, mechanism.frames[body.platform]
        k = values["coefficient_bodies"] * squares[i] / (squares[1] + squares[2])
        v = frame.velocity(body.point)
        drag = -k * _size(ca.sumsqr(v)) * v
        turning = -k / 4 * squares[i] ** 1.5 * frame.rate * _size(frame.rate**2)
        arm, across = ca.vertcat(1, 0), ca.vertcat(0, turning)
        forces += (
            Force(i, body.point, drag),
            Force(i, body.point + arm, across),
            Force(i, body.point - arm, -across),
        )
    return replace(at_wheels, forces=forces)


def _as_viscous(operated: OperatingRange) -> float:
    """As much drag as the viscous one at the robot's speed."""
    return 2 * (operated.robot.k1 + operated.robot.k2) / operated.speed


EFFECT = Effect(
    name="quadratic_drag",
    family="rolling",
    port=Port.FORCE,
    parameters=(
        Parameter("coefficient_total", "N s^2/m^2", (0.0, 100.0), 0.1, typical_for=_as_viscous),
        Parameter("coefficient_bodies", "N s^2/m^2", (0.0, 100.0), 0.1, typical_for=_as_viscous),
    ),
    sentence="The wheels or the air resist in proportion to the square of the speed.",
    enter=_enter,
    forms=(("coefficient_total",), ("coefficient_bodies",)),
)
