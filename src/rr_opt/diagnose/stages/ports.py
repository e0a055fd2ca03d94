"""Where a fault can push the no-slip robot, as functions evaluated over whole runs at once.

The side speeds s1, s2 move P and turn platform 1; a force along a platform's axis at its axle, or a
moment on a platform, accelerates v through its partial velocity. Everything is CasADi's derivative
of `physics.kinematics` and `physics.kane`; no formula is written down twice.
"""

from __future__ import annotations

from functools import lru_cache

import casadi as ca

from rr_opt.physics.arrays import ArrayFunction, over_arrays
from rr_opt.physics.floor_motion import FloorMotion, floor_motion
from rr_opt.physics.kane import Equations, equations
from rr_opt.physics.kinematics import ROBOT_PARAMETERS, Mechanism, mechanism, rotated

SHAPES = (
    "quadratic_drag",
    "left_right_drag",
    "wheel_inertia",
    "axle_misalignment",
    "floor_tilt",
    "com_offset",
)
"""Effects of the catalogue whose derivatives serve as shapes; all vanish smoothly."""

NAMES = (
    *("x_by_s1", "y_by_s1", "psi_by_s1", "x_by_s2", "y_by_s2", "psi_by_s2"),
    *("v", "u2", "w", "by_force1", "by_force2", "by_moment", "side1", "side2"),
)
"""What `ports` returns: pose rates by side speed; speeds of both axles along their platforms (m/s)
and psi-dot; v-dot by a force along each axle (1/kg) and by a moment (1/(kg m)); and the side forces
(N) that hold the axles."""


@lru_cache
def ports() -> ArrayFunction:
    """(psi, phi, z, dphi, ddphi, *robot parameters) -> NAMES."""
    robot = mechanism()
    kane = equations(robot)
    frame, u, udot = robot.frames[1], robot.speeds, kane.udot
    joint = rotated(frame.velocity(robot.joint(1)), robot.pose[2])
    moved = ca.jacobian(ca.vertcat(joint, frame.rate), u[1:3])
    held = ca.vertcat(u[1:3], udot[1:3])
    u2, w = robot.frames[2].origin[0], frame.rate
    along = ca.vertcat(1, ca.jacobian(u2, u[0]), ca.jacobian(w, u[0]))
    parts = ca.vertcat(moved[:, 0], moved[:, 1], u[0], u2, w, along, kane.needed)
    inertia = ca.jacobian(kane.needed[0], udot[0])
    resting = ca.substitute(kane.needed[0], udot[0], 0)
    parts = ca.substitute(parts, udot[0], -resting / inertia)
    z, dphi, ddphi = ca.SX.sym("z"), ca.SX.sym("dphi"), ca.SX.sym("ddphi")
    everything = ca.substitute(ca.vertcat(parts, inertia), held, ca.SX.zeros(4))
    speeds = ca.vertcat(z + _swing(robot, kane) * dphi, dphi, ddphi)
    out = ca.substitute(everything, ca.vertcat(u[0], u[3], udot[3]), speeds)
    mass = out[16]
    shown = ca.vertcat(out[:9], out[9:12] / mass, out[13:15])
    p = ca.vertcat(*(robot.parameters[name] for name in ROBOT_PARAMETERS))
    inputs = [robot.pose[2], robot.phi, z, dphi, ddphi, p]
    return over_arrays(ca.Function("ports", inputs, [ca.cse(ca.densify(shown))]))


@lru_cache
def swing() -> ArrayFunction:
    """(phi, *robot parameters) -> v by dphi at a fixed z, m."""
    robot = mechanism()
    p = ca.vertcat(*(robot.parameters[name] for name in ROBOT_PARAMETERS))
    g = ca.cse(ca.densify(_swing(robot, equations(robot))))
    return over_arrays(ca.Function("swing", [robot.phi, p], [g]))


def _swing(robot: Mechanism, kane: Equations) -> ca.SX:
    udot = kane.udot
    balance = kane.needed[0]
    g = -ca.jacobian(balance, udot[3]) / ca.jacobian(balance, udot[0])
    held = ca.vertcat(robot.speeds[1:3], udot[1:3])
    return ca.substitute(g, held, ca.SX.zeros(4))


@lru_cache
def linearised() -> tuple[FloorMotion, ArrayFunction, ArrayFunction]:
    """The motion with SHAPES, its rates, and their Jacobian by state, drive and p, by column."""
    motion = floor_motion(SHAPES)
    inputs = motion.rates.sx_in()
    by = ca.densify(ca.jacobian(motion.rates(*inputs), ca.vertcat(*inputs)))
    jacobian = ca.Function("rates_by", inputs, [ca.cse(by)])
    return motion, over_arrays(motion.rates), over_arrays(jacobian)
