"""From a point near a best gait to the best gait itself: SLSQP on the numpy steady cycle.

The variables are alpha, T, phi0 and J20/J10 themselves, so that every limit is a smooth
constraint; alpha + |phi0| <= posture is two. The torque counts by its logarithm, as it grows a
hundredfold near the singular posture, and by its peak in each part of the cycle, as the largest
of several peaks has a kink where they change places.
"""

from __future__ import annotations

import math

import numpy as np
from scipy import optimize

from benchmarks.optimise.fourier_numpy import Array
from benchmarks.optimise.space import Box

STEP = 1e-5  # of each variable's range, for central differences
VIOLATION = 1e-9  # of the torque's limit
LEAST = 1e-3  # of the torque's limit: below it a peak does not count


class Local:
    """Gain, margins to the limits and their derivatives, from one batch of cycles a point.

    z in [0, 1] are the free ones of (alpha, T, phi0, ratio), scaled by their ranges.
    """

    def __init__(self, box: Box, nodes: int, finer: int, windows: int):
        self.box, self.how = box, (nodes, finer, windows)
        self.range = (box.most - box.least)[box.free]
        self.straight = box.least[2] == box.most[2] == 0 and windows % 2 == 0
        self.evaluations = 0
        self.key = b""

    def gaits(self, Z: Array) -> Array:
        """(alpha, T, phi0, ratio), one column for each row of Z."""
        full = np.repeat(self.box.least[:, None], len(Z), axis=1)
        full[self.box.free] += (Z * self.range).T
        return full

    def values(self, Z: Array) -> Array:
        """Gain, then the margins that must not be negative, (1 + margins, points)."""
        gaits, limits = self.gaits(Z), self.box.problem.limits
        alpha, T, phi0, _ = gaits
        gain, done = self.box.drive(gaits, *self.how)
        rows = [gain, self.box.posture - alpha - np.abs(phi0)]
        if 2 in self.box.free:
            rows[1:] = [self.box.posture - alpha - phi0, self.box.posture - alpha + phi0]
        if math.isfinite(limits.rate):
            rows.append(limits.rate * T / (2 * np.pi) - alpha)
        if math.isfinite(limits.torque):
            parts = done.torques.T / limits.torque
            if self.straight:  # the second half of the cycle mirrors the first
                parts = parts[: len(parts) // 2]
            rows.extend(-np.log(np.maximum(parts, LEAST)))
        return np.array(rows)

    def look(self, z: Array) -> tuple[Array, Array]:
        """Values (1 + margins) and slopes (1 + margins, variables) at z."""
        if z.tobytes() != self.key:
            n = len(z)
            ahead, behind = np.minimum(z + STEP, 1.0), np.maximum(z - STEP, 0.0)
            points = np.tile(z, (2 * n + 1, 1))
            np.fill_diagonal(points[1 : n + 1], ahead)
            np.fill_diagonal(points[n + 1 :], behind)
            values = self.values(points)
            slopes = (values[:, 1 : n + 1] - values[:, n + 1 :]) / (ahead - behind)
            self.known, self.key = (values[:, 0], slopes), z.tobytes()
            self.evaluations += len(points)
        return self.known

    def inside(self, z: Array) -> Array:
        """The point next to z that breaks no limit, by Newton steps on the worst margin.

        SLSQP often gives up a hair outside (its merit function weighs a limit too little).
        """
        for _ in range(5):
            values, slopes = self.look(z)
            worst = 1 + int(np.argmin(values[1:]))
            if values[worst] >= -VIOLATION:
                break
            slope = np.where((slopes[worst] < 0) & (z <= 0), 0.0, slopes[worst])
            slope = np.where((slope > 0) & (z >= 1), 0.0, slope)
            z = np.clip(z - values[worst] * slope / max(slope @ slope, 1e-300), 0.0, 1.0)
        return z

    def climb(self, z: Array, tolerance: float) -> Array:
        """SLSQP from z."""
        found = optimize.minimize(
            lambda z: -self.look(z)[0][0],
            z,
            jac=lambda z: -self.look(z)[1][0],
            bounds=[(0.0, 1.0)] * len(z),
            constraints={
                "type": "ineq",
                "fun": lambda z: self.look(z)[0][1:],
                "jac": lambda z: self.look(z)[1][1:],
            },
            method="SLSQP",
            options={"ftol": tolerance, "maxiter": 100},
        )
        return np.clip(found.x, 0.0, 1.0)


def polish(
    box: Box, x: Array, nodes: int, *, finer: int = 16, windows: int = 8, tolerance: float = 1e-12
) -> tuple[Array, int]:
    """The local optimum near the point x of the box, or x where none better was found.

    With it the number of cycles that it took.
    """
    local = Local(box, nodes, finer, windows)
    z = (box.gaits(x[None])[0][box.free, 0] - box.least[box.free]) / local.range
    z = local.climb(z, tolerance)
    if local.look(z)[0][1:].min() < -VIOLATION:
        z = local.inside(local.climb(local.inside(z), tolerance))
    end = box.point(local.gaits(z[None])[:, 0])
    gain, done = box.performance(np.array([x, end]), nodes, finer)
    fits = ~(done.torque > box.problem.limits.torque * (1 + 2 * VIOLATION))
    worse = fits[0] and gain[1] <= gain[0]
    return (x if worse or not fits[1] else end), local.evaluations
