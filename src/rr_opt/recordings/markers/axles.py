"""Where a platform's axle is, as its rolling shows.

Wheels that do not slip keep the axle's centre from moving sideways. With P moving by (along, side)
in some axes of the platform while these turn by `turn`, the axle lies in the direction a from P at
the distance c where

    side cos a - along sin a + c turn = 0

at every instant. That is linear in (cos a, -sin a, c), whose scale is known, and all three
measured quantities have noise: total least squares, an eigenvector of three by three. Rows are
sums over a quarter of a second, in which platforms swing, and over seconds, in which they go far:
the noise of a sum is that of its ends.

What is found is where the wheels roll to: an axle that toes in has turned its platform's axes.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.recordings.noise import noise_of
from rr_opt.recordings.time_axis import LACKING

_ROWS = (0.25, 1.0, 4.0)
"""s: from a part of a gait's period to several."""
_BLOCKS = 20
"""Left out one at a time, for the standard deviations."""
_SHOWN = 2.0
"""Mean square that motion leaves, in noise, over that which rolling leaves of it, at least."""
_SURE = 0.03
"""A direction that is known no better than this is not known, rad."""
_LEAST = np.array([1e-6, 1e-6, 1e-5])
"""Noise that is taken at least: m, m, rad."""


@dataclass(frozen=True)
class Axle:
    """An axle as seen from P.

    direction  from the axes that headings are of, to the way from P to the axle, rad
    distance   m
    sigma      standard deviation of the direction, rad
    error      standard deviation of the distance, m
    """

    direction: float
    distance: float
    sigma: float
    error: float


def axle_of(
    times: Sequence[Array], joints: Sequence[Array], headings: Sequence[Array]
) -> Axle | None:
    """The axle that some recordings show; None if the platform does not roll, or too little.

    By recording: times (n,), s; P (n, 2), m; the platform's heading (n,), rad, within a turn.
    """
    noises = [_noise(*one) for one in zip(joints, headings, strict=True)]
    noise = np.fmax(np.fmax.reduce(noises), _LEAST)
    blocks = np.zeros((_BLOCKS, 3, 3))
    for seconds in _ROWS:
        motions = zip(times, joints, headings, strict=True)
        rows = np.concatenate([_rows(*one, seconds) for one in motions]) / noise
        blocks += [one.T @ one for one in np.array_split(rows, _BLOCKS)]
    total = blocks.sum(axis=0)
    if not total.any():
        return None
    sizes = np.linalg.eigvalsh(total)
    direction, distance = _solved(total, noise)
    apart = np.array([_solved(total - one, noise) for one in blocks]) - (direction, distance)
    apart[:, 0] = (apart[:, 0] + np.pi) % (2 * np.pi) - np.pi
    sigma, error = np.sqrt((_BLOCKS - 1) * apart.var(axis=0))
    if sizes[1] < _SHOWN * sizes[0] or not sigma < _SURE:
        return None
    return Axle(direction, distance, float(sigma), float(error))


def _noise(joint: Array, heading: Array) -> Array:
    """Of along, side and turn of a recording; NaN where it cannot be estimated."""
    known = np.isfinite(heading)
    angle = np.full(len(heading), np.nan)
    angle[known] = np.unwrap(heading[known])
    place = max(noise_of(one).sigma for one in joint.T)
    return np.array([place, place, noise_of(angle).sigma])


def _rows(t: Array, joint: Array, heading: Array, seconds: float) -> Array:
    """along, side and turn (rows, 3) over some seconds without a gap."""
    step = float(np.median(np.diff(t))) if len(t) > 1 else seconds
    turn = (np.diff(heading) + np.pi) % (2 * np.pi) - np.pi
    moved = np.diff(joint[:, 0] + 1j * joint[:, 1]) * np.exp(-1j * (heading[:-1] + turn / 2))
    each = np.column_stack([moved.real, moved.imag, turn])
    each[np.diff(t) > LACKING * step] = np.nan
    whole = max(1, round(seconds / step))
    starts = np.arange(0, len(each) - whole + 1, max(1, whole // 4))
    gone = np.concatenate([[0], np.cumsum(~np.isfinite(each).all(axis=1))])
    sums = np.concatenate([np.zeros((1, 3)), np.cumsum(np.nan_to_num(each), axis=0)])
    kept = starts[gone[starts + whole] == gone[starts]]
    return sums[kept + whole] - sums[kept]


def _solved(moments: Array, noise: Array) -> tuple[float, float]:
    """Direction and distance that leave least of the rows' second moments (3, 3), in noise."""
    along, side, turn = np.linalg.eigh(moments)[1][:, 0] / noise
    sign = 1.0 if turn > 0 else -1.0
    size = max(float(np.hypot(along, side)), 1e-300)
    return float(np.arctan2(-sign * along, sign * side)), sign * float(turn) / size
