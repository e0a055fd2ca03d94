"""The paper's equations (3) and (4) as printed and with other signs, and the energy they keep.

The paper's equations (3) and (4) as printed, and with other signs.

    vdot = (A - C) v + s1 B1 + s2 B2 + sD D

Each letter stands for the expression that the paper prints under (3), but that epsilon, inside B2,
has a sign of its own too. Every function takes floats or arrays that broadcast.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp

from rr_opt.array import Array
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Robot
from rr_opt.verify.fourier import solve
from rr_paper import two_bodies

_TIGHT = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-11}
_SAMPLES = 512
"""Of a period; the steady speed is then exact to rounding short of the singular posture."""


@dataclass(frozen=True)
class Signs:
    """Signs of the terms of equation (3).

    B1, B2   before these terms
    epsilon  before epsilon c2 S1, inside the bracket of B2
    D        before D
    """

    name: str
    B1: int
    B2: int
    epsilon: int
    D: int


PRINTED = Signs("as printed", +1, +1, +1, -1)
REVERSED = Signs("as printed, v counted the other way", -1, -1, +1, +1)
CORRECTED = Signs("corrected", -1, -1, -1, +1)
VARIANTS = (
    PRINTED,
    REVERSED,
    Signs("only B1 as printed", +1, -1, -1, +1),
    Signs("only B2's sign as printed", -1, +1, -1, +1),
    Signs("only D as printed", -1, -1, -1, -1),
    CORRECTED,
)


class Linear(NamedTuple):
    """vdot = slope v + drive: slope in 1/s, drive in m/s2."""

    slope: Array
    drive: Array


def equation3(
    robot: Robot, phi: ArrayLike, dphi: ArrayLike, ddphi: ArrayLike, signs: Signs
) -> Linear:
    """Equation (3) at angles phi (rad) with their rates (rad/s, rad/s2); symbols as printed."""
    one, two = robot.platform1, robot.platform2
    m1, m2, k1, k2 = one.m, two.m, robot.k1, robot.k2
    c1, a1, b1, c2, a2, b2 = one.c, one.a, one.b, two.c, two.a, two.b
    phi, dphi, ddphi = (np.asarray(part, float) for part in (phi, dphi, ddphi))
    sin, cos = np.sin(phi), np.cos(phi)
    M, delta, epsilon = m1 + m2, c1 * a2 * m2 + c2 * a1 * m1, m1 * a1 + c1 * m2
    J1 = one.I + two.I + m1 * a1**2 + m2 * (a2**2 + c1**2 - c2**2)
    J2 = two.I - m2 * (c2**2 - a2**2)
    S1, S2 = c1 * cos + c2, c1 + c2 * cos
    Dn = J1 * sin**2 + M * S1**2

    A = -dphi * sin * (J1 * S2 + delta * S1) / (S1 * Dn)
    B1 = ddphi * sin * (J1 * c2 - J2 * S1) / Dn
    arms = c1 * delta * cos + signs.epsilon * epsilon * c2 * S1
    B2 = dphi**2 * (J1 * c1 * c2 * sin**2 - S1 * arms) / (S1 * Dn)
    C = 2 * ((b1**2 * k1 + b2**2 * k2) * sin**2 + k1 * S1**2 + k2 * S2**2) / Dn
    D = 2 * dphi * sin * (c1 * k2 * (b2**2 - c2**2) * cos - c2 * (b1**2 * k1 + c1**2 * k2)) / Dn
    return Linear(A - C, signs.B1 * B1 + signs.B2 * B2 + signs.D * D)


def yaw_rate(robot: Robot, v: ArrayLike, phi: ArrayLike, dphi: ArrayLike) -> Array:
    """psi-dot by equation (4), rad/s."""
    c1, c2 = robot.platform1.c, robot.platform2.c
    above = np.asarray(v) * np.sin(phi) + c2 * np.asarray(dphi)
    return -above / (c1 * np.cos(phi) + c2)


class Steady(NamedTuple):
    """A steady period at equal steps t (s), the last left out: v (m/s), psi (rad); and the mean
    speed, m/s, signed along platform 1."""

    t: Array
    v: Array
    psi: Array
    speed: float


def steady(robot: Robot, gait: SineGait, signs: Signs) -> Steady:
    """The steady motion of a straight gait, by equations (3) with these signs and (4).

    The speed is the displacement of P over a period, over T, as in the paper's section 3.1.
    """
    t = np.arange(_SAMPLES) * gait.period / _SAMPLES
    phi, dphi = gait.angle(t), gait.rate(t)
    slope, drive = equation3(robot, phi, dphi, gait.acceleration(t), signs)
    v = solve(slope[:, None], drive[:, None], np.array([gait.period]))[0][:, 0]
    w = yaw_rate(robot, v, phi, dphi)
    frequency = np.fft.rfftfreq(_SAMPLES, gait.period / _SAMPLES) * 2j * np.pi
    spectrum = np.fft.rfft(w)
    spectrum[0], spectrum[1:] = 0.0, spectrum[1:] / frequency[1:]
    psi = np.fft.irfft(spectrum, _SAMPLES)
    # P's side velocity -c1 w turns with psi into a whole derivative: over a period it adds nothing.
    velocity = v * np.array([np.cos(psi), np.sin(psi)])
    mean = velocity.mean(axis=1)
    ahead = mean @ np.array([np.cos(psi).mean(), np.sin(psi).mean()])
    return Steady(t, v, psi, float(np.copysign(np.hypot(*mean), ahead)))


def path(robot: Robot, gait: SineGait, times: Array, signs: Signs) -> Array:
    """v (m/s), psi (rad), x, y (m) from rest at the times (s, increasing from 0), (4, n)."""
    c1 = robot.platform1.c

    def slope(t: float, state: Array) -> list[float]:
        v, psi = state[:2]
        phi, dphi, ddphi = (float(f(t)) for f in (gait.angle, gait.rate, gait.acceleration))
        along = equation3(robot, phi, dphi, ddphi, signs)
        w = float(yaw_rate(robot, v, phi, dphi))
        cos, sin = np.cos(psi), np.sin(psi)
        return [
            float(along.slope * v + along.drive),
            w,
            v * cos + c1 * w * sin,
            v * sin - c1 * w * cos,
        ]

    return solve_ivp(slope, times[[0, -1]], np.zeros(4), t_eval=times, **_TIGHT).y


_CYCLE = 128
"""Instants of a period over which the energy is added up."""


@dataclass(frozen=True)
class Energy:
    """Mean powers over a steady period, W: what the servo gives, what friction takes, and what
    comes from nowhere; the largest force from nowhere, N; and the mean speed, m/s.

    Servo and nowhere add up to friction: `gap` is by how much they do not.
    """

    signs: Signs
    servo: float
    friction: float
    nowhere: float
    force: float
    speed: float

    @property
    def gap(self) -> float:
        """W."""
        return self.servo + self.nowhere - self.friction


def energy_of(robot: Robot, gait: SineGait, signs: Signs) -> Energy:
    """The energy of a steady straight gait that moves by these signs.

    A robot that moves so is pushed, along platform 1 at axle 1, by whatever force makes up the
    difference: the servo does no work on it there, nor does friction change.
    """
    cycle = steady(robot, gait, signs)
    powers = np.zeros((3, _CYCLE))
    largest = 0.0
    every = len(cycle.t) // _CYCLE
    for i, (t, v) in enumerate(zip(cycle.t[::every], cycle.v[::every], strict=True)):
        phi, dphi, ddphi = (float(f(t)) for f in (gait.angle, gait.rate, gait.acceleration))
        q, qd = two_bodies.placed(robot, phi, dphi, float(v))
        slope, drive = equation3(robot, phi, dphi, ddphi, signs)
        free, pushed = (
            two_bodies.forward_acceleration(
                q, qd, two_bodies.accelerate(robot, q, qd, ddphi, push).acceleration
            )
            for push in (0.0, 1.0)
        )
        force = float(slope * v + drive - free) / (pushed - free)
        torque = two_bodies.accelerate(robot, q, qd, ddphi, force).torque
        powers[:, i] = torque * dphi, -two_bodies.friction(robot, q, qd) @ qd, force * v
        largest = max(largest, abs(force))
    servo, taken, nowhere = powers.mean(axis=1).tolist()
    return Energy(signs, servo, taken, nowhere, largest, cycle.speed)
