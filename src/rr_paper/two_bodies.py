"""The robot as two separate bodies, coupled by Lagrange multipliers.

Each body has its own position and heading, q = (x1, y1, th1, x2, y2, th2) of the centres of mass
A1 and A2, so the mass matrix is diagonal. There are five constraints: both bodies share the joint
P (two rows), no axle slips sideways (one row each), and the servo imposes th2 - th1 = phi(t):

    A1 - (c1 - a1) e1 = P = A2 + (c2 - a2) e2        n1 . V1 + a1 w1 = 0 = n2 . V2 - a2 w2

They are differentiated down to accelerations (index 1), which `path` integrates. This is an
independent check of Kane's method and of equation (3): it uses only the paper's equation (1) and
nothing of `rr_opt.mechanics`.
"""

from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from rr_opt.array import Array
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot


class Accelerations(NamedTuple):
    """qdd (6,) of the bodies, and the servo's torque on body 2, N m."""

    acceleration: Array
    torque: float


def accelerate(robot: Robot, q: Array, qd: Array, ddphi: float, push: float = 0.0) -> Accelerations:
    """The Newton-Euler equations of both bodies with the constraints' second derivatives.

    push: an external force at axle 1 along platform 1, N.
    """
    one, two = robot.platform1, robot.platform2
    e1, e2 = axes(q[2])[0], axes(q[5])[0]
    V1, w1, V2, w2 = qd[:2], qd[2], qd[3:5], qd[5]
    g1, g2 = one.c - one.a, two.c - two.a

    G = constraints(robot, q)
    # Minus the acceleration-free terms of the second derivatives.
    rest = np.concatenate(
        [-g1 * w1**2 * e1 - g2 * w2**2 * e2, [w1 * (e1 @ V1), w2 * (e2 @ V2), ddphi]]
    )
    Q = friction(robot, q, qd)
    Q[:2] += push * e1  # The line of action passes through the centre of mass.
    M = np.diag([one.m, one.m, one.I, two.m, two.m, two.I])
    system = np.block([[M, -G.T], [G, np.zeros((5, 5))]])
    solved = np.linalg.solve(system, np.concatenate([Q, rest]))
    return Accelerations(np.asarray(solved[:6], float), float(solved[10]))


def placed(robot: Robot, phi: float, dphi: float, v: float) -> tuple[Array, Array]:
    """q and qd satisfying the constraints, P at the origin, psi = 0 and axle 1 rolling at v."""
    one, two = robot.platform1, robot.platform2
    e2 = axes(phi)[0]
    q = np.array([one.c - one.a, 0.0, 0.0, *(-(two.c - two.a) * e2), phi])
    rows = np.vstack([constraints(robot, q), [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]])
    return q, np.linalg.solve(rows, np.array([0.0, 0.0, 0.0, 0.0, dphi, v]))


def forward_acceleration(q: Array, qd: Array, acceleration: Array) -> float:
    """d/dt of e1 . V1, which is the speed of axle 1 along platform 1, m/s2."""
    e1, n1 = axes(q[2])
    return float(e1 @ acceleration[:2] + qd[2] * (n1 @ qd[:2]))


def friction(robot: Robot, q: Array, qd: Array) -> Array:
    """Forces (N) and moments (N m) of the wheels' friction on both bodies, (6,).

    Minus its product with qd is the dissipated power, the paper's 2R, W.
    """
    one, two = robot.platform1, robot.platform2
    return np.concatenate(
        [
            _friction(one.b, robot.k1, one.a, qd[:2], qd[2], axes(q[2])),
            _friction(two.b, robot.k2, -two.a, qd[3:5], qd[5], axes(q[5])),
        ]
    )


def constraints(robot: Robot, q: Array) -> Array:
    """The constraint rows on qd: the joint's (2), the axles' (2), the servo's; (5, 6)."""
    one, two = robot.platform1, robot.platform2
    n1, n2 = axes(q[2])[1], axes(q[5])[1]
    g1, g2 = one.c - one.a, two.c - two.a
    rows = np.zeros((5, 6))
    rows[:2, :2], rows[:2, 2] = np.eye(2), -g1 * n1
    rows[:2, 3:5], rows[:2, 5] = -np.eye(2), -g2 * n2
    rows[2, :2], rows[2, 2] = n1, one.a
    rows[3, 3:5], rows[3, 5] = n2, -two.a
    rows[4, 2], rows[4, 5] = -1.0, 1.0
    return rows


def _friction(
    b: float, k: float, axle: float, V: Array, w: float, axes: tuple[Array, Array]
) -> Array:
    """Force (2, N) and moment about the centre of mass (N m) on the two wheels of a body, each
    braked by k times its rolling speed. axle: its distance from the centre of mass along e, m."""
    e, n = axes
    total = np.zeros(3)
    for place in (b, -b):
        arm = axle * e + place * n
        force = -k * (e @ (V + w * np.array([-arm[1], arm[0]]))) * e
        total += [*force, arm[0] * force[1] - arm[1] * force[0]]
    return total


def axes(angle: float | Array) -> tuple[Array, Array]:
    """The axis at an angle, and the one to its left."""
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array([cos, sin]), np.array([-sin, cos])


TIGHT = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-11}
"""Settings of an accurate integration."""


class Path(NamedTuple):
    """A motion at times t (s): x, y of P (m), psi (rad), v (m/s, along platform 1); and the largest
    drift of the constraints: m (joint), m/s (axles) or rad (servo)."""

    t: Array
    x: Array
    y: Array
    psi: Array
    v: Array
    drift: float


def path(robot: Robot, gait: Gait, times: Array) -> Path:
    """The motion from v = 0 at the times (s, increasing from 0)."""
    q, qd = placed(robot, float(gait.angle(0.0)), float(gait.rate(0.0)), 0.0)

    def slope(t: float, state: Array) -> Array:
        ddphi = float(gait.acceleration(t))
        qdd = accelerate(robot, state[:6], state[6:], ddphi).acceleration
        return np.concatenate([state[6:], qdd])

    start = np.concatenate([q, qd])
    states = solve_ivp(slope, times[[0, -1]], start, t_eval=times, **TIGHT).y
    one, two = robot.platform1, robot.platform2
    (e1, _), (e2, _) = axes(states[2]), axes(states[5])
    joint = states[:2] - (one.c - one.a) * e1
    drift = [
        np.abs(joint - states[3:5] - (two.c - two.a) * e2).max(),
        np.abs(states[5] - states[2] - gait.angle(times)).max(),
        max(np.abs(constraints(robot, q) @ qd)[2:4].max() for q, qd in
            zip(states[:6].T, states[6:].T, strict=True)),
    ]  # fmt: skip
    v = (e1 * states[6:8]).sum(axis=0)
    return Path(times, joint[0], joint[1], states[2], v, float(max(drift)))
