"""Candidate optima: the result of each start with its shadow prices; which results are the same."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from rr_opt.design.decisions import Setting
from rr_opt.design.transcription import Mesh
from rr_opt.model.gait import Gait


@dataclass(frozen=True)
class StartResult:
    """The result of one start.

    sign         +1 forward, -1 backward
    gait, share  the gait, and the ballast's share of its range
    speed        signed, m/s
    feasible     every constraint holds to within FEASIBLE
    success      the solver reports an optimum
    sentence     the solver's outcome in words
    prices       speed gained per unit of each limit, m/s per unit: rate, angle, torque, grip,
                 singularity, direction, and curvature, yaw_rate, heading of the turn
    bound_prices speed gained per unit by which an active bound moves up: amplitude, period,
                 offset, ballast
    intervals    of the period, for the solver
    mesh         of multiple shooting; None for a sine
    cost         of transport, where that is the objective; prices then refer to it
    """

    sign: int
    gait: Gait
    share: float
    speed: float
    feasible: bool
    success: bool
    sentence: str
    iterations: int
    prices: Mapping[str, float]
    bound_prices: Mapping[str, float]
    violation: float
    intervals: int
    mesh: Mesh | None = field(default=None, repr=False)
    cost: float | None = None

    @property
    def merit(self) -> float:
        """The objective to maximise: |speed|, m/s, or the inverse of the cost of transport."""
        return abs(self.speed) if self.cost is None else 1 / self.cost

    @property
    def value(self) -> float:
        """The quantity that prices refer to: |speed|, m/s, or the cost of transport."""
        return abs(self.speed) if self.cost is None else self.cost

    @property
    def rank(self) -> tuple[bool, bool, float]:
        """Sort key: infeasible last, then not converged, then by merit."""
        return (not self.feasible, not self.success, -self.merit)


@dataclass(frozen=True)
class Finds:
    """Candidates with their settings, in any order; why other starts failed; and, where known, why
    no gait satisfies all limits."""

    pairs: list[tuple[Setting, StartResult]] = field(default_factory=list)
    lost: list[str] = field(default_factory=list)
    clash: str = ""

    @property
    def good(self) -> list[tuple[Setting, StartResult]]:
        """Optima, best first."""
        optima = [pair for pair in self.pairs if pair[1].feasible and pair[1].success]
        return sorted(optima, key=lambda pair: pair[1].rank)

    @property
    def fastest(self) -> float:
        """Speed of the best optimum, m/s; 0 if there is none."""
        return max((abs(one.speed) for _, one in self.good), default=0.0)

    def __add__(self, other: Finds) -> Finds:
        return Finds(self.pairs + other.pairs, self.lost + other.lost, self.clash or other.clash)


def distinct(ranked: list[tuple[Setting, StartResult]]) -> list[tuple[Setting, StartResult]]:
    """Each distinct optimum once; a gait and its mirror image (phi0 and -phi0) are the same."""
    kept: list[tuple[Setting, StartResult]] = []
    for setting, one in ranked:
        if not any(
            setting is other and _same(one, twin, setting.dynamics.mirrored) for other, twin in kept
        ):
            kept.append((setting, one))
    return kept


def _same(one: StartResult, other: StartResult, mirrored: bool) -> bool:
    """Whether two results are the same optimum, allowing for meshes not refined yet."""
    a, b = one.gait, other.gait
    offsets = (abs(a.offset), abs(b.offset)) if mirrored else (a.offset, b.offset)
    return (
        one.sign == other.sign
        and math.isclose(one.speed, other.speed, rel_tol=1e-3)
        and math.isclose(a.amplitude, b.amplitude, rel_tol=1e-2)
        and math.isclose(a.period, b.period, rel_tol=1e-2)
        and math.isclose(*offsets, abs_tol=1e-2)
        and math.isclose(one.share, other.share, abs_tol=1e-2)
    )
