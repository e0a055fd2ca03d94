"""The paper's equations (3) and (4) with any signs, and the straight steady cycles they give.

    vdot = (A - C) v + s1 B1 + s2 B2 + sD D

Each letter stands for the expression printed under (3), except that epsilon, inside B2, has a sign
of its own. This module is apart from `rr_opt.motion` because it must evaluate the printed
equation, and because the audits and the calibration need thousands of robots at once: all
functions broadcast, and a `Robot` may hold arrays (see `stacked`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp

from rr_opt.array import Array
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Platform, Robot
from rr_opt.verify.fourier import integral, solve

_TIGHT = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-11}


@dataclass(frozen=True)
class Signs:
    """Signs of the terms of equation (3); `epsilon` stands inside the bracket of B2."""

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
    numerator = np.asarray(v) * np.sin(phi) + c2 * np.asarray(dphi)
    return -numerator / (c1 * np.cos(phi) + c2)


def stacked(robots: Sequence[Robot]) -> Robot:
    """G robots as one whose numbers are arrays (G,)."""

    def platform(of: Sequence[Platform]) -> Platform:
        columns: Any = [np.array([getattr(one, f.name) for one in of]) for f in fields(Platform)]
        return Platform(*columns)

    h: Any = np.array([robot.h for robot in robots])
    one, two = ([getattr(robot, name) for robot in robots] for name in ("platform1", "platform2"))
    return Robot(platform(one), platform(two), h)


class Angle(NamedTuple):
    """phi (rad), its rate (rad/s) and acceleration (rad/s2) over half a period, (n, G) each."""

    phi: Array
    rate: Array
    acceleration: Array


def sine(amplitude: Array, period: Array, n: int, first: float = 0.5) -> Angle:
    """A sine of amplitude (rad) and period (s), (G,), at n equal steps of half a period.

    first: where in the first step the first sample is taken.
    """
    theta = (np.arange(n)[:, None] + first) * np.pi / n
    omega = 2 * np.pi / period
    phi = amplitude * np.sin(theta)
    return Angle(phi, amplitude * omega * np.cos(theta), -(omega**2) * phi)


class Cycle(NamedTuple):
    """v (n, G), m/s, over half a period, after which v repeats itself and phi changes sign; and
    the mean speed (G,), m/s, signed along platform 1. NaN where no motion is steady."""

    v: Array
    speed: Array


def steady_cycle(
    robots: Robot | Sequence[Robot],
    amplitude: ArrayLike,
    period: ArrayLike,
    signs: Signs = CORRECTED,
    samples: int = 256,
) -> Cycle:
    """The steady cycles of straight sines by equations (3) and (4); all arguments broadcast.

    256 samples resolve v to rounding except next to the singular posture.
    """
    robot = robots if isinstance(robots, Robot) else stacked(robots)
    alpha, T = (np.atleast_1d(np.asarray(part, float)) for part in (amplitude, period))
    angle = sine(alpha, T, samples, first=0.0)
    v, damping = solve(*equation3(robot, *angle, signs), T / 2)
    speed = mean_speed(v, yaw_rate(robot, v, angle.phi, angle.rate), T)
    return Cycle(v, np.where(damping < 0, speed, np.nan))


def mean_speed(v: Array, w: Array, period: Array) -> Array:
    """The displacement of P over a period, over the period (section 3.1); (G,), m/s.

    v (m/s), w = psi-dot (rad/s): (n, G), over half a period (s, (G,)). P also moves at -c1 w
    across platform 1. That adds c1 times the integral of sin(chi) d chi, which is zero, as
    cos(chi) repeats after half a period.
    """
    chi = integral(w, period / 2, True)
    ahead = (np.cos(chi) * v).mean(axis=0)
    return np.copysign(ahead, ahead * np.cos(chi).mean(axis=0))


def path(robot: Robot, gait: SineGait, times: Array, signs: Signs) -> Array:
    """v (m/s), psi (rad), x, y (m) from rest at the times (s, increasing from 0), (4, n)."""
    c1 = robot.platform1.c

    def slope(t: float, state: Array) -> list[float]:
        v, psi = state[:2]
        phi, dphi, ddphi = (float(f(t)) for f in (gait.angle, gait.rate, gait.acceleration))
        along = equation3(robot, phi, dphi, ddphi, signs)
        w = float(yaw_rate(robot, v, phi, dphi))
        cos, sin = np.cos(psi), np.sin(psi)
        vdot = float(along.slope * v + along.drive)
        return [vdot, w, v * cos + c1 * w * sin, v * sin - c1 * w * cos]

    return solve_ivp(slope, times[[0, -1]], np.zeros(4), t_eval=times, **_TIGHT).y
