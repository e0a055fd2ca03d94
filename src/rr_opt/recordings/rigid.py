"""The least-squares fit of two rigid platforms, joined at P, to markers seen from above.

A frame's unknowns are P and the two headings. Each platform alone is a planar Procrustes problem:
with its markers' centroids taken off, the heading is the angle of one sum. The two then have to
agree on P. Each heading is eliminated from its platform's normal equations, which leaves for P the
information

    M = S (1 - (S/T) u u'),   S = sum w,  T = sum w |b|^2,  u = J R mean(b)

(b a marker's place from P, R the platform's rotation, J a quarter turn), so that P is the mean of
the two platforms' own, weighted by M. The headings follow P by (S/T) u. That is exact but for the
curvature of a rotation over the distance by which the platforms disagree on P. No loop over frames.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.recordings.bodies import Bodies
from rr_opt.recordings.platform_fit import Alone, alone

Array = NDArray[np.float64]

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
