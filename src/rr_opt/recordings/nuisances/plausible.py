"""Implausible or uninformative recordings: empty, short, full of gaps, still, noisy."""

from collections.abc import Iterator

import numpy as np

from rr_opt.array import Array
from rr_opt.model.experiment import CHANNELS, Recording
from rr_opt.recordings.nuisances.evidence import ExaminedRecording
from rr_opt.recordings.time_axis import time_step
from rr_opt.recordings.warnings import Notice, notice

_FEWEST = 50
"""Least samples of a channel."""
_PERIODS = 2.0
"""A shorter recording shows a start and no more."""
_LARGEST_GAP = 4.0
"""Seconds without any data of a channel beyond which the motion in between is unknown."""
_STILL = 10.0
"""A range, in sigma of the noise, over 98 % of the samples, below which a channel stands still."""
_COMMANDED = 0.2
"""A servo that moves by this share of its amplitude follows its command, whatever the noise."""
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
    moved = np.array([np.subtract(*np.nanpercentile(y, (99, 1))) for y in data.values()])
    sizes = moved / given.sigma
    if sizes[3] < _STILL and given.gait and moved[3] > _COMMANDED * given.gait.amplitude > 0:
        yield notice("useless.noisy", moved=moved[3], sigma=given.sigma[3])
    if sizes[3] < _STILL:
        yield notice("useless.servo", moved=moved[3])
    if sizes[:3].max() < _STILL:
        yield notice("useless.robot")


_ROOM, _NO_ROOM = 50.0, 1e5
"""No floor on which a small robot is recorded is this long in m, or in mm."""
_NO_ANGLE = 1000.0
"""No servo turns this far in rad, or in degrees."""
_SLOWEST = 0.5
"""Capture systems sample more often than this, s."""
_LATEST = 1e6
"""Nor do they begin later than this after the command, eleven days, s."""


def unit_notices(recording: Recording) -> Iterator[Notice]:
    """What looks like another unit. Nothing is converted: the experimenter has to say."""
    t, step = recording.t, time_step(recording.t)
    if len(t) and abs(t[0]) > _LATEST:
        yield notice("units.calendar", start=t[0])
    elif len(t) > 2 and abs(step - 1) < 1e-6:
        yield notice("units.frames")
    elif len(t) > 2 and step >= _SLOWEST:
        yield notice("units.milliseconds" if step < 1000 * _SLOWEST else "units.time", step=step)
    x, y, phi = (_ends(recording.data(name)) for name in ("x", "y", "phi"))
    ranges = float(np.ptp(x)), float(np.ptp(y))
    if max(ranges) > _NO_ROOM:
        yield notice("units.place", widest=max(ranges))
    elif max(ranges) > _ROOM:
        yield notice("units.millimetres", ranges=" and ".join(f"{size:.4g}" for size in ranges))
    largest = float(np.abs(phi).max())
    if largest > 2 * np.pi:
        yield notice("units.angle" if largest > _NO_ANGLE else "units.degrees", largest=largest)


def _ends(values: Array) -> Array:
    """The ends of the range of 99 %: what a single sample says is no unit."""
    known = values[np.isfinite(values)]
    if not len(known):
        return np.zeros(2)
    return np.array(
        [np.percentile(known, 0.5, method="higher"), np.percentile(known, 99.5, method="lower")]
    )


_HEADING = 6.0
"""A heading swings no further, relative to phi: in degrees it is 57 times too far."""


def look_at_units(given: ExaminedRecording) -> Iterator[Notice]:
    """Angles in another unit, by the gait."""
    if given.gait is None:
        return
    psi, phi = (_swing(given.t, one, given.gait.period) for one in given.motion[2:])
    if psi > _HEADING * phi > 0:
        yield notice("units.heading", psi=psi, phi=phi)


def _swing(t: Array, y: Array, period: float) -> float:
    """How far y ranges within a period, the median over the recording; outliers left out."""
    begins = np.flatnonzero(np.diff(np.floor((t - t[0]) / period)) > 0) + 1
    ranges = []
    for piece in np.split(y, begins):
        inside = np.sort(piece[np.isfinite(piece)])
        last = len(inside) - 1
        if last > 2:
            low, high = np.interp((0.02 * last, 0.98 * last), np.arange(last + 1), inside)
            ranges.append(high - low)
    return float(np.median(ranges)) if ranges else 0.0
