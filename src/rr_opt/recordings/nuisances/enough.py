"""An uninformative recording: empty, short, full of gaps, still, or drowned in noise."""

from collections.abc import Iterator

import numpy as np

from rr_opt.array import Array
from rr_opt.model.experiment import CHANNELS
from rr_opt.recordings.nuisances.evidence import ExaminedRecording
from rr_opt.recordings.warnings import Notice, notice

_FEWEST = 50
"""Least samples of a channel."""
_PERIODS = 2.0
"""A shorter recording shows a start and no more."""
_LARGEST_GAP = 4.0
"""Seconds without any data of a channel; the motion in between is then nobody's."""
_STILL = 10.0
"""What moves by less, in sigma of the noise, over 98 % of the samples, stands still."""
_COMMANDED = 0.2
"""A servo that moves that much of its amplitude follows its command, whatever the noise."""
_HARDLY = 0.02
"""A path shorter than this shows little of friction, m."""


def look(given: ExaminedRecording) -> Iterator[Notice]:
    """Why nothing, or little, can be learnt."""
    if (why := next(_reasons(given), None)) is not None:
        yield why
        return
    x, y, *_ = given.motion
    both = np.isfinite(x) & np.isfinite(y)
    far = float(np.hypot(x[both] - x[both][0], y[both] - y[both][0]).max()) if both.any() else 0.0
    if far < _HARDLY:
        yield notice("motion.robot", far=1e3 * far)


def _reasons(given: ExaminedRecording) -> Iterator[Notice]:
    """Why nothing can be learnt, the gravest first; each applies only if none before it does."""
    t, data = given.t, dict(zip(CHANNELS, given.motion, strict=True))
    counts = {name: int(np.isfinite(values).sum()) for name, values in data.items()}
    least = min(counts, key=lambda name: counts[name])
    if counts[least] == 0:
        yield notice("useless.empty", channel=least)
    period = given.gait.period if given.gait else 0.0
    seconds = float(t[-1] - t[0])
    if seconds < _PERIODS * period or counts[least] < _FEWEST:
        yield notice(
            "useless.short", seconds=seconds, count=counts[least], channel=least,
            periods=_PERIODS, least=_FEWEST,
        )  # fmt: skip
    for name, values in data.items():
        known = t[np.isfinite(values)]
        gap = float(np.diff(np.concatenate([t[:1], known, t[-1:]])).max())
        if gap > _LARGEST_GAP:
            yield notice("useless.gap", channel=name, gap=gap, most=_LARGEST_GAP)
    moved = np.array([_range(values) for values in data.values()])
    sizes = moved / given.sigma
    if sizes[3] < _STILL and given.gait and moved[3] > _COMMANDED * given.gait.amplitude > 0:
        yield notice("useless.noisy", moved=moved[3], sigma=given.sigma[3])
    if sizes[3] < _STILL:
        yield notice("useless.servo", moved=moved[3])
    if sizes[:3].max() < _STILL:
        yield notice("useless.robot")


def _range(values: Array) -> float:
    low, high = np.nanpercentile(values, (1, 99))
    return float(high - low)
