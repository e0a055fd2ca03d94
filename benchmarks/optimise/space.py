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
from rr_opt.model.problem import Interval, Problem

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
    along: float


class Box:
    """The free variables of a problem, and from their values to gaits and costs."""

    def __init__(self, problem: Problem):
        gait, choice = problem.gait, problem.inertia_ratio
        ratio = choice.bounds if choice else Interval(0.0, 0.0)
        self.problem = problem
        self.posture = largest_posture(problem)
        self.least, self.most = (
            np.array([getattr(i, end) for i in (gait.amplitude, gait.period, gait.offset, ratio)])
            for end in ("low", "high")
        )
        self.free = np.flatnonzero(self.least < self.most)
        self.low, self.high = self.least[self.free], self.most[self.free]
        if not gait.amplitude.fixed:
            self.low[0], self.high[0] = 0.0, 1.0

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """(low, high) of each free variable."""
        return list(zip(self.low, self.high, strict=True))

    def largest(self, T: Array, offset: Array) -> Array:
        """The largest amplitude allowed at T and phi0, rad."""
        rate = T * self.problem.limits.rate / (2 * np.pi)
        return np.minimum(np.minimum(self.most[0], rate), self.posture - np.abs(offset))

    def gaits(self, X: Array) -> tuple[Array, Array]:
        """(alpha, T, phi0, ratio) for the points X (points, free), and by how much none fits."""
        full = np.repeat(self.least[:, None], len(X), axis=1)
        full[self.free] = X.T
        low, most = self.least[0], self.largest(full[1], full[2])
        full[0] = low
        if self.free[0] == 0:
            full[0] += X[:, 0] * np.maximum(most - low, 0.0)
        return full, np.maximum(low - most - 1e-12, 0.0)

    def point(self, gait: Array) -> Array:
        """The point of the box at or next to (alpha, T, phi0, ratio)."""
        x = np.clip(gait, self.least, self.most)
        span = self.largest(x[1], x[2]) - self.least[0]
        if self.free[0] == 0 and span > 0:
            x[0] = (x[0] - self.least[0]) / span
        return np.clip(x[self.free], self.low, self.high)

    def drive(
        self, gaits: Array, nodes: int, finer: int = 4, windows: int = 1
    ) -> tuple[Array, Performance]:
        """Gains (speed in the wanted direction) and the rest, of (alpha, T, phi0, ratio)."""
        load = math.isfinite(self.problem.limits.torque)
        how = {"nodes": nodes, "torque": load, "finer": finer, "windows": windows}
        done = evaluate(self.problem.robot, self.problem.inertia_ratio, gaits, **how)
        sign = {"forward": 1.0, "backward": -1.0}.get(self.problem.direction)
        return (np.abs(done.speed) if sign is None else sign * done.speed), done

    def performance(self, X: Array, nodes: int, finer: int = 4) -> tuple[Array, Performance]:
        """The same for the points X, with a cost where no amplitude is allowed."""
        gaits, excess = self.gaits(X)
        gain, done = self.drive(gaits, nodes, finer)
        gain = np.where(np.isfinite(gain), gain, -INFEASIBLE)
        return np.where(excess > 0, -INFEASIBLE * (1 + excess), gain), done

    def gait(self, x: Array, nodes: int, finer: int = 16) -> Gait:
        """The gait at the point x and what it does."""
        _, done = self.performance(x[None], nodes, finer)
        alpha, T, offset, ratio = (float(g) for g in self.gaits(x[None])[0][:, 0])
        named = ratio if self.problem.inertia_ratio else None
        did = (float(y[0]) for y in (done.speed, done.torque, done.along))
        return Gait(alpha, T, offset, named, *did)
