"""Whether the robot moves, and whether what moves is one robot."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from rr_opt.experiment.recording import Recording
from rr_opt.recordings.doubts import Doubt
from rr_opt.recordings.noise import NoiseEstimate

Array = NDArray[np.float64]

_HARDLY = 0.02
"""A path shorter than this tells little about friction, m."""
_FEW = 10
_STILL = 6.0
"""A range, of 98 % of the samples, within so many standard deviations is noise; Gaussian noise has
4.7."""


def motion_doubts(
    recording: Recording, noise: Mapping[str, NoiseEstimate], stated: Mapping[str, Array]
) -> tuple[Doubt, ...]:
    """What is odd about the motion as a whole."""
    return (*_of_angle(recording, noise, stated), *_of_path(recording))


def _of_angle(
    recording: Recording, noise: Mapping[str, NoiseEstimate], stated: Mapping[str, Array]
) -> Iterator[Doubt]:
    phi = recording.data("phi")
    phi = phi[np.isfinite(phi)]
    if len(phi) < _FEW:
        yield Doubt("motion", f"phi has {_few(len(phi), recording)}.")
        return
    sigma = np.nan_to_num([noise["phi"].sigma, float(np.median(stated["phi"]))]).max()
    low, high = np.percentile(phi, (1, 99))
    if high - low <= _STILL * sigma:
        yield Doubt(
            "motion",
            f"phi does not move: it stays within {high - low:.2g} rad. Expected a wiggle of the "
            "servo.",
        )


def _of_path(recording: Recording) -> Iterator[Doubt]:
    x, y = recording.data("x"), recording.data("y")
    both = np.isfinite(x) & np.isfinite(y)
    if both.sum() < _FEW:
        yield Doubt("motion", f"The joint's place has {_few(int(both.sum()), recording)}.")
        return
    x, y = x[both], y[both]
    far = float(np.hypot(x - x[0], y - y[0]).max())
    if far < _HARDLY:
        yield Doubt(
            "motion",
            f"This robot hardly moves: the joint never is more than {1e3 * far:.2g} mm from where "
            "it began. Such a recording says little about friction or inertia.",
        )


def _few(count: int, recording: Recording) -> str:
    return (
        f"{count} samples that are taken as data, of {len(recording)}"
        if count
        else "no data at all"
    )
