"""One platform by itself: a planar Procrustes problem, and what it says about P.

Symbols as in `rigid.py`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.recordings.bodies import FEWEST

Array = NDArray[np.float64]


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
