"""The signs of equation (3), checked against mechanics in three independent ways.

- Kane's method, derived by CasADi in `rr_opt.mechanics`.
- Two bodies with Lagrange multipliers, in `rr_paper.two_bodies`.
- Energy: to move by wrong signs, a robot needs an external force, whose work has no source.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Platform, Robot
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.motion.rollout import rollout
from rr_paper import two_bodies
from rr_paper.equation3 import (
    CORRECTED,
    PRINTED,
    REVERSED,
    VARIANTS,
    Signs,
    equation3,
    path,
    steady_cycle,
)

_STATES, _SEED = 200, 7
_RATE = 20.0
_SAMPLES = 64
"""Instants of half a period over which the energy is averaged."""


@dataclass(frozen=True)
class Deviation:
    """How far signs are from mechanics over random states of random robots: |difference of vdot|
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
        """By how much the supplied power exceeds the dissipated one, W; 0 but for rounding."""
        return self.servo + self.fictitious - self.friction


@dataclass(frozen=True)
class SignAudit:
    """All about the signs; torque: largest relative difference of the servo's torque between Kane
    and the multipliers over the random states."""

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
    """The energy balance of a steady straight gait that moves by these signs.

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
