"""How the joint swings while the servo does not hold it: its torque is zero, and phi is free.

In z = v - g dphi (see `floor_motion`) the joint obeys

    torque(phi, dphi, z, ddphi) = 0,        zdot = f - (dg/dphi) dphi^2

of which the first is affine in ddphi. A blow on the joint changes dphi at once and z not at all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import lru_cache

import casadi as ca

from rr_opt.physics.assembly import values_of
from rr_opt.physics.drive import FreeJoint
from rr_opt.physics.floor_motion import POSE, floor_motion
from rr_opt.robot.parameters import Robot


def free_joint(robot: Robot) -> FreeJoint:
    """The joint of a robot with nothing but the paper's friction."""
    return free_joint_of(lambda parameters: values_of(robot, parameters))


def free_joint_of(values: Callable[[tuple[str, ...]], Iterable[float]]) -> FreeJoint:
    """The same of a robot that is told by the values of its parameters, SI."""
    return FreeJoint(_swing(), tuple(values(floor_motion().parameters)))


@lru_cache
def _swing() -> ca.Function:
    motion = floor_motion()
    phi, dphi, z, ddphi = (ca.SX.sym(name) for name in ("phi", "dphi", "z", "ddphi"))
    p = ca.SX.sym("p", len(motion.parameters))
    state, drive = ca.vertcat(ca.SX.zeros(len(POSE)), z), ca.vertcat(phi, dphi)
    torque = motion.torque(state, drive, ddphi, p)
    free = -ca.substitute(torque, ddphi, ca.SX(0)) / ca.jacobian(torque, ddphi)
    onward = motion.rates(state, drive, p)[len(POSE)]
    out = ca.vertsplit(ca.cse(ca.vertcat(free, onward)))
    return ca.Function("swing", [phi, dphi, z, p], out)
