"""A Problem as a box: every limit but the torque is turned into a bound of one variable.

The variables are the reach u in [0, 1], T, phi0 and J20/J10, those that are free. The amplitude
is alpha = low + u (most - low), `most` being the largest that the gait's own bound, the servo's
rate and angle and the margin to the singular posture allow at this T and phi0. Only the torque
is left as a constraint, and only where it can be exceeded.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from benchmarks.optimise.fourier_numpy import Array, Performance, evaluate
from rr_opt.problem import Interval, Problem

INFEASIBLE = 1e3  # m/s, the cost of a point where no amplitude is allowed


def largest_posture(problem: Problem) -> float:
    """The largest |phi| that the servo's angle and the margin to S1 = 0 allow, rad."""
    c1, c2 = problem.robot.platform1.c, problem.robot.platform2.c
    cosine = (problem.limits.singularity - c2) / c1
    singular = math.acos(cosine) if abs(cosine) <= 1 else math.inf if cosine < 0 else 0.0
    return min(problem.limits.angle, singular)


@dataclass(frozen=True)
class Gait:
    """One gait with its ratio (None: the robot as it is) and what it does."""

    amplitude: float
    period: float
    offset: float
    ratio: float | None
    speed: float
    torque: float


class Box:
    """The free variables of a problem, and from their values to gaits and costs."""

    def __init__(self, problem: Problem):
        gait, choice = problem.gait, problem.inertia_ratio
        reach = gait.amplitude if gait.amplitude.fixed else Interval(0.0, 1.0)
        ratio = choice.bounds if choice else Interval(0.0, 0.0)
        intervals = (reach, gait.period, gait.offset, ratio)
        self.problem = problem
        self.posture = largest_posture(problem)
        self.fixed = np.array([i.low for i in intervals])
        self.free = np.flatnonzero([not i.fixed for i in intervals])
        self.low = self.fixed[self.free]
        self.high = np.array([intervals[n].high for n in self.free])

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """(low, high) of each free variable."""
        return list(zip(self.low, self.high, strict=True))

    def gaits(self, X: Array) -> tuple[Array, Array]:
        """(alpha, T, phi0, ratio) for the points X (points, free), and by how much none fits."""
        full = np.repeat(self.fixed[:, None], len(X), axis=1)
        full[self.free] = X.T
        reach, T, offset, _ = full
        bound, low = self.problem.gait.amplitude, self.problem.gait.amplitude.low
        rate = T * self.problem.limits.rate / (2 * np.pi)
        most = np.minimum(np.minimum(bound.high, rate), self.posture - np.abs(offset))
        full[0] = low if bound.fixed else low + reach * np.maximum(most - low, 0.0)
        return full, np.maximum(low - most - 1e-12, 0.0)

    def performance(
        self, X: Array, nodes: int, finer: int = 4, windows: int = 1
    ) -> tuple[Array, Performance]:
        """Gains (speed in the wanted direction) and the rest, for the points X."""
        gaits, excess = self.gaits(X)
        robot, choice = self.problem.robot, self.problem.inertia_ratio
        load = math.isfinite(self.problem.limits.torque)
        how = {"nodes": nodes, "torque": load, "finer": finer, "windows": windows}
        done = evaluate(robot, choice, gaits, **how)
        sign = {"forward": 1.0, "backward": -1.0}.get(self.problem.direction)
        gain = np.abs(done.speed) if sign is None else sign * done.speed
        return np.where(excess > 0, -INFEASIBLE * (1 + excess), gain), done

    def gait(self, x: Array, nodes: int, finer: int = 16) -> Gait:
        """The gait at the point x and what it does."""
        _, done = self.performance(x[None], nodes, finer)
        alpha, T, offset, ratio = (float(g) for g in self.gaits(x[None])[0][:, 0])
        named = ratio if self.problem.inertia_ratio else None
        return Gait(alpha, T, offset, named, float(done.speed[0]), float(done.torque[0]))
