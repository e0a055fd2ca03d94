"""Which marker sits where on the robot, and how a capture's frame is seen from above."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.model.experiment import Layout
from rr_opt.outcome import InputError
from rr_opt.recordings.readers.marker_rows import MarkerData

Complex = NDArray[np.complex128]

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
    lever    as of MarkerData
    """

    labels: tuple[str, ...]
    columns: NDArray[np.int_]
    platform: NDArray[np.int_]
    places: Array
    heights: Array
    lever: float | None = None

    @property
    def placing(self) -> NDArray[np.bool_]:
        """(k,), which of them say where a platform is: all, or of a pose its origin, which is the
        first column of a body."""
        if self.lever is None:
            return np.ones(len(self.labels), bool)
        first = [self.columns[self.of(one)].min(initial=self.columns.max()) for one in (0, 1)]
        return np.isin(self.columns, first)

    def of(self, platform: int) -> NDArray[np.int_]:
        """Which of the markers are on platform 0 or 1."""
        return np.flatnonzero(self.platform == platform)


def bodies_of(layout: Layout, labels: Sequence[str], lever: float | None = None) -> Bodies:
    """The layout's markers that a file has; lever: as of MarkerData.

    Raises InputError if neither platform has two of them.
    """
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
        lever,
    )


def _listed(names: Sequence[str], most: int = 12) -> str:
    shown = ", ".join(names[:most]) or "none"
    return f"{shown} and {len(names) - most} more" if len(names) > most else shown


_AXES = {
    "z": (0, 1, 2, 1.0),
    "x": (1, 2, 0, 1.0),
    "y": (2, 0, 1, 1.0),
    "-z": (1, 0, 2, -1.0),
    "-x": (2, 1, 0, -1.0),
    "-y": (0, 2, 1, -1.0),
}
"""Columns of x and y as seen from above, of the height, and its sign, by the axis that is up."""


def seen_from_above(positions: Array, up: str) -> tuple[Array, Array]:
    """x and y (n, k, 2) and height (n, k) of positions (n, k, 3), m.

    A height that is not known does not make a marker missing.
    """
    first, second, height, sign = _AXES[up]
    return positions[..., [first, second]], sign * positions[..., height]


_FARTHEST = 1e12
"""Places beyond this, m, are no places, and would overflow where they are squared."""


def places_of(data: MarkerData) -> Array:
    """The positions (n, k, 3) of a file's markers, without those that are none."""
    return np.where(np.abs(data.positions) < _FARTHEST, data.positions, np.nan)


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
