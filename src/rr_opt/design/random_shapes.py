"""Initial guesses for shapes that are no sines: many at random, seen coarsely."""

import math
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.design.decisions import Setting, decisions
from rr_opt.model.gait import FourierGait

_SHAPES, _TRIANGLES, _NODES = 1500, 100, 48
_SCANNED = 5
"""Harmonics of the shapes: what more of them add is left to the solver."""
_SHAPES_APART = 0.25


@dataclass(frozen=True)
class _Shapes:
    """K shapes at random, as large as the limits on angle and rate allow or smaller.

    period, offset, share (K,); sines, cosines (n, K), rad
    """

    period: Array
    offset: Array
    share: Array
    sines: Array
    cosines: Array

    def gait(self, k: int) -> FourierGait:
        """One of them."""
        return FourierGait(
            float(self.period[k]),
            float(self.offset[k]),
            tuple(self.sines[:, k].tolist()),
            tuple(self.cosines[:, k].tolist()),
        )

    def angle(self) -> tuple[Array, Array, Array]:
        """phi, dphi, ddphi at nodes and halfway between them, (2 N, K)."""
        theta = 2 * math.pi * np.arange(2 * _NODES) / (2 * _NODES)
        omega = 2 * math.pi / self.period
        swing, rate, bend = (_waves(self.sines, self.cosines, theta, k) for k in range(3))
        return self.offset + swing, omega * rate, omega**2 * bend


def scan_shapes(
    setting: Setting, signs: tuple[int, ...], most: int
) -> list[tuple[int, FourierGait, float]]:
    """Direction (+1 forward, -1 backward), gait and share of the ballast of the best few shapes of
    many that keep the limits but perhaps for the torque's, best first; where none has the least
    amplitude, of those that come nearest."""
    gait = setting.problem.gait
    harmonics = _SCANNED if gait.shape == "free" else min(gait.harmonics, _SCANNED)
    if decisions(setting.problem).empty or harmonics < 2:
        return []
    shapes = _random(setting, harmonics)
    with np.errstate(all="ignore"):
        cycles = setting.landscape.along(shapes.angle(), shapes.period, shapes.share)
        excess = np.maximum(cycles.peak_torque / setting.problem.limits.torque - 1, 0.0)
    known = np.isfinite(cycles.speed + excess) & np.isin(np.sign(cycles.speed), signs)
    allowed = known & (shapes.sines[0] >= gait.amplitude.low)
    size = np.where(allowed, np.abs(cycles.speed), 0.0)
    merit = np.where(allowed, size - 3 * size.max() * excess, -np.inf)
    if not allowed.any():
        merit = np.where(known, shapes.sines[0], -np.inf)
    vectors = np.vstack([shapes.sines, shapes.cosines])
    return [
        (int(np.sign(cycles.speed[k])), shapes.gait(k), float(shapes.share[k]))
        for k in _best(merit, vectors / np.linalg.norm(vectors, axis=0), most)
    ]


def _random(setting: Setting, n: int) -> _Shapes:
    problem = setting.problem
    box, rng = decisions(problem), np.random.default_rng(0)
    T = box.period.low * (box.period.high / box.period.low) ** rng.random(_SHAPES)
    phi0 = box.offset.low + (box.offset.high - box.offset.low) * rng.random(_SHAPES)
    share = rng.random(_SHAPES)
    if setting.fixed_share is not None:
        share[:] = setting.fixed_share
    order = np.arange(1, n + 1)[:, None]
    sines, cosines = (rng.normal(0, 0.5, (n, _SHAPES)) / order for _ in range(2))
    sines[0], cosines[0] = 1.0, 0.0
    # Triangles, the shape that needs the least rate for its first harmonic.
    sines[:, :_TRIANGLES], cosines[:, :_TRIANGLES] = _triangle(n)[:, None], 0.0
    theta = np.linspace(0, 2 * math.pi, 4 * _NODES)
    swing, rate = (np.abs(_waves(sines, cosines, theta, k)).max(axis=0) for k in range(2))
    most_swing = np.minimum(problem.gait.amplitude.high, box.reach - np.abs(phi0))
    largest = np.minimum(most_swing / swing, problem.limits.rate * T / (2 * math.pi * rate))
    scale = largest * np.append(np.ones(_TRIANGLES), rng.uniform(0.3, 1.0, _SHAPES - _TRIANGLES))
    return _Shapes(T, phi0, share, scale * sines, scale * cosines)


def _triangle(n: int) -> Array:
    """Its harmonics' sines, the first 1."""
    order = np.arange(1, n + 1)
    return np.sin(order * math.pi / 2) / order**2


def _waves(sines: Array, cosines: Array, theta: Array, order: int) -> Array:
    """The order-th derivative in theta at every phase, (len(theta), K)."""
    n = np.arange(1, len(sines) + 1)
    turned = theta[:, None] * n + order * math.pi / 2
    return (n**order * np.sin(turned)) @ sines + (n**order * np.cos(turned)) @ cosines


def _best(merit: Array, shapes: Array, most: int) -> list[int]:
    """Indices of the best that are unlike better ones, best first."""
    merit, chosen = merit.copy(), []
    while len(chosen) < most and merit.max() > 0:
        best = int(merit.argmax())
        chosen.append(best)
        merit[np.linalg.norm(shapes - shapes[:, [best]], axis=0) <= _SHAPES_APART] = -np.inf
    return chosen
