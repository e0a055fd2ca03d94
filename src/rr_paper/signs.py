"""The paper's equations (3) and (4) with any signs, and the straight steady cycles they give.

    vdot = (A - C) v + s1 B1 + s2 B2 + sD D

Each letter stands for the expression printed under (3), except that epsilon, inside B2, has a sign
of its own. This module is separate from `rr_opt.motion` because it must evaluate the printed
equation, and because the audits and the calibration need thousands of robots at once: all functions
broadcast, and a `Robot` may hold arrays (see `stacked`).
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp

from rr_opt.array import Array
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Platform, Robot
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.motion.rollout import rollout
from rr_opt.verify.fourier import integral, solve
from rr_paper import two_bodies


@dataclass(frozen=True)
class Signs:
    """Signs of the terms of equation (3); `epsilon` is inside the bracket of B2."""

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


class SpeedEquation(NamedTuple):
    """vdot = slope v + drive: slope in 1/s, drive in m/s2."""

    slope: Array
    drive: Array


def equation3(
    robot: Robot, phi: ArrayLike, dphi: ArrayLike, ddphi: ArrayLike, signs: Signs
) -> SpeedEquation:
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
    return SpeedEquation(A - C, signs.B1 * B1 + signs.B2 * B2 + signs.D * D)


def yaw_rate(robot: Robot, v: ArrayLike, phi: ArrayLike, dphi: ArrayLike) -> Array:
    """psi-dot by equation (4), rad/s."""
    c1, c2 = robot.platform1.c, robot.platform2.c
    numerator = np.asarray(v) * np.sin(phi) + c2 * np.asarray(dphi)
    return -numerator / (c1 * np.cos(phi) + c2)


def stacked(robots: Sequence[Robot]) -> Robot:
    """G robots as a single one with arrays of values (G,)."""

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

    first: position of the first sample within the first step.
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
    v, damping, _ = solve(*equation3(robot, *angle, signs), T / 2)
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

    return solve_ivp(slope, times[[0, -1]], np.zeros(4), t_eval=times, **two_bodies.TIGHT).y


_STATES, _SEED = 200, 7
_RATE = 20.0
_SAMPLES = 64
"""Instants per half period over which the energy is averaged."""


@dataclass(frozen=True)
class Deviation:
    """Deviation of signs from mechanics over random states of random robots: |difference of vdot|
    over the size of both and of the terms. The largest from each derivation; the median from Kane.
    """

    signs: Signs
    kane: float
    multipliers: float
    median: float


@dataclass(frozen=True)
class Comparison:
    """One motion from rest in several ways, at the same times t, s.

    v         m/s of axle 1, by the name of the signs, and for `Kane` and `multipliers`
    distance  largest distance of P from Kane's path, m: of the multipliers, of the corrected
              signs and of the printed signs
    drift     of the multipliers' constraints: m, m/s or rad
    """

    gait: SineGait
    t: Array
    v: dict[str, Array]
    distance: tuple[float, float, float]
    drift: float


@dataclass(frozen=True)
class Energy:
    """Mean powers over a steady period, W: supplied by the servo, dissipated by friction, and
    supplied by the fictitious force that the signs need; the peak of that force, N; and the mean
    speed, m/s."""

    signs: Signs
    servo: float
    friction: float
    fictitious: float
    force: float
    speed: float

    @property
    def gap(self) -> float:
        """Excess of the supplied power over the dissipated one, W; 0 but for rounding."""
        return self.servo + self.fictitious - self.friction


@dataclass(frozen=True)
class SignAudit:
    """The audit of the signs; torque: largest relative difference of the servo's torque between
    Kane and the multipliers over the random states."""

    deviations: tuple[Deviation, ...]
    states: int
    torque: float
    comparison: Comparison
    energy: tuple[Energy, ...]


def audit_signs(robot: Robot, gait: SineGait, seconds: float) -> SignAudit:
    """Check the signs at random states, over `seconds` of a gait from rest, and by its energy."""
    deviations, torque = _deviations()
    energy = tuple(energy_of(robot, gait, signs) for signs in (PRINTED, REVERSED, CORRECTED))
    return SignAudit(deviations, _STATES, torque, _comparison(robot, gait, seconds), energy)


def _deviations() -> tuple[tuple[Deviation, ...], float]:
    rng = np.random.default_rng(_SEED)
    kane, multipliers = (np.zeros((_STATES, len(VARIANTS))) for _ in range(2))
    torque = 0.0
    for i in range(_STATES):
        robot = _random_robot(rng)
        v, dphi, ddphi = rng.uniform(-1, 1, 3) * (0.6, 6.0, 40.0)
        phi = 0.9 * robot.singular_angle * rng.uniform(-1, 1)
        dynamics = dynamics_of(robot)
        first = [float(o) for o in dynamics.motion(v, phi, dphi, ddphi, dynamics.values(robot))]
        q, qd = two_bodies.placed(robot, phi, dphi, v)
        solved = two_bodies.accelerate(robot, q, qd, ddphi)
        second = two_bodies.forward_acceleration(q, qd, solved.acceleration)
        torque = max(torque, abs(first[3] - solved.torque) / max(abs(solved.torque), 1e-3))
        for j, signs in enumerate(VARIANTS):
            slope, drive = equation3(robot, phi, dphi, ddphi, signs)
            size = abs(slope * v) + abs(drive) + abs(second)
            kane[i, j] = abs(slope * v + drive - first[0]) / size
            multipliers[i, j] = abs(slope * v + drive - second) / size
    rows = zip(VARIANTS, kane.T, multipliers.T, strict=True)
    return tuple(
        Deviation(s, float(a.max()), float(b.max()), float(np.median(a))) for s, a, b in rows
    ), torque


def _random_robot(rng: np.random.Generator) -> Robot:
    def platform(c: float) -> Platform:
        m, a, k = rng.uniform([0.1, -0.03, 0.01], [1.0, 0.1, 0.5])
        return Platform(m, rng.uniform(5e-4, 1e-2), c, a, rng.uniform(0.02, 0.08), k * 0.02**2)

    return Robot(platform(rng.uniform(0.12, 0.3)), platform(rng.uniform(0.03, 0.11)), 0.02)


def _comparison(robot: Robot, gait: SineGait, seconds: float) -> Comparison:
    kane = rollout(robot, gait, seconds, "rest", _RATE)
    bodies = two_bodies.path(robot, gait, kane.t)
    right, wrong = (path(robot, gait, kane.t, signs) for signs in (CORRECTED, PRINTED))
    others = ((bodies.x, bodies.y), right[2:], wrong[2:])
    distance = [float(np.hypot(kane.x - x, kane.y - y).max()) for x, y in others]
    v = {"Kane": kane.v, "multipliers": bodies.v, PRINTED.name: wrong[0], CORRECTED.name: right[0]}
    return Comparison(gait, kane.t, v, (distance[0], distance[1], distance[2]), bodies.drift)


def energy_of(robot: Robot, gait: SineGait, signs: Signs) -> Energy:
    """The energy balance of a steady straight gait with these signs.

    The fictitious force pushes at axle 1 along platform 1, where it neither loads the servo nor
    changes the friction.
    """
    cycle = steady_cycle(robot, gait.amplitude, gait.period, signs, 4 * _SAMPLES)
    powers = np.zeros((3, _SAMPLES))
    largest = 0.0
    for i, v in enumerate(cycle.v[::4, 0].tolist()):
        t = gait.period / 2 * i / _SAMPLES
        phi, dphi, ddphi = (float(f(t)) for f in (gait.angle, gait.rate, gait.acceleration))
        q, qd = two_bodies.placed(robot, phi, dphi, v)
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
    servo, friction, fictitious = powers.mean(axis=1).tolist()
    return Energy(signs, servo, friction, fictitious, largest, float(cycle.speed[0]))
