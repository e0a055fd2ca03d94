"""Both platforms as rigid bodies: which marker sits on which, and where in its axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.outcome import InputError
from rr_opt.recordings.layout import Layout

Array = NDArray[np.float64]

FEWEST = 2
"""Markers that a platform needs for its place and heading in the plane."""


@dataclass(frozen=True)
class Bodies:
    """The markers of platform 1 and platform 2, in the order of a file's columns.

    labels   (k,), names
    columns  (k,), their columns in the marker file
    platform (k,), 0 for platform 1, 1 for platform 2
    places   (k, 2), m, forward and left in the platform's axes, from the joint P
    heights  (k,), m, above the others as the layout has it; NaN where it does not say
    """

    labels: tuple[str, ...]
    columns: NDArray[np.int_]
    platform: NDArray[np.int_]
    places: Array
    heights: Array

    def of(self, platform: int) -> NDArray[np.int_]:
        """Which of the markers are on platform 0 or 1."""
        return np.flatnonzero(self.platform == platform)


def bodies_of(layout: Layout, labels: Sequence[str]) -> Bodies:
    """The layout's markers that a file has.

    Raises InputError if neither platform has two of them, or if one name is on both platforms.
    """
    both = set(layout.platform1) & set(layout.platform2)
    if both:
        raise InputError(
            f"The layout has {', '.join(sorted(both))} on both platforms. Expected every marker on "
            "one. Delete it from the other."
        )
    rows = [
        (name, where, tuple(float(size) for size in place))
        for where, places in enumerate((layout.platform1, layout.platform2))
        for name, place in places.items()
        if name in labels
    ]
    counts = [sum(where == one for _, where, _ in rows) for one in (0, 1)]
    if max(counts) < FEWEST:
        asked = [*layout.platform1, *layout.platform2]
        raise InputError(
            f"The file has the markers {_listed(labels)}. Expected at least two of one platform, "
            f"named as in the layout: {_listed(asked)}. Correct the names in the layout."
        )
    return Bodies(
        tuple(name for name, _, _ in rows),
        np.array([list(labels).index(name) for name, _, _ in rows]),
        np.array([where for _, where, _ in rows]),
        np.array([place[:2] for _, _, place in rows]),
        np.array([place[2] if len(place) > 2 else np.nan for _, _, place in rows]),
    )


def _listed(names: Sequence[str], most: int = 12) -> str:
    shown = ", ".join(names[:most]) or "none"
    return f"{shown} and {len(names) - most} more" if len(names) > most else shown
