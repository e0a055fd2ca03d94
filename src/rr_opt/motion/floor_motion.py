"""The motion on the floor with every kind of effect: where the robot is, and side slip, count.

`dynamics` is for a gait's steady cycle, where neither place nor heading matters and the axles are
held. Here P is at (x, y), the heading is psi, and the speeds u = (v), or (v, s1, s2) where an
effect lets the axles slip, follow

    udot = f(u, phi, dphi, place) + g(phi) ddphi

A servo that starts, stops or hits something jumps in dphi, and ddphi is then no number. So the
state holds z = u - g dphi instead of u, which needs no ddphi and does not jump:

    zdot = f - (dg/dphi) dphi^2,        u = z + g dphi

Axles that may slip stop slipping at once. What they come to rest at is s = 0 and not a z, so there
the state holds u itself, and the drive brings the mean of ddphi over a step.

How the joint swings while the servo does not hold it: its torque is zero, and phi is free.

In z = v - g dphi (see `floor_motion`) the joint obeys

    torque(phi, dphi, z, ddphi) = 0,        zdot = f - (dg/dphi) dphi^2

of which the first is affine in ddphi. A blow on the joint changes dphi at once and z not at all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import lru_cache

import casadi as ca

from rr_opt.mechanics.drive import FreeJoint
from rr_opt.mechanics.kane import equations
from rr_opt.mechanics.kinematics import SPEEDS
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import Assembly, assembled, values_of

POSE = ("x", "y", "psi")


@dataclass(frozen=True)
class FloorMotion:
    """The derived model over state = (x, y, psi, z), drive = (phi, dphi) and parameters p.

    Where the axles slip, over state = (x, y, psi, v, s1, s2) and drive = (phi, dphi, ddphi).

    rates   (state, drive, p) -> d(state)/dt
    seen    (state, drive, p) -> x, y, psi, phi as a capture system sees them (4,)
    speeds  (state, drive, p) -> v, s1, s2, w: of axle 1 and both axles' side speeds, m/s, psi-dot
    torque  (state, drive, ddphi, p) -> of the servo, N m; ddphi is given once more
    """

    effects: tuple[str, ...]
    free: tuple[str, ...]
    parameters: tuple[str, ...]
    rates: ca.Function
    seen: ca.Function
    speeds: ca.Function
    torque: ca.Function

    @property
    def size(self) -> int:
        """How many numbers the state has."""
        return len(POSE) + len(self.free)

    @property
    def slips(self) -> bool:
        """Whether the axles may move sideways, which they stop doing at once: it is stiff."""
        return len(self.free) > 1


@lru_cache
def floor_motion(effects: tuple[str, ...] = ()) -> FloorMotion:
    """Derive the motion with the named effects; those of the servo are for who drives it.

    It is for predictions, so dry friction sets in as softly as its `onset` says.
    """
    return solved(assembled(effects, sharp=True))


def solved(assembly: Assembly) -> FloorMotion:
    """The motion of an assembled mechanism."""
    robot = assembly.mechanism
    kane = equations(robot)
    phi, dphi, ddphi = robot.phi, robot.speeds[3], kane.udot[3]
    free = [0, *(k for k in (1, 2) if SPEEDS[k] not in robot.held)]
    held = [k for k in (1, 2) if k not in free]
    still = ca.vertcat(robot.speeds[held], kane.udot[held])
    needed, joint, w, sides = (
        ca.substitute(part, still, ca.SX.zeros(2 * len(held)))
        for part in (kane.needed, kane.joint, kane.rate, robot.speeds[1:3])
    )
    u, udot = robot.speeds[free], kane.udot[free]
    unknown = ca.vertcat(udot, ddphi)
    inertia = ca.jacobian(needed[free], udot)
    resting = ca.substitute(needed[free], unknown, ca.SX.zeros(unknown.numel()))
    inverse = ca.inv_minor(inertia)
    f = -inverse @ resting
    g = -inverse @ ca.jacobian(needed[free], ddphi)

    slips = len(free) > 1
    held_speeds = ca.vertcat(*(ca.SX.sym(f"z_{SPEEDS[k]}") for k in free))
    speed = held_speeds if slips else held_speeds + g * dphi
    psi = robot.pose[2]
    cos, sin = ca.cos(psi), ca.sin(psi)
    pose_rate = ca.vertcat(cos * joint[0] - sin * joint[1], sin * joint[0] + cos * joint[1], w)
    onward = f + g * ddphi if slips else f - ca.jtimes(g, phi, dphi**2)
    torque = ca.substitute(needed[3], udot, f + g * ddphi)
    rates, shown, torque = (
        ca.cse(ca.substitute(part, u, speed))
        for part in (ca.vertcat(pose_rate, onward), ca.vertcat(robot.speeds[0], sides, w), torque)
    )
    seen = ca.vertcat(*(getattr(assembly.seen, name) for name in ("x", "y", "psi", "phi")))
    state, p = ca.vertcat(robot.pose, held_speeds), assembly.p
    drive = ca.vertcat(phi, dphi, ddphi) if slips else ca.vertcat(phi, dphi)
    given = ca.SX.sym("ddphi")
    names = ["state", "drive", "p"]
    return FloorMotion(
        effects=assembly.effects,
        free=tuple(SPEEDS[k] for k in free),
        parameters=assembly.parameters,
        rates=ca.Function("rates", [state, drive, p], [rates], names, ["rates"]),
        seen=ca.Function("seen", [state, drive, p], [seen], names, ["seen"]),
        speeds=ca.Function("speeds", [state, drive, p], [shown], names, ["speeds"]),
        torque=ca.Function(
            "torque",
            [state, drive, given, p],
            [ca.substitute(torque, ddphi, given)],
            ["state", "drive", "ddphi", "p"],
            ["torque"],
        ),
    )


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
