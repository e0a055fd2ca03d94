"""Which recordings of an experiment can be diagnosed, and whether they are what its file says.

Nothing is put right: the experimenter has to say. A fault of the robot is no reason to refuse: a
servo that lags, slips behind or has play makes an angle of the command's period, near its size and
time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.array import Array
from rr_opt.model.experiment import CHANNELS, Experiment, Recording, Run
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot
from rr_opt.outcome import InputError
from rr_opt.recordings.channel_checks import unit_notices
from rr_opt.recordings.noise import noise_of
from rr_opt.recordings.warnings import Notice, notice, size_text

_FEWEST = 50
"""Samples of a channel below which nothing is told."""
_PERIODS = 2.0
"""A shorter recording holds a start and no more."""
_STILL = 10.0
"""What moves by less, in sigma of the noise, over 98 % of the samples, stands still."""
_COMMANDED = 0.2
"""A servo that moves that much of its amplitude follows its command, whatever the noise."""
_LARGEST_GAP = 4.0
"""Seconds without any data of a channel; the motion in between is then nobody's."""


@dataclass(frozen=True)
class Checked:
    """What speaks against diagnosing the recordings.

    useless  by name, why it tells nothing, of those that do not
    doubts   by name, whether it is what the experiment says, of all
    wrong    sentences on what cannot be as the experiment says: units, signs, the gait; or that no
             recording is left to fit
    """

    useless: Mapping[str, Notice]
    doubts: Mapping[str, tuple[Notice, ...]]
    wrong: tuple[str, ...]

    @property
    def left_out(self) -> tuple[str, ...]:
        """A sentence on each recording that tells nothing."""
        return tuple(f"{name}: {why} It is left out." for name, why in self.useless.items())

    @property
    def said(self) -> tuple[str, ...]:
        """A sentence on each doubt."""
        return tuple(f"{name}: {one}" for name, own in self.doubts.items() for one in own)


def checked(experiment: Experiment) -> Checked:
    """Look at every recording."""
    useless = dict(_useless(experiment))
    doubts = {
        run.name: _doubts(run, experiment.robot, useless=run.name in useless)
        for run in experiment.runs
    }
    wrong = [
        f"{name}: {one}" for name, own in doubts.items() for one in own if one.level == "error"
    ]
    if not wrong and _other_sign(own for name, own in doubts.items() if name not in useless):
        wrong.append(notice("command.signs"))
    fitted = [run.name for run in experiment.runs if run.use == "fit"]
    if not wrong and not fitted:
        wrong.append(
            "All recordings are held out. Expected some to fit. Mark them with `use: fit`."
        )
    elif not wrong and all(name in useless for name in fitted):
        wrong.append(
            "No recording to fit is left, so nothing can be told of this robot. Record some "
            "periods in which it drives."
        )
    return Checked(useless, doubts, tuple(wrong))


def usable(experiment: Experiment) -> tuple[Experiment, tuple[str, ...]]:
    """The experiment without the recordings that tell nothing, and a sentence on each of those.

    Raises InputError for recordings in another unit or of another gait than the experiment says,
    and where no recording is left to fit.
    """
    found = checked(experiment)
    if found.wrong:
        reasons = (f"{name}: {why}" for name, why in found.useless.items())
        raise InputError("\n".join((*reasons, *found.wrong)))
    runs = tuple(
        _with_doubts(run, found.doubts[run.name])
        for run in experiment.runs
        if run.name not in found.useless
    )
    return replace(experiment, runs=runs), found.left_out


def _with_doubts(run: Run, doubts: tuple[Notice, ...]) -> Run:
    recording = run.recording
    return replace(run, recording=replace(recording, doubts=(*recording.doubts, *doubts)))


def _other_sign(doubts: Iterable[tuple[Notice, ...]]) -> bool:
    """Whether phi is half a period off in several recordings, and in all."""
    off = [any(one.code == "command.half" for one in own) for own in doubts]
    return len(off) > 1 and all(off)


def _doubts(run: Run, robot: Robot, *, useless: bool) -> tuple[Notice, ...]:
    """Whether a recording, if it tells something, is what the experiment file says."""
    wrong = unit_notices(run.recording)
    if wrong or useless:
        return wrong
    return (*plan_notices(run, robot), *_stated_noise(run.recording))


def _useless(experiment: Experiment) -> Iterator[tuple[str, Notice]]:
    """Names, and why they tell nothing. What is to be fitted goes before what is held out."""
    seen: list[Run] = []
    for run in sorted(experiment.runs, key=lambda one: one.use != "fit"):
        why = _why_not(run)
        copied = next((one for one in seen if _same(one.recording, run.recording)), None)
        if why is None and copied is not None:
            why = notice("useless.copy", other=copied.name)
        if why is not None:
            yield run.name, why
        seen.append(run)


def _same(one: Recording, two: Recording) -> bool:
    return len(one) == len(two) and all(
        np.array_equal(one.values[name], two.values[name], equal_nan=True) for name in CHANNELS
    )


def _why_not(run: Run) -> Notice | None:
    """Why a recording tells nothing; None if it does."""
    recording = run.recording
    t, period = recording.t, run.gait.period
    data = {name: recording.data(name) for name in CHANNELS}
    counts = {name: int(np.isfinite(values).sum()) for name, values in data.items()}
    least = min(counts, key=lambda name: counts[name])
    if counts[least] == 0:
        return notice("useless.empty", channel=least)
    seconds = float(t[-1] - t[0])
    if seconds < _PERIODS * period or counts[least] < _FEWEST:
        return notice(
            "useless.short", seconds=seconds, period=period, count=counts[least], channel=least,
            periods=_PERIODS, least=_FEWEST,
        )  # fmt: skip
    for name, values in data.items():
        known = t[np.isfinite(values)]
        gap = float(np.diff(np.concatenate([t[:1], known, t[-1:]])).max())
        if gap > _LARGEST_GAP:
            return notice("useless.gap", channel=name, gap=gap, most=_LARGEST_GAP)
    return _why_still(run, {name: _range(values) for name, values in data.items()})


def _why_still(run: Run, moved: Mapping[str, float]) -> Notice | None:
    """Why what moves so far tells nothing; None if it does."""
    stated = {name: float(np.nanmedian(run.recording.sigma[name])) for name in CHANNELS}
    sigmas = {name: moved[name] / stated[name] for name in moved}
    if sigmas["phi"] < _STILL:
        if moved["phi"] > _COMMANDED * run.gait.amplitude > 0:
            return notice("useless.noisy", moved=moved["phi"], sigma=stated["phi"])
        return notice("useless.servo")
    if max(sigmas[name] for name in ("x", "y", "psi")) < _STILL:
        return notice("useless.robot")
    return None


def _range(values: Array) -> float:
    low, high = np.nanpercentile(values, (1, 99))
    return float(high - low)


_KEYS = {"noise.position": ("x", "y"), "noise.angle": ("psi", "phi")}
_STATED_FAR = 5.0
"""Times the scatter, or the other way round, that are far: a capture that was smoothed scatters a
few times less at the highest frequencies than it errs."""


def _stated_noise(recording: Recording) -> Iterator[Notice]:
    """One for each noise of the experiment file that is far from what its channels scatter by.

    Too large, it hides what is missing; too small, it makes every difference one that matters. The
    noise of a motion that was fitted to markers is not stated.
    """
    if "motion" in recording.source:
        return
    for key, names in _KEYS.items():
        told = (_far_from_scatter(recording, key, name) for name in names)
        yield from [one for one in told if one is not None][:1]


def _far_from_scatter(recording: Recording, key: str, name: str) -> Notice | None:
    seen = noise_of(recording.data(name))
    stated = float(np.nanmedian(recording.sigma[name]))
    times = seen.times(stated)
    if 1 / _STATED_FAR <= times <= _STATED_FAR or np.isnan(times):
        return None
    small = "What is smaller than that is not found."
    large = "Every difference larger than that counts as a mismatch."
    return notice(
        "noise.stated", channel=name, stated=size_text(name, stated), key=key,
        noise=size_text(name, seen.sigma), why=small if times < 1 else large,
    )  # fmt: skip


_LENGTHS = 5.0
"""No robot drives so many of its own lengths in a period."""
_HEADING = 6.0
"""Nor does its heading swing so many times as far as phi: in degrees it is 57 times too far."""
_SIZE = 20.0
"""Times as far as told, or as little, phi moves in another unit only."""
_ALIKE = 0.5
"""Of phi's variance that is the gait's where that was driven."""
_OTHER = 0.8
"""The same of a sine of another period, where that was driven."""
_LATE, _HALF = 0.3, 0.45
"""Of a period; a servo that lags stays below a quarter, and the other sign is half of one."""
_FAR = 1.3
"""Times as far as commanded, or as little, phi moves with a grave fault, or another command."""
_SHIFTS = 64
_LOOK = 60.0
"""So many seconds show the period, s."""
_TOO_FAR, _NOT_FAR = 10.0, 0.05
"""Times as far sideways as a turn takes the joint, or as little, in another unit only. Wheels that
slide leave 0.7."""
_ALONG = 0.5
"""A smaller part than this is not that of a frame that is right."""
_BETTER, _ALMOST = 2.0, 1.15
"""Times as much that is left in a wrong frame, and in one that may be right too."""
_WITH, _STRIDE = 0.7, 5
"""Correlation of the angles' steps, over so many samples, from which on they turn together."""


def plan_notices(run: Run, robot: Robot) -> tuple[Notice, ...]:
    """Why a recording that moves is not of this robot and this gait, in these units.

    Nothing can be fitted with errors; nor if all recordings have `command.half`. Other warnings may
    be a fault of the robot after all.
    """
    t, period = run.recording.t, run.gait.period
    channels = {name: run.recording.data(name) for name in CHANNELS}
    sizes = {name: _swing(t, values, period) for name, values in channels.items()}
    x, y, psi, phi = channels.values()
    length = robot.platform1.c + robot.platform2.c
    units, signs = tuple(_of_units(sizes, length)), tuple(_of_signs(psi, phi))
    frame = () if units or signs else _of_frame(x, y, psi, robot.platform1.c)
    return (*_of_command(t, phi, run.gait), *units, *frame, *signs)


def _of_units(sizes: dict[str, float], length: float) -> Iterator[Notice]:
    if (driven := max(sizes["x"], sizes["y"])) > _LENGTHS * length:
        yield notice("units.length", driven=driven, length=length)
    if sizes["psi"] > _HEADING * sizes["phi"] > 0:
        yield notice("units.heading", psi=sizes["psi"], phi=sizes["phi"])


_FRAMES: dict[str, Callable[[Array, Array], tuple[Array, Array]]] = {
    "x and y exchanged": lambda x, y: (y, x),
    "x mirrored": lambda x, y: (-x, y),
    "y mirrored": lambda x, y: (x, -y),
    "psi turned by 180 deg": lambda x, y: (-x, -y),
    "psi turned by 90 deg": lambda x, y: (y, -x),
    "psi turned by -90 deg": lambda x, y: (-y, x),
}
"""What may be wrong with a frame, and how to put it right."""


def _of_frame(x: Array, y: Array, psi: Array, c: float) -> Iterator[Notice]:
    """A turn of platform 1 about its axle takes the joint c sideways; wheels that slip, less."""
    share, left = _sideways(x, y, psi, c)
    others = {what: _sideways(*right(x, y), psi, c)[1] for what, right in _FRAMES.items()}
    best = min(others.values())
    if share < _ALONG and left > _BETTER * best:
        meant = [what for what, off in others.items() if off < _ALMOST * best]
        yield notice("units.frame", meant=" or ".join(meant), left=1e3 * left, best=1e3 * best)
    elif abs(share) > _TOO_FAR or 0 < abs(share) < _NOT_FAR:
        unit = "millimetres or centimetres" if abs(share) > 1 else "another unit"
        yield notice("units.sideways", ratio=abs(share), unit=unit)


def _sideways(x: Array, y: Array, psi: Array, c: float) -> tuple[float, float]:
    """The part of c by which turns take the joint sideways, and what is left of its way, m."""
    dx, dy, turned = (values[_STRIDE:] - values[:-_STRIDE] for values in (x, y, psi))
    heading = (psi[_STRIDE:] + psi[:-_STRIDE]) / 2
    side = np.cos(heading) * dy - np.sin(heading) * dx
    known = np.isfinite(side) & np.isfinite(turned)
    # The joint is behind the axle: psi is the heading from it towards there.
    side, turned = side[known], -c * turned[known]
    swings = float(turned @ turned)
    if not swings > 0:
        return 0.0, 0.0
    return float(side @ turned) / swings, float(np.sqrt(np.mean((side - turned) ** 2)))


def _of_signs(psi: Array, phi: Array) -> Iterator[Notice]:
    # The platforms turn against each other, whether the wheels hold or slip.
    one, two = (values[_STRIDE:] - values[:-_STRIDE] for values in (psi, phi))
    known = np.isfinite(one) & np.isfinite(two)
    if np.corrcoef(one[known], two[known])[0, 1] > _WITH:
        yield notice("units.sign")


def _of_command(t: Array, phi: Array, gait: Gait) -> Iterator[Notice]:
    known = np.isfinite(phi)
    t, phi = t[known], phi[known]
    commanded = float(np.ptp(gait.angle(np.linspace(0, gait.period, 200))))
    if not commanded > 0:
        return
    moved = _swing(t, phi, gait.period)
    if moved > _SIZE * commanded or _SIZE * moved < commanded:
        yield notice("units.phi", moved=moved, commanded=commanded)
        return
    shifts = gait.period * (np.arange(_SHIFTS) / _SHIFTS - 0.5)
    alike = [float(np.corrcoef(phi, gait.angle(t + shift))[0, 1]) for shift in shifts]
    best = int(np.argmax(alike))
    if alike[best] ** 2 < _ALIKE:
        period, share = _period(t, phi)
        if share > _OTHER:
            yield notice("command.period", period=period, commanded=gait.period)
        return
    late = abs(shifts[best])
    if late > _LATE * gait.period:
        code = "command.half" if late > _HALF * gait.period else "command.late"
        yield notice(code, late=late, period=gait.period)
    if not 1 / _FAR < moved / commanded < _FAR:
        yield notice("command.size", times=moved / commanded)


def _period(t: Array, phi: Array) -> tuple[float, float]:
    """The period of the sine that explains most of phi, and how much of its variance that is."""
    phi = phi[t < t[0] + _LOOK]
    t = t[: len(phi)]
    span = float(t[-1] - t[0])
    step = float(np.median(np.diff(t)))
    rates = np.arange(1.0, min(span / (4 * step), 60 * span), 0.25) / span
    shares = []
    for rate in rates:
        turn = 2 * np.pi * rate * t
        shares.append(_explained(phi, [np.sin(turn), np.cos(turn)]))
    best = int(np.argmax(shares))
    return 1 / float(rates[best]), shares[best]


def _explained(y: Array, columns: list[Array]) -> float:
    """Of y's variance, what a constant and multiples of the columns explain."""
    A = np.column_stack([np.ones(len(y)), *columns])
    left = y - A @ np.linalg.lstsq(A, y, rcond=None)[0]
    return 1 - float(left @ left) / max(len(y) * float(np.var(y)), 1e-300)


def _swing(t: Array, y: Array, period: float) -> float:
    """How far y ranges within a period, the median over the recording; outliers left out."""
    begins = np.flatnonzero(np.diff(np.floor((t - t[0]) / period)) > 0) + 1
    ranges = []
    for piece in np.split(y, begins):
        inside = piece[np.isfinite(piece)]
        if len(inside) > 3:
            low, high = np.percentile(inside, (2, 98))
            ranges.append(high - low)
    return float(np.median(ranges)) if ranges else 0.0
