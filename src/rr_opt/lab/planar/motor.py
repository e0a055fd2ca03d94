"""The servo: a motor that turns platform 2 against platform 1 after its command.

Its torque is stiffness * (asked - made) + damping * (the same of the rates), on platform 2 and with
the other sign on platform 1; nothing limits it. Nothing but this makes the angle.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from rr_opt.lab.planar.layout import Layout
from rr_opt.lab.planar.moment import Moment, Pull, spring
from rr_opt.robot.parameters import Robot

QUICK = 1000.0
"""1/s, how fast the motor settles. A robot that is asked for an acceleration of 30 rad/s2 is then
30/QUICK^2 = 0.03 mrad behind, or up to three times that where its wheels stand in the way."""


@dataclass(frozen=True)
class Motor:
    """stiffness, N m/rad; damping, N m s/rad."""

    stiffness: float
    damping: float


def motor(robot: Robot) -> Motor:
    """Critically damped for the platforms as they turn against each other about a joint at rest."""
    one, two = robot.platform1.joint_inertia, robot.platform2.joint_inertia
    inertia = one * two / (one + two)
    return Motor(inertia * QUICK**2, 2 * inertia * QUICK)


def turned_by(built: Layout) -> str:
    """The coordinate that the motor turns: behind play a shaft, which has no inertia of its own."""
    return "shaft" if "shaft" in built.names else "phi"


def turning(moment: Moment, robot: Robot) -> Pull:
    """The motor's torque."""
    made, drive = moment.layout.of(turned_by(moment.layout)), motor(robot)
    pull = spring(moment, made, drive.stiffness, drive.damping, moment.asked)
    return replace(pull, push=pull.push + drive.damping * moment.rate)
