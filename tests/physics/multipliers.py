"""The robot in full coordinates q = (x, y, psi, phi) with Lagrange multipliers, by hand.

It shares nothing with `rr_opt.physics`: the mass matrix of the two bodies is written out, both
rows of the paper's equation (1) are differentiated by hand, and the servo is a third constraint
phi = phi(t). The multipliers of the three are the side forces of the axles and the torque:

    M(q) qdd + bias(q, qd) = Q(q, qd) + A(q)' (F1, F2, torque)
    A(q) qdd = -Adot qd + (0, 0, ddphi)

A wheel that turns about its axle has an angle of its own, theta, with h dtheta = u. Its
equation J ddtheta = -h R gives the force R = -J/h^2 du/dt with which the floor's grip holds
back the platform along the rolling direction, and nothing across it.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from rr_opt.robot.parameters import Robot

Array = NDArray[np.float64]
Law = Callable[[int, float], float]


def solve(
    robot: Robot, q: Array, qd: Array, ddphi: float, *, law: Law | None = None, J: float = 0.0
) -> tuple[Array, Array]:
    """(qdd, (F1, F2, torque)).

    law(platform, u)  force along a wheel that rolls at u, N; absent: viscous
    J                 moment of inertia of each wheel about its axle, kg m2
    """
    one, two = robot.platform1, robot.platform2
    law = law or (lambda number, u: -(one.kappa, two.kappa)[number - 1] / robot.h**2 * u)
    psi, th = q[2], q[2] + q[3]
    dpsi, dth = qd[2], qd[2] + qd[3]
    e1, n1 = np.array([np.cos(psi), np.sin(psi)]), np.array([-np.sin(psi), np.cos(psi)])
    e2, n2 = np.array([np.cos(th), np.sin(th)]), np.array([-np.sin(th), np.cos(th)])

    g1, g2 = one.c - one.a, two.c - two.a
    J1, J2 = one.I + one.m * g1**2, two.I + two.m * g2**2
    M = np.zeros((4, 4))
    M[:2, :2] = (one.m + two.m) * np.eye(2)
    M[:2, 2] = M[2, :2] = one.m * g1 * n1 - two.m * g2 * n2
    M[:2, 3] = M[3, :2] = -two.m * g2 * n2
    M[2, 2] = J1 + J2
    M[2, 3] = M[3, 2] = M[3, 3] = J2
    bias = np.zeros(4)
    bias[:2] = -one.m * g1 * dpsi**2 * e1 + two.m * g2 * dth**2 * e2

    Q = np.zeros(4)
    for number, e, n, rate, b in ((1, e1, n1, dpsi, one.b), (2, e2, n2, dth, two.b)):
        for side in (1, -1):
            turn = -side * b
            row = np.array([*e, turn, turn if number == 2 else 0.0])  # u = row @ qd
            Q += row * law(number, row @ qd)
            M += J / robot.h**2 * np.outer(row, row)
            bias += J / robot.h**2 * row * (rate * n @ qd[:2])

    A = np.array([[*n1, one.c, 0.0], [*n2, -two.c, -two.c], [0.0, 0.0, 0.0, 1.0]])
    needed = np.array([dpsi * e1 @ qd[:2], dth * e2 @ qd[:2], ddphi])
    system = np.block([[M, -A.T], [A, np.zeros((3, 3))]])
    solution = np.linalg.solve(system, np.concatenate([Q - bias, needed]))
    return solution[:4], solution[4:]


def slip(robot: Robot, q: Array, qd: Array) -> Array:
    """Side speeds of the axles: the left-hand sides of the paper's equation (1), m/s."""
    psi, th = q[2], q[2] + q[3]
    return np.array(
        [
            -np.sin(psi) * qd[0] + np.cos(psi) * qd[1] + robot.platform1.c * qd[2],
            -np.sin(th) * qd[0] + np.cos(th) * qd[1] - robot.platform2.c * (qd[2] + qd[3]),
        ]
    )


def rates(robot: Robot, q: Array, v: float, dphi: float) -> Array:
    """The qd without side slip at forward speed v and servo rate dphi."""
    psi, th = q[2], q[2] + q[3]
    c1, c2 = robot.platform1.c, robot.platform2.c
    rows = np.array(
        [
            [np.cos(psi), np.sin(psi), 0.0, 0.0],
            [-np.sin(psi), np.cos(psi), c1, 0.0],
            [-np.sin(th), np.cos(th), -c2, -c2],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )
    return np.linalg.solve(rows, np.array([v, 0.0, 0.0, dphi]))


def forward_acceleration(q: Array, qd: Array, qdd: Array) -> float:
    """d/dt of v = xdot cos psi + ydot sin psi, m/s2."""
    e1 = np.array([np.cos(q[2]), np.sin(q[2])])
    n1 = np.array([-np.sin(q[2]), np.cos(q[2])])
    return float(e1 @ qdd[:2] + qd[2] * n1 @ qd[:2])
