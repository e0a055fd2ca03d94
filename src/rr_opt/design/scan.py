"""The whole unit box seen coarsely: where to climb from, and initial guesses for other shapes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.design.climb import Effort, Merit, climb, polished, spread
from rr_opt.design.decisions import Decisions, Setting, decisions
from rr_opt.design.landscape import Cycles, Landscape
from rr_opt.model.gait import FourierGait

# Phases of the scan and its climb, then of the climb that goes on from their tops: near the
# singular posture the coarse landscape has ripples that hold climbers back.
NODES, FINER_NODES = 24, 48
POINTS = {0: 1, 1: 48, 2: 160, 3: 320, 4: 512}
CLIMBERS = {0: 1, 1: 4, 2: 6, 3: 8, 4: 10}
# A start this much slower than the best is not climbed from.
PROMISING = 0.3
_APART = 0.3
# A search for what no gait can do is made once, and its answer has to be sure.
_PATIENCE, _ENDS, _FINEST_NODES = 3, 4, 96
# The values of a gait that has no steady cycle.
_GROSS = 1e6
ROUGH = Effort(iterations=8, first=0.08, last=0.02)
THOROUGH = Effort(iterations=25, first=0.04, last=0.006)

Look = Callable[[Cycles, Array, Array], Array]
"""Cycles, their gaits (4, K) and directions (K,) -> what is maximised and rows, (1 + R, K)."""


@dataclass(frozen=True)
class Seed:
    """A start: its direction (+1 forward, -1 backward), its point of the unit box (4,)."""

    sign: int
    point: Array


def scan(decisions: Decisions, count: int) -> Array:
    """Points of the unit box along the free coordinates, stretched so that a sixth of them lies
    on each pair of faces, where optima tend to be. Gaits at phi0 and -phi0 are mirror images, so
    of a symmetric range one half is enough, if it does not matter which way they turn."""
    free = decisions.free
    points = np.zeros((count, 4))
    if free:
        points[:, free] = np.clip(spread(len(points), len(free)) * 1.2 - 0.1, 0.0, 1.0)
    if decisions.mirrored:
        points[:, 1] = 0.5 + points[:, 1] / 2
    return points


def peaks(points: Array, sign: Array, values: Array, most: int, least: float) -> list[int]:
    """Indices of the best points that keep their distance from better ones, best first; none
    whose value is below the least."""
    open_ = values >= least
    chosen: list[int] = []
    while open_.any() and len(chosen) < most:
        best = int(np.argmax(np.where(open_, values, -np.inf)))
        chosen.append(best)
        distance = np.abs(points - points[best]).max(axis=1, initial=0.0)
        open_ &= (distance > _APART) | (sign != sign[best])
    return chosen


def share_of(best: float, share: float) -> float:
    """The value that is this share of the best, or as much worse where that is negative."""
    return best - (1 - share) * abs(best)


def search(
    landscape: Landscape, decisions: Decisions, look: Look, merit: Merit, signs: tuple[int, ...]
) -> tuple[Array, int, float]:
    """The point of the box (4,) with the most merit as far as a scan and climbs from its best
    points tell, its direction and its merit."""

    def terrain(points: Array, sign: Array, nodes: int = FINER_NODES) -> Array:
        gaits = decisions.physical(points)
        with np.errstate(invalid="ignore"):
            seen = look(landscape.cycles(gaits, nodes), gaits, sign)
        seen[0, ~np.isfinite(seen).all(axis=0)] = -_GROSS
        return np.where(np.isfinite(seen), seen, 0.0)

    free = decisions.free
    points = scan(decisions, _PATIENCE * POINTS[len(free)])
    sign = np.repeat(signs, len(points))
    points = np.concatenate([points for _ in signs])
    values = merit(terrain(points, sign))
    least = share_of(values.max(), PROMISING)
    most = _PATIENCE * CLIMBERS[len(free)]
    chosen = peaks(points[:, free], sign, values, most, least)
    tops, ways, _ = climb(points[chosen], sign[chosen], free, terrain, merit, THOROUGH)

    def ended(top: Array, way: int) -> tuple[Array, float]:
        way_there = np.array([way])
        return polished(
            lambda x: float(merit(terrain(x[None], way_there, _FINEST_NODES))[0]), top, free
        )

    ends = [(*ended(top, way), int(way)) for top, way in zip(tops[:_ENDS], ways, strict=False)]
    point, value, way = max(ends, key=lambda end: end[1])
    return point, way, value


_SHAPES, _TRIANGLES, _NODES = 1500, 100, 48
_SCANNED = 5
"""Harmonics of the shapes: what more of them add is left to the solver."""
_SHAPES_APART = 0.25


@dataclass(frozen=True)
class ShapeSeed:
    """A start: its direction (+1 forward, -1 backward), gait and share of the ballast."""

    sign: int
    gait: FourierGait
    share: float


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


def scan_shapes(setting: Setting, signs: tuple[int, ...], most: int) -> list[ShapeSeed]:
    """The best few shapes of many that keep the limits but perhaps for the torque's, best first;
    where none has the least amplitude, those that come nearest."""
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
        ShapeSeed(int(np.sign(cycles.speed[k])), shapes.gait(k), float(shapes.share[k]))
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
