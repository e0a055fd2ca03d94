"""Which marker sits where on the robot, as somebody measured it or as a recording shows it.

Where nobody measured it: markers whose distance does not change are on one platform. The shape of a
platform is the mean of its frames, each turned onto the others. The joint P is the point that keeps
its place in both platforms' axes, as the motion of the servo shows. What stays unknown is a line
on each platform: the zeros of psi and of phi. And nothing says which platform is the first.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from rr_opt.array import Array
from rr_opt.model.experiment import Layout
from rr_opt.outcome import InputError

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


_APART = 3.0
"""How many times more a distance between platforms must change than one within a platform. Within,
all change by the markers' noise, and a marker may have twice that of another."""


def rigid_groups(labels: Sequence[str], seen: Array) -> tuple[list[int], list[int], list[int]]:
    """Two sets of markers with fixed distances, the larger first, and those in neither.

    seen: (n, k, 2), m. Raises InputError if there are no two such sets.
    """
    if len(labels) < 4:
        _refuse(labels, "fewer than two markers for each platform")
    apart = np.linalg.norm(seen[:, :, None] - seen[:, None], axis=-1)
    known = np.isfinite(apart).any(axis=0)
    apart = np.where(known, apart, 0.0)
    middle = np.nanmedian(apart, axis=0)
    change = 1.4826 * np.nanmedian(np.abs(apart - middle), axis=0)
    # Two markers that are never seen together are not known to be on one platform.
    change[~known] = 10 * change[known].max(initial=1.0)
    np.fill_diagonal(change, 0.0)
    tree = linkage(squareform((change + change.T) / 2, checks=False), "complete")
    # Cut where the next merger would join what moves: the largest step in the tree's heights.
    heights = np.maximum(tree[:, 2], 1e-6)
    cut = int(np.argmax(heights[1:] / heights[:-1])) if len(heights) > 1 else 0
    if heights[cut + 1] < _APART * heights[cut]:
        _refuse(labels, "no two sets of markers that move against each other")
    member = fcluster(tree, t=heights[cut] * 1.001, criterion="distance")
    sets = sorted(
        ([int(i) for i in np.flatnonzero(member == one)] for one in set(member)),
        key=len, reverse=True,
    )  # fmt: skip
    if len(sets) < 2 or len(sets[1]) < 2:
        _refuse(labels, "only one set of markers with fixed distances")
    if len(sets) > 2 and len(sets[2]) >= 2:
        _refuse(labels, "more than two sets of markers with fixed distances")
    return sets[0], sets[1], [i for one in sets[2:] for i in one]


def _refuse(labels: Sequence[str], what: str) -> NoReturn:
    raise InputError(
        f"The markers {', '.join(labels)} show {what}. Expected two rigid platforms with at least "
        "two markers each, and a servo that moves. Give the layout with --layout."
    )


_FRAMES = 2000
_ROUNDS = 20
_TRIES = 3
_SETTLED = 1e-7
"""A round that moves a shape by less is the last, m."""
_VAGUE = 0.02
"""A joint that is known no better than this is not known, m."""


@dataclass(frozen=True)
class Guessed:
    """A layout estimated from a recording.

    layout   its axes are a convention: platform 1's runs from P to the mean of its markers,
             platform 2's from the mean of its markers to P
    joint    standard deviation of P in the platforms' axes, m
    unused   markers that stay on neither platform
    """

    layout: Layout
    joint: float
    unused: tuple[str, ...]


def guessed_layout(labels: Sequence[str], seen: Array, up: str = "z") -> Guessed:
    """The layout that a recording shows; seen: (n, k, 2) from above, m.

    Platform 1 is the one of the first label that is on either.
    Raises InputError if the markers do not form two rigid platforms that move against each other.
    """
    sample = seen[:: max(1, len(seen) // _FRAMES)]
    first, second, unused = rigid_groups(labels, sample)
    groups = [first, second] if min(first) < min(second) else [second, first]
    shapes, poses = zip(*(_shape(sample[:, group]) for group in groups), strict=True)
    places, sigma = _joint(poses)
    layouts = []
    for group, shape, joint, sign in zip(groups, shapes, places, (1, -1), strict=True):
        off = shape - joint
        axis = sign * off.mean()
        turned = off * np.conj(axis) / abs(axis) if abs(axis) > 0 else off
        layouts.append(
            {labels[i]: (float(z.real), float(z.imag)) for i, z in zip(group, turned, strict=True)}
        )
    return Guessed(Layout(*layouts, up=up), sigma, tuple(labels[i] for i in unused))


def _shape(seen: Array) -> tuple[Complex, tuple[Complex, Complex]]:
    """A platform's markers in its own axes (complex, k), and its origin and turn (complex, n).

    Each round turns every frame onto the shape, and takes the median of the turned frames.
    """
    z = seen[..., 0] + 1j * seen[..., 1]
    whole = np.isfinite(z).all(axis=1)
    if not whole.any():
        raise InputError(
            "No frame shows all markers of a platform. Expected some that do, to learn its shape. "
            "Give the layout with --layout."
        )
    shape = z[whole][0] - z[whole][0].mean()
    for _ in range(_ROUNDS):
        origin, turn = _pose(z, shape)
        own = (z - origin[:, None]) * np.conj(turn)[:, None]
        if not np.isfinite(own).any(axis=0).all():
            raise InputError(
                "The markers of a platform stand in one point. Expected them apart, to show its "
                "heading. Check the file, or give the layout with --layout."
            )
        new = np.nanmedian(own.real, axis=0) + 1j * np.nanmedian(own.imag, axis=0)
        new -= new.mean()
        done = np.abs(new - shape).max() < _SETTLED
        shape = new
        if done:
            break
    return shape, _pose(z, shape)


def _pose(z: Complex, shape: Complex) -> tuple[Complex, Complex]:
    weight = np.isfinite(z).astype(float)
    count = np.maximum(weight.sum(axis=1), 1)
    z = np.nan_to_num(z)
    centre, middle = z.sum(axis=1) / count, weight @ shape / count
    total = ((z - centre[:, None]) * weight) @ np.conj(shape)
    size = np.abs(total)
    known = (weight.sum(axis=1) >= 2) & (size > 0)
    turn = np.where(known, total / np.where(known, size, 1.0), np.nan)
    return centre - turn * middle, turn


def _joint(poses: Sequence[tuple[Complex, Complex]]) -> tuple[tuple[complex, complex], float]:
    """P in both platforms' axes: O1 + R1 u = O2 + R2 w in all frames, by least squares.

    Frames that are far off are dropped, and it is solved once more.
    """
    (o1, r1), (o2, r2) = poses
    good = np.isfinite(o1) & np.isfinite(o2) & np.isfinite(r1) & np.isfinite(r2)
    every, right = np.column_stack([r1, -r2]), o2 - o1
    found, size = np.zeros(2, complex), 0.0
    for _ in range(_TRIES):
        found = np.linalg.lstsq(every[good], right[good], rcond=None)[0]
        off = np.abs(every @ found - right)
        size = float(np.median(off[good])) if good.any() else 0.0
        good = np.isfinite(off) & (off <= 6 * max(size, 1e-12))
    A = every[good]
    variance = size**2 / (2 * np.log(2))
    covariance = variance * np.linalg.pinv(A.conj().T @ A, hermitian=True).real
    sigma = float(np.sqrt(np.diag(covariance).max()))
    weak = np.linalg.matrix_rank(A, tol=1e-6 * np.sqrt(len(A) + 1)) < 2
    if weak or sigma > _VAGUE:
        raise InputError(
            "The servo moves too little to show the joint P, the point that both platforms keep. "
            "Expected a motion of some degrees. Record one, or give the layout with --layout."
        )
    return (complex(found[0]), complex(found[1])), sigma
