"""The robot in full coordinates q = (x, y, psi, phi) with Lagrange multipliers, by hand.

It shares nothing with `rr_opt.mechanics`. A point r of a platform is at P + R r and moves at
Pdot + rate R' r, so it has the Jacobian J = (1, R' r) and the acceleration J qdd - rate^2 R r. The
bodies, the wheels and both rows of the paper's equation (1) are such points; the servo is a third
constraint phi = phi(t). The multipliers of the three are the side forces of the axles and the
torque:

    M(q) qdd + bias(q, qd) = Q(q, qd) + A(q)' (F1, F2, torque)
    A(q) qdd = -Adot qd + (0, 0, ddphi)

A wheel that turns about its axle has an angle of its own, theta, with h dtheta = u. Its
equation J ddtheta = -h R gives the force R = -J/h^2 du/dt with which the floor's grip holds
back the platform along the rolling direction, and nothing across it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import simpson

from rr_opt.model.robot import Platform, Robot

Array = NDArray[np.float64]


class Wheel(NamedTuple):
    """Of platform 1 or 2, left (+1) or right (-1), at a place (2,) on the floor, m."""

    number: int
    side: int
    place: Array


Law = Callable[[Wheel, float], float]


@dataclass(frozen=True)
class Beyond:
    """What the paper's robot has not got.

    law    (wheel, u) -> force along a wheel that rolls at u, N; None: viscous
    J      moment of inertia of each wheel about its axle, kg m2
    left   of the axis lie the centres of mass, m;  toe, the axles are turned counter-clockwise, rad
    pull   on every mass, N/kg, along the floor's axes
    grip   (wheel, s) -> force across a wheel that slips sideways at s, N; None: it cannot slip
    loose  the servo holds nothing: phi is free
    bodies drag of both platforms in a medium, N s2/m2, shared as their faces
    """

    law: Law | None = None
    J: float = 0.0
    left: tuple[float, float] = (0.0, 0.0)
    toe: tuple[float, float] = (0.0, 0.0)
    pull: tuple[float, float] = (0.0, 0.0)
    grip: Law | None = None
    loose: bool = False
    bodies: float = 0.0


PAPER = Beyond()


class Point(NamedTuple):
    """A point's place (2,), Jacobian (2, 4), velocity (2,) and what is left of its acceleration
    (2,) at qdd = 0."""

    place: Array
    J: Array
    velocity: Array
    rest: Array


def turned(angle: float) -> Array:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def point(q: Array, qd: Array, number: int, r: tuple[float, float]) -> Point:
    """Of platform 1 or 2, r from P along its axis and to the left."""
    heading, rate = (q[2] + q[3], qd[2] + qd[3]) if number == 2 else (q[2], qd[2])
    arm = turned(heading) @ r
    swing = np.array([-arm[1], arm[0]])
    J = np.column_stack([np.eye(2), swing, swing if number == 2 else np.zeros(2)])
    return Point(q[:2] + arm, J, J @ qd, -(rate**2) * arm)


def axle(robot: Robot, q: Array, qd: Array, number: int, toe: float = 0.0):
    """Its centre, its rolling direction and the one to the left of it, and its yaw rate."""
    c = robot.platform1.c if number == 1 else -robot.platform2.c
    heading, rate = (q[2] + q[3], qd[2] + qd[3]) if number == 2 else (q[2], qd[2])
    along, across = turned(heading + toe).T
    return point(q, qd, number, (c, 0.0)), along, across, rate


def solve(
    robot: Robot, q: Array, qd: Array, ddphi: float, beyond: Beyond = PAPER
) -> tuple[Array, Array]:
    """(qdd, (F1, F2, torque)); the forces of what is not held are 0."""
    k = (robot.k1, robot.k2)
    law = beyond.law or (lambda wheel, u: -k[wheel.number - 1] * u)
    M, Q = np.zeros((4, 4)), np.zeros(4)
    M[2, 2] = robot.platform1.I + robot.platform2.I
    M[2, 3] = M[3, 2] = M[3, 3] = robot.platform2.I
    rows, needed = [], []
    for number, part in ((1, robot.platform1), (2, robot.platform2)):
        ahead = (1 if number == 1 else -1) * part.joint_to_centre
        mass = point(q, qd, number, (ahead, beyond.left[number - 1]))
        M += part.m * mass.J.T @ mass.J
        Q += part.m * mass.J.T @ (np.array(beyond.pull) - mass.rest)
        Q += dragged(robot, number, mass, qd, beyond.bodies)
        centre, along, across, rate = axle(robot, q, qd, number, beyond.toe[number - 1])
        for side in (1, -1):
            toe = beyond.toe[number - 1]
            c = part.c if number == 1 else -part.c
            r = (c - side * part.b * np.sin(toe), side * part.b * np.cos(toe))
            hub = point(q, qd, number, r)
            wheel = Wheel(number, side, hub.place)
            row = along @ hub.J
            Q += row * law(wheel, row @ qd)
            held = along @ hub.rest + rate * across @ hub.velocity
            M += beyond.J / robot.h**2 * np.outer(row, row)
            Q -= beyond.J / robot.h**2 * row * held
            if beyond.grip:
                Q += across @ hub.J * beyond.grip(wheel, float(across @ hub.velocity))
        if not beyond.grip:
            rows.append(across @ centre.J)
            needed.append(rate * along @ centre.velocity - across @ centre.rest)
    if not beyond.loose:
        rows.append(np.array([0.0, 0.0, 0.0, 1.0]))
        needed.append(ddphi)
    A = np.array(rows).reshape(-1, 4)
    n = len(A)
    system = np.block([[M, -A.T], [A, np.zeros((n, n))]])
    solution = np.linalg.solve(system, np.concatenate([Q, needed]))
    forces = np.zeros(3)
    forces[[*([] if beyond.grip else [0, 1]), *([] if beyond.loose else [2])]] = solution[4:]
    return solution[:4], forces


def half_length(part: Platform) -> float:
    """Of a cube with the platform's mass and moment of inertia, m (2/3) r^2."""
    return float(np.sqrt(1.5 * part.I / part.m))


def dragged(robot: Robot, number: int, mass: Point, qd: Array, k: float) -> Array:
    """The generalised force of a medium on a platform: at its centre of mass, and on strips of its
    four sides as it turns."""
    sizes = [half_length(part) for part in (robot.platform1, robot.platform2)]
    r = sizes[number - 1]
    k *= r**2 / (sizes[0] ** 2 + sizes[1] ** 2)
    Q = mass.J.T @ (-k * np.hypot(np.linalg.norm(mass.velocity), 1e-4) * mass.velocity)
    x = np.linspace(-r, r, 201)
    speed = x * (qd[2] + qd[3] if number == 2 else qd[2])
    moment = -2 * float(simpson(k / (2 * r) * np.abs(speed) * speed * x, x=x))
    return Q + moment * np.array([0.0, 0.0, 1.0, 1.0 if number == 2 else 0.0])


def slip(robot: Robot, q: Array, qd: Array) -> Array:
    """Side speeds of the axles: the left-hand sides of the paper's equation (1), m/s."""
    psi, th = q[2], q[2] + q[3]
    return np.array(
        [
            -np.sin(psi) * qd[0] + np.cos(psi) * qd[1] + robot.platform1.c * qd[2],
            -np.sin(th) * qd[0] + np.cos(th) * qd[1] - robot.platform2.c * (qd[2] + qd[3]),
        ]
    )


def rates(
    robot: Robot,
    q: Array,
    v: float,
    dphi: float,
    sides: tuple[float, float] = (0.0, 0.0),
    toe: tuple[float, float] = (0.0, 0.0),
) -> Array:
    """The qd at which axle 1 rolls at v, the axles slip at `sides` and the servo turns at dphi."""
    one, along, across, _ = axle(robot, q, np.zeros(4), 1, toe[0])
    two, _, across2, _ = axle(robot, q, np.zeros(4), 2, toe[1])
    rows = np.array([along @ one.J, across @ one.J, across2 @ two.J, [0.0, 0.0, 0.0, 1.0]])
    return np.linalg.solve(rows, np.array([v, *sides, dphi]))


def speed_rates(robot: Robot, q: Array, qd: Array, qdd: Array, beyond: Beyond = PAPER) -> Array:
    """d/dt of the speed of axle 1 along its rolling direction and of both side speeds, m/s2."""
    out = []
    for number, ways in ((1, (0, 1)), (2, (1,))):
        centre, along, across, rate = axle(robot, q, qd, number, beyond.toe[number - 1])
        acceleration = centre.J @ qdd + centre.rest
        turn = rate * np.array([across @ centre.velocity, -along @ centre.velocity])
        both = np.array([along @ acceleration, across @ acceleration]) + turn
        out += [both[way] for way in ways]
    return np.array(out)


def forward_acceleration(q: Array, qd: Array, qdd: Array) -> float:
    """d/dt of v = xdot cos psi + ydot sin psi, m/s2."""
    e1 = np.array([np.cos(q[2]), np.sin(q[2])])
    n1 = np.array([-np.sin(q[2]), np.cos(q[2])])
    return float(e1 @ qdd[:2] + qd[2] * n1 @ qd[:2])
