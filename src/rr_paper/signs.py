"""The signs of equation (3), tried against mechanics by ways that share nothing.

- Kane's method, derived by CasADi in `rr_opt.mechanics`.
- Two bodies with Lagrange multipliers, in `rr_paper.two_bodies`.
- Energy: a motion by wrong signs needs a force from outside, whose work comes from nowhere.
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
from rr_paper import two_bodies as two_body_path
from rr_paper.equation3 import (
    CORRECTED,
    PRINTED,
    REVERSED,
    VARIANTS,
    Energy,
    Signs,
    energy_of,
    equation3,
    path,
)

_STATES, _SEED = 200, 7
_RATE = 20.0


@dataclass(frozen=True)
class Off:
    """How far signs are from a route over random robots in random states: |vdot - vdot of the
    route|, over the size of both and of the terms. The largest of each route, and Kane's median."""

    signs: Signs
    kane: float
    multipliers: float
    median: float


@dataclass(frozen=True)
class Driven:
    """A motion from rest, sampled alike by all: v of axle 1, m/s, over t, s.

    v       by name of the signs, and of the routes `Kane` and `multipliers`
    apart   largest distance of P between Kane and the multipliers, m; between Kane and the
            corrected signs; and between Kane and the printed signs
    drift   of the multipliers' constraints: m, m/s and rad
    """

    gait: SineGait
    t: Array
    v: dict[str, Array]
    apart: tuple[float, float, float]
    drift: float


@dataclass(frozen=True)
class SignAudit:
    """Everything about the signs; torque: largest difference of the servo's torque between Kane
    and the multipliers, relative to its size, over the random states."""

    off: tuple[Off, ...]
    states: int
    torque: float
    driven: Driven
    energy: tuple[Energy, ...]


def audit_signs(robot: Robot, gait: SineGait, seconds: float) -> SignAudit:
    """Try the signs: instants of random robots, `seconds` of a gait from rest, and its energy."""
    off, torque = _instants()
    energy = tuple(energy_of(robot, gait, signs) for signs in (PRINTED, REVERSED, CORRECTED))
    return SignAudit(off, _STATES, torque, _driven(robot, gait, seconds), energy)


def _instants() -> tuple[tuple[Off, ...], float]:
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
        found = two_bodies.accelerate(robot, q, qd, ddphi)
        second = two_bodies.forward_acceleration(q, qd, found.acceleration)
        torque = max(torque, abs(first[3] - found.torque) / max(abs(found.torque), 1e-3))
        for j, signs in enumerate(VARIANTS):
            slope, drive = equation3(robot, phi, dphi, ddphi, signs)
            size = abs(slope * v) + abs(drive) + abs(second)
            kane[i, j] = abs(slope * v + drive - first[0]) / size
            multipliers[i, j] = abs(slope * v + drive - second) / size
    rows = zip(VARIANTS, kane.T, multipliers.T, strict=True)
    found = (Off(s, float(a.max()), float(b.max()), float(np.median(a))) for s, a, b in rows)
    return tuple(found), torque


def _random_robot(rng: np.random.Generator) -> Robot:
    def platform(c: float) -> Platform:
        m, a, k = rng.uniform([0.1, -0.03, 0.01], [1.0, 0.1, 0.5])
        return Platform(m, rng.uniform(5e-4, 1e-2), c, a, rng.uniform(0.02, 0.08), k * 0.02**2)

    return Robot(platform(rng.uniform(0.12, 0.3)), platform(rng.uniform(0.03, 0.11)), 0.02)


def _driven(robot: Robot, gait: SineGait, seconds: float) -> Driven:
    first = rollout(robot, gait, seconds, "rest", _RATE)
    second = two_body_path.path(robot, gait, 0.0, first.t)
    ways = {signs.name: path(robot, gait, first.t, signs) for signs in (PRINTED, CORRECTED)}
    right, wrong = ways[CORRECTED.name], ways[PRINTED.name]
    others = ((second.x, second.y), (right[2], right[3]), (wrong[2], wrong[3]))
    apart = [float(np.hypot(first.x - x, first.y - y).max()) for x, y in others]
    v = {"Kane": first.v, "multipliers": second.v, **{name: one[0] for name, one in ways.items()}}
    return Driven(gait, first.t, v, (apart[0], apart[1], apart[2]), second.drift)
