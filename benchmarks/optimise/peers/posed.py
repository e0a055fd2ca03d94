"""A problem as someone without this project has it: numbers, and equations on a sheet of paper.

Only what every alternative can be told is posed: bounds of amplitude, period, offset and of
platform 2's inertia, and limits on rate, angle and torque. (The margin to the singular posture
bounds the angle.) So direction `either` and a ratio by inertia.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.optimise.problems import PROBLEMS
from benchmarks.optimise.space import Box, largest_posture
from rr_opt.model.problem import Problem
from rr_opt.model.robot import Robot

Array = NDArray[np.float64]
Function = Callable[[Any], Any]

NAMES = ("amplitude", "period", "offset", "inertia")


@dataclass(frozen=True)
class Posed:
    """The problem in numbers, SI.

    robot        its inertia I2 is one of the unknowns
    least, most  bounds of NAMES, the last being I2 (kg m2)
    rate, reach, torque   largest |dphi/dt|, |phi| and |torque|
    """

    name: str
    problem: Problem
    robot: Robot
    least: Array
    most: Array
    rate: float
    reach: float
    torque: float

    def starts(self, count: int, seed: int) -> Array:
        """Random gaits (count, 4) of NAMES within the bounds and the limits but for the torque."""
        box = Box(self.problem)
        points = np.random.default_rng(seed).uniform(box.low, box.high, (count, len(box.free)))
        gaits = box.gaits(points)[0].T.copy()
        gaits[:, 3] = self.inertia(gaits[:, 3])
        return gaits

    def inertia(self, ratio: Any) -> Any:
        """I2 that makes a ratio J20/J10, in the problem's definition."""
        choice, one, two = self.problem.inertia_ratio, self.robot.platform1, self.robot.platform2
        if choice is None:
            return np.full_like(ratio, two.I)
        if choice.about == "centre":
            return ratio * one.I
        return ratio * one.joint_inertia - two.m * two.joint_to_centre**2


@dataclass(frozen=True)
class Claim:
    """What an alternative says: a gait, I2 (kg m2), its speed (m/s, of either sign), and whether
    its solver calls it an optimum."""

    amplitude: float
    period: float
    offset: float
    inertia: float
    speed: float
    solved: bool

    @classmethod
    def of(cls, gait: Iterable[float], speed: float, solved: bool) -> Claim:
        """Of a gait in the order of NAMES."""
        amplitude, period, offset, inertia = (float(number) for number in gait)
        return cls(amplitude, period, offset, inertia, float(speed), solved)


def posed(problem: Problem, name: str = "") -> Posed:
    """The numbers of a problem.

    Raises ValueError for one that not every alternative can be told.
    """
    choice = problem.inertia_ratio
    if problem.direction != "either" or problem.turn or (choice and choice.by != "inertia"):
        raise ValueError("Only problems of either direction, without loads and turns, are posed.")
    gait, limits, robot = problem.gait, problem.limits, problem.robot
    bounds = [gait.amplitude, gait.period, gait.offset]
    least, most = (np.array([*(getattr(b, end) for b in bounds), 0.0]) for end in ("low", "high"))
    reach = largest_posture(problem)
    stated = Posed(name, problem, robot, least, most, limits.rate, reach, limits.torque)
    for end, of in ((least, "low"), (most, "high")):
        end[3] = stated.inertia(np.float64(getattr(choice.bounds, of) if choice else 0.0))
    return stated


def eligible() -> list[str]:
    """The benchmark's problems that every alternative can be told."""
    names = []
    for name, problem in PROBLEMS.items():
        try:
            posed(problem)
        except ValueError:
            continue
        names.append(name)
    return names


def motion(
    robot: Robot, inertia: Any, v: Any, angle: tuple[Any, Any, Any], sin: Function, cos: Function
) -> tuple[Any, Any, Any, Any]:
    """vdot, psi-dot, velocity of P to the left of platform 1, torque; as `fourier_numpy` has them.

    angle is phi and its first two derivatives in time; numbers, arrays or symbols alike.
    """
    p1, p2 = robot.platform1, robot.platform2
    m1, c1, m2, c2 = p1.m, p1.c, p2.m, p2.c
    J1, J2 = p1.I + m1 * p1.a**2, inertia + m2 * p2.a**2
    drag1, drag2 = 2 * robot.k1 * p1.b**2, 2 * robot.k2 * p2.b**2
    phi, q, dq = angle
    s, c = sin(phi), cos(phi)
    S1, S2 = c1 * c + c2, c1 + c2 * c
    arm = c1 * c2 * s * q
    lever = c1**2 - c2**2
    j = J1 + J2 + m2 * lever
    g = (m1 + m2) * S1**2 + j * s**2
    slope = (
        q * s * (j * S2 / S1 + m1 * p1.a * c2 + m2 * p2.a * c1)
        + (drag1 + drag2 + 2 * robot.k2 * lever) * s**2
        + 2 * (robot.k1 + robot.k2) * S1**2
    )
    push = (
        dq * s * (J1 * c2 - J2 * c1 * c + m2 * c1 * c2 * S2)
        + q**2 * (c1 * c2 * (j * s**2 / S1 + m2 * S1) + m1 * p1.a * c2**2 - m2 * p2.a * c1**2 * c)
        + q * s * (drag1 * c2 - drag2 * c1 * c + 2 * robot.k2 * c1 * c2 * S2)
    )
    vdot = -(slope * v + push) / g
    w = -(s * v + c2 * q) / S1
    u2 = (S2 * v + arm) / S1
    dw = -(s * vdot + c2 * dq + q * u2) / S1
    du2 = (S2 * vdot + c1 * c2 * s * dq + q / S1 * (lever * s * v + c1 * c2 * S2 * q)) / S1
    w2 = w + q
    torque = (
        c1 * c * (J2 * (dw + dq) + drag2 * w2)
        - c2 * (J1 * dw + drag1 * w)
        + c1 * c2 * s * (m2 * du2 + 2 * robot.k2 * u2)
        + v * (m1 * p1.a * c2 * w + m2 * p2.a * c1 * w2)
    ) / S1
    return vdot, w, -c1 * w, torque


def sine(amplitude: Any, period: Any, offset: Any, theta: Any, sin: Function, cos: Function) -> Any:
    """phi and its first two derivatives in time at phase theta in [0, 1]."""
    omega, turn = 2 * np.pi / period, 2 * np.pi * theta
    swing = amplitude * sin(turn)
    return swing + offset, omega * amplitude * cos(turn), -(omega**2) * swing
