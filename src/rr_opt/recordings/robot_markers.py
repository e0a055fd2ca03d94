"""The markers of a robot: shapes refined, names put right, ghosts left out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rr_opt.recordings.bodies import Bodies
from rr_opt.recordings.fit_noise import marker_noise
from rr_opt.recordings.ghosts import Ghosts, without_ghosts
from rr_opt.recordings.rigid import fit
from rr_opt.recordings.shape import refined
from rr_opt.recordings.swaps import Swap, put_right

Array = NDArray[np.float64]

_SAMPLE = 6000
"""Frames that tell the noise, spread over the recording."""
LEAST_NOISE = 1e-6
"""Noise that no capture system goes below, m; what noise-free data are given."""


def robot_of(
    bodies: Bodies, seen: Array, noise_sigma: float | None
) -> tuple[Bodies, Array, Array, list[Swap], Ghosts]:
    """Shapes first, as they set what fits; then names; and if there were any, both once more.

    The second round has the noise that is left when nothing is swapped any more. Ghosts are last.
    """
    swaps: list[Swap] = []
    while True:
        new, shift = refined(bodies, seen)
        found = marker_noise(fit(new, seen[:: max(1, len(seen) // _SAMPLE)]))
        sigma = max(_or(found, 0.0), noise_sigma or 0.0, LEAST_NOISE)
        seen, more = put_right(new, seen, sigma)
        again = bool(more) and not swaps
        swaps += more
        if not again:
            return new, shift, seen, swaps, without_ghosts(new, seen, sigma)


def _or(value: float, other: float) -> float:
    return value if np.isfinite(value) else other
