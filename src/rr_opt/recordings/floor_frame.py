"""The floor's two axes in the capture system's frame, and what tilts out of the floor."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rr_opt.outcome import InputError
from rr_opt.recordings.bodies import Bodies

Array = NDArray[np.float64]

_AXES = {
    "z": (0, 1, 2, 1.0),
    "x": (1, 2, 0, 1.0),
    "y": (2, 0, 1, 1.0),
    "-z": (1, 0, 2, -1.0),
    "-x": (2, 1, 0, -1.0),
    "-y": (0, 2, 1, -1.0),
}
"""Columns of x and y as seen from above, of the height, and its sign, by the axis that is up."""

_FEWEST = 3
"""Markers of a platform that show its tilt."""


def seen_from_above(positions: Array, up: str) -> tuple[Array, Array]:
    """x and y (n, k, 2) and height (n, k) of positions (n, k, 3), m.

    A height that is not known does not make a marker missing. Raises InputError for an unknown
    `up`.
    """
    if up not in _AXES:
        raise InputError(
            f"The layout's `up` is {up!r}. Expected one of: {', '.join(_AXES)}. Name the axis of "
            "the capture's frame that points up from the floor."
        )
    first, second, height, sign = _AXES[up]
    return positions[..., [first, second]], sign * positions[..., height]


def tilt(bodies: Bodies, height: Array) -> Array:
    """How steeply each platform leans against its own mean over the recording (n, 2), rad.

    height: (n, k), m. The largest slope of the plane through a platform's markers; NaN for frames
    and platforms with fewer than three, or with all in a line.
    """
    found = np.full((len(height), 2), np.nan)
    for one in (0, 1):
        mine = bodies.of(one)
        if len(mine) < _FEWEST:
            continue
        flat = np.column_stack([np.ones(len(mine)), bodies.places[mine]])
        whole = np.isfinite(height[:, mine]).all(axis=1)
        if np.linalg.matrix_rank(flat, tol=5e-3) < _FEWEST or not whole.any():
            continue
        own = height[whole][:, mine]
        slopes = (own - np.median(own, axis=0)) @ np.linalg.pinv(flat).T
        found[whole, one] = np.hypot(slopes[:, 1], slopes[:, 2])
    return found
