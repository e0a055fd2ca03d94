"""Many small fits side by side: Levenberg and Marquardt's method on arrays of problems.

A profile, a bootstrap or a row left out each need hundreds of fits of five or six unknowns to
nine rows. Their predictions are cheap only in bulk, so all of them step together: one array of
points and their neighbours is predicted per step. Student's law enters as weights that follow
the residuals. A coordinate that stands on a side of the box and pulls outward is left there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.paper.calibration.deviance import Law, row_deviance, weight

Array = NDArray[np.float64]

_DIFFERENCE = 5e-3
"""Step of the difference quotients, as a share of the box: long enough that the steps of the
motion with dry friction, as coarse as the noise allows, do not show in them."""
_START, _SOFTER, _HARDER, _GIVE_UP = 1e-2, 0.2, 6.0, 1e6


@dataclass(frozen=True)
class Problems:
    """K problems over unknowns in [0, 1].

    predict  (N, unknowns) -> speeds (N, 9), counted as the printed ones are
    target, error  (K, 9), m/s
    counted  (K, 9), 1 where a row counts and 0 where it is left out
    fixed    (K, unknowns), True where an unknown is held
    """

    predict: Callable[[Array], Array]
    target: Array
    error: Array
    counted: Array
    fixed: NDArray[np.bool_]
    law: Law = "student"

    def deviance(self, speeds: Array, which: NDArray[np.int_]) -> Array:
        """Of predictions (k, 9) for the problems `which` (k,)."""
        z = (speeds - self.target[which]) / self.error[which]
        kept = self.counted[which] > 0
        return np.where(kept, row_deviance(z, self.law), 0.0).sum(axis=1)


def problems(
    predict: Callable[[Array], Array],
    start: Array,
    target: Array,
    error: Array,
    *,
    law: Law = "student",
    counted: Array | None = None,
    fixed: NDArray[np.bool_] | None = None,
) -> Problems:
    """One problem for each start (K, unknowns); target, error, counted and fixed broadcast."""
    rows = (len(start), np.shape(target)[-1])
    counted = np.ones(rows) if counted is None else counted
    fixed = np.zeros(start.shape, bool) if fixed is None else fixed
    return Problems(
        predict=predict,
        target=np.broadcast_to(target, rows),
        error=np.broadcast_to(error, rows),
        counted=np.broadcast_to(counted, rows),
        fixed=np.broadcast_to(fixed, start.shape),
        law=law,
    )


def descend(posed: Problems, start: Array, steps: int = 25) -> tuple[Array, Array]:
    """The points that the starts (K, unknowns) lead to, and their deviances (K,)."""
    x = start.copy()
    every = np.arange(len(x))
    speeds = posed.predict(x)
    best = posed.deviance(speeds, every)
    damping, going = np.full(len(x), _START), every[np.isfinite(best)]
    for _ in range(steps):
        if not len(going):
            break
        tried = _step(posed, x[going], speeds[going], damping[going], going)
        there = posed.predict(tried)
        found = posed.deviance(there, going)
        better = found < best[going]
        gain = best[going] - found
        won = going[better]
        x[won], speeds[won], best[won] = tried[better], there[better], found[better]
        damping[going] *= np.where(better, _SOFTER, _HARDER)
        finished = (better & (gain < 1e-5)) | (damping[going] > _GIVE_UP)
        going = going[~finished]
    return x, best


def _step(
    posed: Problems, x: Array, speeds: Array, damping: Array, which: NDArray[np.int_]
) -> Array:
    """The next points (k, unknowns), inside the box."""
    J = _slopes(posed.predict, x, speeds) / posed.error[which][:, :, None]
    z = (speeds - posed.target[which]) / posed.error[which]
    w = np.sqrt(weight(z, posed.law) * posed.counted[which])
    J, z = np.nan_to_num(J * w[:, :, None]), z * w
    downhill = -np.einsum("kri,kr->ki", J, z)
    outward = ((x <= 0) & (downhill < 0)) | ((x >= 1) & (downhill > 0))
    free = ~(posed.fixed[which] | outward)
    J, downhill = J * free[:, None, :], downhill * free
    normal = np.einsum("kri,krj->kij", J, J)
    diagonal = np.einsum("kii->ki", normal)
    ridge = damping[:, None] * (diagonal + 1e-3) + np.where(free, 0.0, 1.0)
    normal = normal + ridge[:, :, None] * np.eye(x.shape[1])
    return np.clip(x + np.linalg.solve(normal, downhill[:, :, None])[:, :, 0], 0.0, 1.0)


def _slopes(predict: Callable[[Array], Array], x: Array, speeds: Array) -> Array:
    """d speeds/dx by differences towards the box's middle, (k, 9, unknowns)."""
    size = x.shape[1]
    h = np.where(x < 0.5, _DIFFERENCE, -_DIFFERENCE)
    moved = x[:, None, :] + h[:, None, :] * np.eye(size)
    beside = predict(moved.reshape(-1, size)).reshape(len(x), size, -1)
    return np.moveaxis((beside - speeds[:, None, :]) / h[:, :, None], 1, 2)
