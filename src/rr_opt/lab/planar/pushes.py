"""What pushes the masses whatever the robot does: the slope, a cord, a nudge."""

from __future__ import annotations

import casadi as ca

from rr_opt.lab.planar.layout import axis
from rr_opt.lab.planar.moment import Moment
from rr_opt.lab.rig import Rig


def pushed(moment: Moment, rig: Rig, nudge: ca.SX) -> ca.SX:
    """The generalised forces (n). nudge: m/s2, what a push on platform 1 along its axis gives all
    mass. Slope and cord act once the robot is let go."""
    total = ca.SX(moment.layout.q.numel(), 1)
    down = ca.vertcat(*map(float, rig.gravity[:2]))
    for body in moment.layout.bodies:
        total += moment.free * (moment.way(body.place).T @ (body.m * down))
    first = moment.layout.bodies[0]
    mass = sum(body.m for body in moment.layout.bodies[:2])
    total += moment.way(first.place).T @ (nudge * mass * axis(first.heading))
    if rig.tether is not None:
        post = ca.vertcat(rig.tether.x, rig.tether.y)
        # The cord is tied over the mass's place on the axis.
        tied = moment.layout.ends[0][:2] + rig.robot.platform1.joint_to_centre * axis(first.heading)
        length = ca.norm_2(tied - post)
        taut = rig.tether.stiffness * ca.fmax(length - rig.tether.slack, 0)
        total -= moment.free * taut * moment.way(length).T
    return total
