"""Markers seen from above, and the least-squares fit of two rigid platforms, joined at P, to them.

A frame's unknowns are P and the two headings. Each platform alone is a planar Procrustes problem:
with its markers' centroids taken off, the heading is the angle of one sum. The two then have to
agree on P. Each heading is eliminated from its platform's normal equations, which leaves for P the
information

    M = S (1 - (S/T) u u'),   S = sum w,  T = sum w |b|^2,  u = J R mean(b)

(b a marker's place from P, R the platform's rotation, J a quarter turn), so that P is the mean of
the two platforms' own, weighted by M. The headings follow P by l = (S/T) u. That is exact but for
the curvature of a rotation over the distance by which the platforms disagree on P. Vectors are
complex numbers, and there is no loop over frames.

A pose is one point, the body's origin, and a heading that was measured by itself: with the noise of
a place over that of an angle, L, it has S = 1 and T = |b|^2 + L^2.

The platforms' shapes are taken from the recording, as a layout is measured by hand. If a marker is
a millimetre off its place in the layout, its residuals have a mean in the platform's axes. With
places corrected, the fit no longer jumps when a marker goes missing. Axes and origin stay the
layout's: the residuals of a least-squares fit have no mean shift or turn of a platform that would
not pull P apart.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri

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
        """(k,), which of them locate a platform: all, or for poses the origin, which is the first
        column of a body."""
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
"""Coordinates beyond this, m, are invalid, and their squares would overflow."""


def places_of(data: MarkerData) -> Array:
    """The positions (n, k, 3) of a file's markers, NaN for invalid ones."""
    return np.where(np.abs(data.positions) < _FARTHEST, data.positions, np.nan)


_SCALED = 500
_AS_SAID = 1.5
"""Typical ratio of distances to the layout's from which it is another layout."""
_UNITS = (
    (1000.0, "These look like millimetres where the file or the layout says metres."),
    (0.001, "These look like metres where the file or the layout says millimetres."),
)


def check_scale(bodies: Bodies, seen: Array, up: str) -> None:
    """Raise InputError if markers seen from above at (n, k, 2), m, are not those of the layout."""
    sample = seen[:: max(1, len(seen) // _SCALED)]
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
        f"Read markers that, viewed along {up}, are {ratio:.3g} times as far apart as in the "
        "layout of the same platform. Expected about the same. "
        + (guess or "Check the layout's places, its `up`, and the file's unit.")
    )


_CHUNK = 20_000
"""Frames at a time, which bounds the memory."""


@dataclass(frozen=True)
class RigidFit:
    """The fit of n frames; NaN where a frame has too few markers.

    joint     (n, 2), P on the floor, m
    heading   (n, 2), of platform 1's and platform 2's forward axis, within a turn, rad
    spread    (n, 4), standard deviations of x, y (m per m of a marker's noise), psi and phi (rad
              per m), for markers whose two coordinates have noise of 1 m
    residual  (n, k), seen less fitted, x + iy, m; NaN where a marker was not used
    squares   (n,), sum of the squared residuals, m^2
    freedom   (n,), coordinates less unknowns; squares/freedom estimates the noise's variance
    """

    joint: Array
    heading: Array
    spread: Array
    residual: Complex
    squares: Array
    freedom: NDArray[np.int_]


def fit(bodies: Bodies, seen: Array) -> RigidFit:
    """Fit every frame of `seen` (n, k, 2), m; NaN is a marker that is not there."""
    pieces = [
        _fit(bodies, (seen[start : start + _CHUNK] @ np.array([1, 1j])).astype(complex))
        for start in range(0, max(len(seen), 1), _CHUNK)
    ]
    names = [one.name for one in fields(RigidFit)]
    return RigidFit(*(np.concatenate([getattr(one, name) for one in pieces]) for name in names))


def _fit(bodies: Bodies, z: Complex) -> RigidFit:
    b, used, placing = bodies.places @ np.array([1, 1j]), np.isfinite(z), bodies.placing
    known = np.where(used, z, 0)
    # By platform (2, n, k) and (2, n): its markers, whether it is seen, own heading and P, S, 1/T,
    # u and l.
    mine = used & (bodies.platform == np.array([[0], [1]]))[:, None]
    there = mine.sum(axis=2) >= FEWEST
    turns = (mine & there[..., None]).astype(float)
    weight = turns * placing
    S = np.where(there, weight.sum(axis=2), 0.0)
    count = np.where(there, S, 1.0)
    centre, middle = (weight * known).sum(axis=2) / count, weight @ b / count
    off = np.conj(b - middle[..., None])
    heading = np.angle(np.sum(turns * (known - centre[..., None]) * off, axis=2))
    arm = middle * np.exp(1j * heading)
    own, u = centre - arm, 1j * arm
    T = weight @ np.abs(b) ** 2 + (bodies.lever or 0.0) ** 2
    per_T = 1 / np.where(T > 0, T, 1.0)
    lever = S * per_T * u
    xx = (S * (1 - u.real * lever.real)).sum(axis=0)
    yy = (S * (1 - u.imag * lever.imag)).sum(axis=0)
    xy = (S * (0 - u.real * lever.imag)).sum(axis=0)
    pull = (S * (own - u * np.real(np.conj(lever) * own))).sum(axis=0)
    size = xx * yy - xy * xy
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = np.where(size > 1e-12 * np.maximum(xx * yy, 1e-300), 1 / size, np.nan)
    Cxx, Cyy, Cxy = scale * yy, scale * xx, -scale * xy
    joint = Cxx * pull.real + Cxy * pull.imag + 1j * (Cxy * pull.real + Cyy * pull.imag)
    follow = np.real(np.conj(lever) * (joint - own))
    angles = np.where(there, heading - follow, np.nan).T

    def spread_of(lv: Complex) -> Array:
        return Cxx * lv.real**2 + 2 * Cxy * lv.real * lv.imag + Cyy * lv.imag**2

    psi = np.where(there[0], per_T[0] + spread_of(lever[0]), np.nan)
    phi = per_T[0] + per_T[1] + spread_of(lever[1] - lever[0])
    phi = np.where(there.all(axis=0), phi, np.nan)
    arms = b * np.exp(1j * angles[:, bodies.platform])
    residual = np.where(used, z - joint[:, None] - arms, np.nan)
    squares = np.nansum(placing * np.abs(residual) ** 2, axis=1)
    freedom = 2 * np.isfinite(residual[:, placing]).sum(axis=1) - 2
    if bodies.lever is None:
        freedom -= there.sum(axis=0)
    else:  # the headings are measured, too
        squares += bodies.lever**2 * np.nansum(np.square(follow), axis=0)
    return RigidFit(
        np.stack([joint.real, joint.imag], 1),
        angles,
        np.sqrt(np.stack([Cxx, Cyy, psi, phi], 1)),
        residual,
        squares,
        np.maximum(freedom, 0),
    )


FALSE_ALARM = 1e-6
"""The share of good frames, with Gaussian noise, whose squares exceed the limit."""


def marker_noise(fit: RigidFit) -> float:
    """The standard deviation of one coordinate of one marker, m; NaN if no frame determines it.

    The median over frames, so that up to half of them may hold anything.
    """
    known = fit.freedom > 0
    if not known.any():
        return float("nan")
    freedom = fit.freedom[known]
    # The median of chi squared, by Wilson and Hilferty's cube.
    median = freedom * (1 - 2 / (9 * freedom)) ** 3
    return float(np.sqrt(np.median(fit.squares[known] / median)))


def beyond(fit: RigidFit, sigma: float) -> NDArray[np.bool_]:
    """The frames (n,) whose markers do not fit two rigid platforms with noise sigma, m."""
    most = sigma**2 * chdtri(np.maximum(fit.freedom, 1), FALSE_ALARM)
    # Noise-free data agree to their printed digits only.
    return (fit.freedom > 0) & (fit.squares > np.maximum(most, 1e-18))


_ROUNDS = 25
_SAMPLE = 6000
"""Frames that are looked at, spread over the recording."""
_FEWEST = 20
"""Frames in which a marker must have been seen for its mean to be taken."""
_SURE = 5.0
"""Standard errors beyond which a mean is significant."""
_ENOUGH = 1.0
"""Standard errors by which a round must move a marker for another round to follow; a single round
corrects only the part of an error that the fit has not absorbed."""


def refined(bodies: Bodies, seen: Array) -> tuple[Bodies, Array]:
    """The bodies with their markers at their places in the recording, and their shifts.

    seen: (n, k, 2), m, labels corrected. The shifts are (k, 2), m, in the platform's axes; zero
    where the layout was right within five standard errors.
    """
    now, seen = bodies, seen[:: max(1, len(seen) // _SAMPLE)]
    least = _SURE
    for _ in range(_ROUNDS):
        step, errors = _means(now, fit(now, seen))
        if not (np.hypot(*step.T) > least * errors).any():
            break
        now = replace(now, places=now.places + step)
        least = _ENOUGH
    shift = now.places - bodies.places
    return now, shift


def _means(bodies: Bodies, fitted: RigidFit) -> tuple[Array, Array]:
    """Mean residual of each marker in its platform's axes (k, 2), and its error (k,), m."""
    sigma = marker_noise(fitted)
    good = ~beyond(fitted, sigma) & (fitted.freedom > 0)
    shift, error = np.zeros_like(bodies.places), np.full(len(bodies.places), np.inf)
    for i, where in enumerate(bodies.platform):
        rows = good & np.isfinite(fitted.residual[:, i])
        if rows.sum() < _FEWEST:
            continue
        own = fitted.residual[rows, i] * np.exp(-1j * fitted.heading[rows, where])
        shift[i] = np.median(own.real), np.median(own.imag)
        # A median of Gaussians has 1.25 times the error of their mean.
        error[i] = 1.25 * max(sigma, 1e-9) / np.sqrt(rows.sum())
    return shift, error
