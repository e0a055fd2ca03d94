"""The motion on the floor with every kind of effect, where place, heading and side slip count.

`dynamics` is for steady cycles, where they do not. Here P is at (x, y), the heading is psi, and the
speeds u = (v), or (v, s1, s2) where an effect lets the axles slip, obey

    udot = f(u, phi, dphi, place) + g(phi) ddphi

A servo that starts, stops or hits something jumps in dphi, where ddphi is not defined. So the state
holds z = u - g dphi instead of u, which does not need ddphi and does not jump:

    zdot = f - (dg/dphi) dphi^2,        u = z + g dphi

Axles that may slip stop slipping within milliseconds. They come to rest at s = 0 and not at some z,
so there the state holds u itself, and the drive provides the mean of ddphi over a step.

While the servo exerts no torque phi is free, and the joint obeys

    torque(phi, dphi, z, ddphi) = 0,        zdot = f - (dg/dphi) dphi^2

of which the first is affine in ddphi. An impact on the joint changes dphi at once and z not at all.
"""

from collections.abc import Callable, Iterable, Mapping
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

    free      names of the speeds in the state
    rates     (state, drive, p) -> d(state)/dt
    observed  (state, drive, p) -> x, y, psi, phi as a capture system records them (4,)
    speeds    (state, drive, p) -> v, s1, s2 (m/s): of axle 1, and side speeds; psi-dot (rad/s)
    torque    (state, drive, ddphi, p) -> servo torque, N m; ddphi is an input of its own
    """

    effects: tuple[str, ...]
    free: tuple[str, ...]
    parameters: tuple[str, ...]
    rates: ca.Function
    observed: ca.Function
    speeds: ca.Function
    torque: ca.Function

    @property
    def size(self) -> int:
        """Length of the state."""
        return len(POSE) + len(self.free)

    @property
    def slips(self) -> bool:
        """Whether the axles may slip sideways, which makes the motion stiff."""
        return len(self.free) > 1


@lru_cache
def floor_motion(effects: tuple[str, ...] = ()) -> FloorMotion:
    """The motion with the named effects, for predictions; those of the servo are in the drive."""
    return solved(assembled(effects, for_prediction=True))


def solved(assembly: Assembly) -> FloorMotion:
    """The motion of an assembled mechanism."""
    robot = assembly.mechanism
    kane = equations(robot)
    phi, dphi, ddphi = robot.phi, robot.speeds[3], kane.udot[3]
    free = [0, *(k for k in (1, 2) if SPEEDS[k] not in robot.constrained)]
    fixed = [k for k in (1, 2) if k not in free]
    u, udot = robot.speeds[free], kane.udot[free]
    held, none = robot.speeds[fixed], ca.SX.zeros(len(fixed))
    inverse = ca.inv_minor(ca.jacobian(kane.needed[free], udot))
    g, moved = (-inverse @ ca.jacobian(kane.needed[free], by) for by in (ddphi, kane.udot[fixed]))
    needed = ca.substitute(kane.needed, kane.udot[fixed], none)
    unknown = ca.vertcat(udot, ddphi)
    f = -inverse @ ca.substitute(needed[free], unknown, ca.SX.zeros(unknown.numel()))

    slips = len(free) > 1
    z = ca.vertcat(*(ca.SX.sym(f"z_{SPEEDS[k]}") for k in free))
    pushed = g * dphi + moved @ held
    speed = z if slips else z + pushed
    psi = robot.pose[2]
    cos, sin = ca.cos(psi), ca.sin(psi)
    joint, w = kane.joint, kane.rate
    pose_rate = ca.vertcat(cos * joint[0] - sin * joint[1], sin * joint[0] + cos * joint[1], w)
    slope = f + g * ddphi if slips else f - ca.jtimes(pushed, phi, dphi)
    loads = ca.substitute(needed, udot, f + g * ddphi)
    sides = none
    if robot.creep is not None:
        holding = ca.substitute(loads[fixed], ca.vertcat(u, held), ca.vertcat(z + g * dphi, none))
        sides = -robot.creep / 2 * holding
    rates, shown, torque = (
        ca.cse(ca.substitute(ca.substitute(part, u, speed), held, sides))
        for part in (ca.vertcat(pose_rate, slope), ca.vertcat(robot.speeds[:3], w), loads[3])
    )
    seen = assembly.observation
    state, p = ca.vertcat(robot.pose, z), assembly.p
    accelerated = slips or robot.creep is not None
    drive = ca.vertcat(phi, dphi, ddphi) if accelerated else ca.vertcat(phi, dphi)
    given = ca.SX.sym("ddphi")
    torque = ca.substitute(torque, ddphi, given)
    inputs = {"state": state, "drive": drive, "p": p}
    loaded = {"state": state, "drive": drive, "ddphi": given, "p": p}

    def function(name: str, output: ca.SX, inputs: Mapping[str, ca.SX] = inputs) -> ca.Function:
        return ca.Function(name, [*inputs.values()], [output], [*inputs], [name])

    return FloorMotion(
        effects=assembly.effects,
        free=tuple(SPEEDS[k] for k in free),
        parameters=assembly.parameters,
        rates=function("rates", rates),
        observed=function("seen", ca.vertcat(seen.x, seen.y, seen.psi, seen.phi)),
        speeds=function("speeds", shown),
        torque=function("torque", torque, loaded),
    )


def free_joint(robot: Robot) -> FreeJoint:
    """The joint of a robot with nothing but the paper's friction."""
    return free_joint_of(lambda parameters: values_of(robot, parameters))


def free_joint_of(values: Callable[[tuple[str, ...]], Iterable[float]]) -> FreeJoint:
    """The same for a robot given by the values of its parameters, SI."""
    return FreeJoint(_swing(), tuple(values(floor_motion().parameters)))


@lru_cache
def _swing() -> ca.Function:
    motion = floor_motion()
    phi, dphi, z, ddphi = (ca.SX.sym(name) for name in ("phi", "dphi", "z", "ddphi"))
    p = ca.SX.sym("p", len(motion.parameters))
    state, drive = ca.vertcat(ca.SX.zeros(len(POSE)), z), ca.vertcat(phi, dphi)
    torque = motion.torque(state, drive, ddphi, p)
    mobility = 1 / ca.jacobian(torque, ddphi)
    free = -ca.substitute(torque, ddphi, ca.SX(0)) * mobility
    zdot = motion.rates(state, drive, p)[len(POSE)]
    out = ca.vertsplit(ca.cse(ca.vertcat(free, zdot, mobility)))
    return ca.Function("swing", [phi, dphi, z, p], out)
