"""The least-squares fit of two rigid platforms, joined at P, to markers seen from above.

A frame's unknowns are P and the two headings. Each platform alone is a planar Procrustes problem:
with its markers' centroids taken off, the heading is the angle of one sum. The two then have to
agree on P. Each heading is eliminated from its platform's normal equations, which leaves for P the
information

    M = S (1 - (S/T) u u'),   S = sum w,  T = sum w |b|^2,  u = J R mean(b)

(b a marker's place from P, R the platform's rotation, J a quarter turn), so that P is the mean of
the two platforms' own, weighted by M. The headings follow P by (S/T) u. That is exact but for the
curvature of a rotation over the distance by which the platforms disagree on P. No loop over frames.

The platforms' shapes are the recording's, as a layout is measured by hand. Where the markers sit a
millimetre from where the layout says, their residuals have a mean in the platform's axes. Put
right, the fit no longer jumps when a marker goes missing. Axes and origin stay the layout's: the
residuals of a least-squares fit have no mean shift or turn of a platform that would not pull P
apart.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri

from rr_opt.array import Array
from rr_opt.recordings.markers.layout import FEWEST, Bodies


@dataclass(frozen=True)
class Alone:
    """One platform's fit, in n frames; what is said of a frame that is not `there` means nothing.

    joint        (n, 2), where this platform alone has P, m
    heading      (n,), rad
    lever        (n, 2), by how much the heading follows P, S/T u, rad/m
    per_heading  (n,), 1/T, 1/m^2
    information  (n, 2, 2), M
    there        (n,), whether the frame has two markers of the platform
    """

    joint: Array
    heading: Array
    lever: Array
    per_heading: Array
    information: Array
    there: NDArray[np.bool_]


def alone(places: Array, seen: Array) -> Alone:
    """The fit of markers at `places` (k, 2) on the platform, m, as `seen` (n, k, 2) from above."""
    used = np.asarray(np.isfinite(seen).all(axis=2))
    count = used.sum(axis=1)
    there = count >= FEWEST
    used = used & there[:, None]
    S = np.where(there, count, 1).astype(float)
    weight = used.astype(float)
    centre = np.einsum("nk,nkj->nj", weight, np.nan_to_num(seen)) / S[:, None]
    b_mean = weight @ places / S[:, None] if len(places) else np.zeros((len(seen), 2))
    off = np.where(used[..., None], seen - centre[:, None], 0.0)
    # Deviations of b need no centring: `off` sums to zero.
    along = np.einsum("nki,ki->n", off, places)
    across = np.einsum("nk,k->n", off[..., 1], places[:, 0]) - np.einsum(
        "nk,k->n", off[..., 0], places[:, 1]
    )
    heading = np.where(there, np.arctan2(across, along), np.nan)
    cos, sin = np.cos(heading), np.sin(heading)
    arm = np.stack(
        [cos * b_mean[:, 0] - sin * b_mean[:, 1], sin * b_mean[:, 0] + cos * b_mean[:, 1]], 1
    )
    T = np.where(there, weight @ (places**2).sum(axis=1), 1.0)
    u = np.nan_to_num(np.stack([-arm[:, 1], arm[:, 0]], 1))
    lever = (S / T)[:, None] * u
    M = S[:, None, None] * (np.eye(2) - lever[:, :, None] * u[:, None, :])
    M = np.where(there[:, None, None], M, 0.0)
    return Alone(centre - arm, heading, lever, 1 / T, M, there)


_CHUNK = 20_000
"""Frames at a time, which bounds the memory."""


@dataclass(frozen=True)
class Fit:
    """The fit of n frames; NaN where a frame has too few markers.

    joint     (n, 2), P on the floor, m
    heading   (n, 2), of platform 1's and platform 2's forward axis, within a turn, rad
    spread    (n, 4), standard deviations of x, y (m per m of a marker's noise), psi and phi (rad
              per m), for markers whose two coordinates have noise of 1 m
    covary    (n,), covariance of x and y in the same measure
    residual  (n, k, 2), seen less fitted, floor axes, m; NaN where a marker was not used
    squares   (n,), sum of the squared residuals, m^2
    freedom   (n,), how many more coordinates than unknowns; squares/freedom estimates the noise's
              variance
    """

    joint: Array
    heading: Array
    spread: Array
    covary: Array
    residual: Array
    squares: Array
    freedom: NDArray[np.int_]


def fit(bodies: Bodies, seen: Array) -> Fit:
    """Fit every frame of `seen` (n, k, 2), m; NaN is a marker that is not there."""
    pieces = [
        _fit(bodies, seen[start : start + _CHUNK]) for start in range(0, max(len(seen), 1), _CHUNK)
    ]
    if len(pieces) == 1:
        return pieces[0]
    names = Fit.__dataclass_fields__
    return Fit(**{name: np.concatenate([getattr(one, name) for one in pieces]) for name in names})


def _fit(bodies: Bodies, seen: Array) -> Fit:
    parts = [alone(bodies.places[bodies.of(one)], seen[:, bodies.of(one)]) for one in (0, 1)]
    total = parts[0].information + parts[1].information
    joint_covariance = _inverse(total)
    pull = sum(np.einsum("nij,nj->ni", p.information, np.nan_to_num(p.joint)) for p in parts)
    joint = np.einsum("nij,nj->ni", joint_covariance, pull)
    headings, slopes = [], []
    for part in parts:
        off = np.where(part.there, np.einsum("ni,ni->n", part.lever, joint - part.joint), np.nan)
        headings.append(part.heading - off)
        slopes.append(part.lever)
    residual, squares = _residuals(bodies, seen, joint, headings)
    spread, covary = _spread(parts, joint_covariance, slopes)
    counted = 2 * (~np.isnan(residual[..., 0])).sum(axis=1)
    freedom = counted - 2 - sum(part.there.astype(int) for part in parts)
    return Fit(joint, np.stack(headings, 1), spread, covary, residual, squares,
               np.maximum(freedom, 0))  # fmt: skip


def _residuals(
    bodies: Bodies, seen: Array, joint: Array, headings: list[Array]
) -> tuple[Array, Array]:
    turned = np.stack(headings, 1)[:, bodies.platform]
    cos, sin = np.cos(turned), np.sin(turned)
    forward, left = bodies.places[:, 0], bodies.places[:, 1]
    used = np.isfinite(seen).all(axis=2, keepdims=True)
    residual = np.where(used, seen - joint[:, None], np.nan)
    residual[..., 0] -= cos * forward - sin * left
    residual[..., 1] -= sin * forward + cos * left
    return residual, np.nansum(residual**2, axis=(1, 2))


def _spread(parts: list[Alone], C: Array, slopes: list[Array]) -> tuple[Array, Array]:
    one, two = parts
    nothing = np.where(one.there | two.there, 0.0, np.nan)
    var_psi = one.per_heading + np.einsum("ni,nij,nj->n", slopes[0], C, slopes[0])
    apart = slopes[1] - slopes[0]
    var_phi = one.per_heading + two.per_heading + np.einsum("ni,nij,nj->n", apart, C, apart)
    variances = np.stack(
        [
            C[:, 0, 0] + nothing,
            C[:, 1, 1] + nothing,
            np.where(one.there, var_psi, np.nan),
            np.where(one.there & two.there, var_phi, np.nan),
        ],
        1,
    )
    return np.sqrt(variances), C[:, 0, 1] + nothing


def _inverse(M: Array) -> Array:
    """Of symmetric (n, 2, 2); NaN where it has none."""
    a, b, c = M[:, 0, 0], M[:, 0, 1], M[:, 1, 1]
    size = a * c - b * b
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = np.where(size > 1e-12 * np.maximum(a * c, 1e-300), 1 / size, np.nan)
    return np.stack([np.stack([c, -b], 1), np.stack([-b, a], 1)], 1) * scale[:, None, None]


FALSE_ALARM = 1e-6
"""The share of good frames, with Gaussian noise, whose squares are larger than they may be."""


def marker_noise(fit: Fit) -> float:
    """The standard deviation of one coordinate of one marker, m; NaN if no frame can tell.

    The median over frames, so that up to half of them may hold anything.
    """
    told = fit.freedom > 0
    if not told.any():
        return float("nan")
    freedom = fit.freedom[told]
    # The median of chi squared, by Wilson and Hilferty's cube.
    median = freedom * (1 - 2 / (9 * freedom)) ** 3
    return float(np.sqrt(np.median(fit.squares[told] / median)))


def beyond(fit: Fit, sigma: float) -> NDArray[np.bool_]:
    """The frames (n,) whose markers do not fit two rigid platforms with noise sigma, m."""
    most = sigma**2 * chdtri(np.maximum(fit.freedom, 1), FALSE_ALARM)
    # Noise-free data keep to their digits only.
    return (fit.freedom > 0) & (fit.squares > np.maximum(most, 1e-18))


_ROUNDS = 25
_SAMPLE = 6000
"""Frames that are looked at, spread over the recording."""
_FEWEST = 20
"""Frames in which a marker must have been seen for its mean to be taken."""
_SURE = 5.0
"""Standard errors from which on a mean is no chance."""
_ENOUGH = 1.0
"""Standard errors that a round must move a marker by for another round; one alone corrects the part
of an error that the fit has not taken up."""


def refined(bodies: Bodies, seen: Array) -> tuple[Bodies, Array]:
    """The bodies with their markers where the recording has them, and by how much they moved.

    seen: (n, k, 2), m, labels put right. The shifts are (k, 2), m, in the platform's axes; zero
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


def _means(bodies: Bodies, fitted: Fit) -> tuple[Array, Array]:
    """Mean residual of each marker in its platform's axes (k, 2), and its error (k,), m."""
    sigma = marker_noise(fitted)
    good = ~beyond(fitted, sigma) & (fitted.freedom > 0)
    shift, error = np.zeros_like(bodies.places), np.full(len(bodies.places), np.inf)
    for i, where in enumerate(bodies.platform):
        rows = good & np.isfinite(fitted.residual[:, i, 0])
        if rows.sum() < _FEWEST:
            continue
        turn = np.exp(-1j * fitted.heading[rows, where])
        own = (fitted.residual[rows, i, 0] + 1j * fitted.residual[rows, i, 1]) * turn
        shift[i] = np.median(own.real), np.median(own.imag)
        # A median of Gaussians has 1.25 times the error of their mean.
        error[i] = 1.25 * max(sigma, 1e-9) / np.sqrt(rows.sum())
    return shift, error
