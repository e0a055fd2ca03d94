"""Whether markers are as far apart as their layout has them: a unit, or an axis, mistaken."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from rr_opt.outcome import InputError
from rr_opt.recordings.bodies import Bodies

Array = NDArray[np.float64]

_SAMPLE = 500
_AS_SAID = 1.5
"""The usual factor between a distance and the layout's from which on it is another layout."""
_UNITS = (
    (1000.0, "It looks like millimetres, of which the file or the layout says metres."),
    (0.001, "It looks like metres, of which the file or the layout says millimetres."),
)


def check_scale(bodies: Bodies, seen: Array, up: str) -> None:
    """Raise InputError if markers seen from above at (n, k, 2), m, are not those of the layout."""
    sample = seen[:: max(1, len(seen) // _SAMPLE)]
    ratios = []
    for i, j in combinations(range(len(bodies.labels)), 2):
        said = float(np.linalg.norm(bodies.places[i] - bodies.places[j]))
        apart = np.linalg.norm(sample[:, i] - sample[:, j], axis=1)
        if bodies.platform[i] == bodies.platform[j] and said > 0 and np.isfinite(apart).any():
            ratios.append(float(np.nanmedian(apart)) / said)
    usual = float(np.exp(np.median(np.abs(np.log(np.maximum(ratios, 1e-9)))))) if ratios else 1.0
    if usual <= _AS_SAID:
        return
    ratio = float(np.median(ratios))
    guess = next((words for size, words in _UNITS if abs(ratio / size - 1) < 0.2), "")
    raise InputError(
        f"Read markers that are, seen along {up}, {ratio:.3g} times as far apart as the layout has "
        "them on the same platform. Expected about the same. "
        + (guess or "Check the layout's places, its `up`, and the file's unit.")
    )
