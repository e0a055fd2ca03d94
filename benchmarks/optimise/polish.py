"""From a point near a best gait to the best gait itself: SLSQP on the numpy steady cycle."""

from __future__ import annotations

import numpy as np
from scipy import optimize

from benchmarks.optimise.fourier_numpy import Array
from benchmarks.optimise.space import Box

STEP = 1e-5  # of each variable's range, for central differences


class Local:
    """Gain, torque margins and their derivatives at a point, from one batch of cycles."""

    def __init__(self, box: Box, nodes: int, finer: int, windows: int):
        self.box, self.how = box, (nodes, finer, windows)
        self.evaluations = 0
        self.key = b""

    def look(self, x: Array) -> tuple[Array, Array]:
        """Values (1 + windows) and slopes (1 + windows, variables) at x."""
        if x.tobytes() != self.key:
            ahead = np.minimum(x + STEP * (self.box.high - self.box.low), self.box.high)
            behind = np.maximum(x - STEP * (self.box.high - self.box.low), self.box.low)
            points = np.tile(x, (2 * len(x) + 1, 1))
            np.fill_diagonal(points[1 : len(x) + 1], ahead)
            np.fill_diagonal(points[len(x) + 1 :], behind)
            gain, done = self.box.performance(points, *self.how)
            margins = 1 - done.torques.T / self.box.problem.limits.torque
            both = np.vstack([gain, np.nan_to_num(margins, nan=1.0)])
            self.slopes = (both[:, 1 : len(x) + 1] - both[:, len(x) + 1 :]) / (ahead - behind)
            self.values, self.key = both[:, 0], x.tobytes()
            self.evaluations += len(points)
        return self.values, self.slopes


def polish(
    box: Box, x: Array, nodes: int, *, finer: int = 4, windows: int = 8, tolerance: float = 1e-12
) -> tuple[Array, int]:
    """The local optimum near x, or x where none better was found; and the cycles it took."""
    local = Local(box, nodes, finer, windows)
    margin = {
        "type": "ineq",
        "fun": lambda x: local.look(x)[0][1:],
        "jac": lambda x: local.look(x)[1][1:],
    }
    before = local.look(x)[0].copy()
    found = optimize.minimize(
        lambda x: -local.look(x)[0][0],
        x,
        jac=lambda x: -local.look(x)[1][0],
        bounds=box.bounds,
        constraints=[margin] if np.isfinite(box.problem.limits.torque) else [],
        method="SLSQP",
        options={"ftol": tolerance, "maxiter": 100},
    )
    end = np.clip(found.x, box.low, box.high)
    after = local.look(end)[0]
    violated = after[1:].min() < -1e-7
    worse = before[1:].min() >= 0 and after[0] <= before[0]
    return (x if violated or worse else end), local.evaluations
