"""Starts among gaits of several harmonics: many shapes at random, each as large as it may be."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.design.decisions import decisions
from rr_opt.design.setting import Setting
from rr_opt.robot.fourier_gait import FourierGait

Array = NDArray[np.float64]

_SHAPES, _NODES = 1500, 48
_SCANNED = 5
"""Harmonics of the shapes: what more of them add is left to the solver."""
_APART = 0.25


@dataclass(frozen=True)
class ShapeSeed:
    """A start: its direction (+1 forward, -1 backward), gait and share of the ballast."""

    sign: int
    gait: FourierGait
    share: float


def scan_shapes(
    setting: Setting, harmonics: int, signs: tuple[int, ...], most: int
) -> list[ShapeSeed]:
    """The best few shapes of many that keep the limits but perhaps for the torque's, best first;
    none if the bounds leave no room for a sine."""
    problem = setting.problem
    box, limits = decisions(problem), problem.limits
    if box.empty or harmonics < 2:
        return []
    rng, n = np.random.default_rng(0), min(harmonics, _SCANNED)
    T = box.period.low * (box.period.high / box.period.low) ** rng.random(_SHAPES)
    phi0 = box.offset.low + (box.offset.high - box.offset.low) * rng.random(_SHAPES)
    share = rng.random(_SHAPES)
    if setting.fixed_share is not None:
        share[:] = setting.fixed_share
    order = np.arange(1, n + 1)[:, None]
    sines, cosines = (rng.normal(0, 0.5, (n, _SHAPES)) / order for _ in range(2))
    sines[0], cosines[0] = 1.0, 0.0
    theta = 2 * math.pi * np.arange(2 * _NODES) / (2 * _NODES)
    swing, slope, bend = (_waves(sines, cosines, theta, k) for k in range(3))
    most_swing = np.minimum(problem.gait.amplitude.high, box.reach - np.abs(phi0))
    scale = np.minimum(
        most_swing / np.abs(swing).max(axis=0),
        limits.rate * T / (2 * math.pi * np.abs(slope).max(axis=0)),
    ) * rng.uniform(0.3, 1.0, _SHAPES)
    omega = 2 * math.pi / T
    angle = phi0 + scale * swing, scale * omega * slope, scale * omega**2 * bend
    with np.errstate(all="ignore"):
        cycles = setting.landscape.along(angle, T, share)
        excess = np.maximum(cycles.peak_torque / limits.torque - 1, 0.0)
    allowed = (scale >= problem.gait.amplitude.low) & np.isfinite(cycles.speed + excess)
    speed = np.where(allowed, cycles.speed, 0.0)
    speed -= np.sign(speed) * 3 * np.abs(speed).max() * np.where(allowed, excess, 0.0)
    ahead = np.isin(np.sign(cycles.speed), signs)
    merit = np.where(allowed & ahead, np.sign(cycles.speed) * speed, -np.inf)
    shapes = np.vstack([scale * sines, scale * cosines])
    chosen = _best(merit, shapes / np.linalg.norm(shapes, axis=0), most)
    return [
        ShapeSeed(
            int(np.sign(cycles.speed[i])),
            FourierGait(
                float(T[i]),
                float(phi0[i]),
                tuple((scale[i] * sines[:, i]).tolist()),
                tuple((scale[i] * cosines[:, i]).tolist()),
            ),
            float(share[i]),
        )
        for i in chosen
    ]


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
        merit[np.linalg.norm(shapes - shapes[:, [best]], axis=0) <= _APART] = -np.inf
    return chosen
