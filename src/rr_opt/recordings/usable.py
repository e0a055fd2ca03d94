"""Which recordings of an experiment can be diagnosed, and what is wrong with the others."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.model.experiment import CHANNELS, Experiment, Run
from rr_opt.model.robot import Robot
from rr_opt.outcome import InputError
from rr_opt.recordings.against_plan import HALF_A_PERIOD, plan_doubts
from rr_opt.recordings.channel_warnings import unit_doubts
from rr_opt.recordings.noise import noise_stated_doubts
from rr_opt.recordings.warnings import Doubt, texts

_FEWEST = 50
"""Samples of a channel below which nothing is told."""
_PERIODS = 2.0
"""A shorter recording holds a start and no more."""
_STILL = 10.0
"""What moves by less, in sigma of the noise, over 98 % of the samples, stands still."""
_COMMANDED = 0.2
"""A servo that moves that much of its amplitude follows its command, whatever the noise."""
_GRAVE = ("units", "command")
"""Doubts with which nothing can be fitted."""
_LARGEST_GAP = 4.0
"""Seconds without any data of a channel; the motion in between is then nobody's."""


@dataclass(frozen=True)
class Checked:
    """What speaks against diagnosing the recordings.

    why     of each why it tells nothing, empty if it does
    doubts  of each
    wrong   sentences on what cannot be as the experiment says: units, signs, the gait
    """

    why: Mapping[str, str]
    doubts: Mapping[str, tuple[Doubt, ...]]
    wrong: tuple[str, ...]

    @property
    def left_out(self) -> tuple[str, ...]:
        """A sentence on each recording that tells nothing."""
        return tuple(f"{name}: {text} It is left out." for name, text in self.why.items() if text)

    @property
    def said(self) -> tuple[str, ...]:
        """A sentence on each doubt."""
        return tuple(f"{name}: {text}" for name, own in self.doubts.items() for text in texts(own))


def checked(experiment: Experiment) -> Checked:
    """Look at every recording."""
    why = {run.name: _why_not(run) for run in experiment.runs}
    doubts = {run.name: _doubts(run, experiment.robot, why[run.name]) for run in experiment.runs}
    wrong = [f"{name}: {one}" for name, own in doubts.items() for one in own if one.kind in _GRAVE]
    if not wrong and _other_sign(own for name, own in doubts.items() if not why[name]):
        wrong.append(
            "phi is half a period off its command in every recording. Expected phi positive where "
            "platform 2 turns counter-clockwise against platform 1, and psi counter-clockwise too, "
            "seen from above. Correct the sign of both, or of phi alone if psi is right."
        )
    return Checked(why, doubts, tuple(wrong))


def _other_sign(doubts: Iterable[tuple[Doubt, ...]]) -> bool:
    """Whether phi is half a period off in several recordings, and in all."""
    off = [any(one.kind == HALF_A_PERIOD for one in own) for own in doubts]
    return len(off) > 1 and all(off)


def usable(experiment: Experiment) -> tuple[Experiment, tuple[str, ...]]:
    """The experiment without the recordings that tell nothing, and a sentence on each of those.

    Raises InputError for recordings in another unit or of another gait than the experiment says,
    and where no recording is left to fit.
    """
    found = checked(experiment)
    if found.wrong:
        raise InputError("\n".join(found.wrong))
    runs = tuple(run for run in experiment.runs if not found.why[run.name])
    if not any(run.use == "fit" for run in runs):
        if not found.left_out:
            raise InputError(
                "All recordings are held out. Expected some to fit. Mark them with `use: fit`."
            )
        reasons = "\n".join(f"{name}: {text}" for name, text in found.why.items() if text)
        raise InputError(
            f"{reasons}\nNo recording to fit is left, so nothing can be told of this robot. "
            "Record some periods in which it drives."
        )
    runs = tuple(_with_doubts(run, found.doubts[run.name]) for run in runs)
    return replace(experiment, runs=runs), found.left_out


def _with_doubts(run: Run, doubts: tuple[Doubt, ...]) -> Run:
    recording = run.recording
    said = (*recording.doubts, *texts(doubts))
    return replace(run, recording=replace(recording, doubts=said)) if doubts else run


def _doubts(run: Run, robot: Robot, why_not: str) -> tuple[Doubt, ...]:
    """Whether a recording, if it tells something, is what the experiment file says."""
    wrong = unit_doubts(run.recording)
    if wrong or why_not:
        return wrong
    return plan_doubts(run, robot) + noise_stated_doubts(run.recording)


def _why_not(run: Run) -> str:
    """Why a recording tells nothing; empty if it does."""
    recording = run.recording
    t, period = recording.t, run.gait.period
    data = {name: recording.data(name) for name in CHANNELS}
    counts = {name: int(np.isfinite(values).sum()) for name, values in data.items()}
    least = min(counts, key=lambda name: counts[name])
    if counts[least] == 0:
        return f"There are no data of {least}. Expected x, y, psi and phi."
    seconds = float(t[-1] - t[0])
    if seconds < _PERIODS * period or counts[least] < _FEWEST:
        return (
            f"Read {seconds:.3g} s of a gait with a period of {period:.3g} s, and "
            f"{counts[least]} values of {least}: too short to tell. Expected at least "
            f"{_PERIODS:g} periods and {_FEWEST} values."
        )
    for name, values in data.items():
        known = t[np.isfinite(values)]
        gap = float(np.diff(np.concatenate([t[:1], known, t[-1:]])).max())
        if gap > _LARGEST_GAP:
            return (
                f"Read no {name} for {gap:.3g} s. Expected gaps of at most {_LARGEST_GAP:g} s. "
                "Cut the recording there."
            )
    return _why_still(run, {name: _range(values) for name, values in data.items()})


def _why_still(run: Run, moved: Mapping[str, float]) -> str:
    """Why what moves so far tells nothing; empty if it does."""
    sigmas = {name: moved[name] / _sigma(run, name) for name in moved}
    if sigmas["phi"] < _STILL:
        if moved["phi"] > _COMMANDED * run.gait.amplitude > 0:
            return (
                f"phi moves by {moved['phi']:.3g} rad, next to nothing beside its stated noise of "
                f"{_sigma(run, 'phi'):.3g} rad: too noisy to tell. Correct `noise.angle` if that "
                "is not the noise."
            )
        return "The servo does not move: too still to tell. Expected it to follow its command."
    if max(sigmas[name] for name in ("x", "y", "psi")) < _STILL:
        return "The robot does not move: too still to tell. Expected it to drive."
    return ""


def _range(values: np.ndarray) -> float:
    low, high = np.nanpercentile(values, (1, 99))
    return float(high - low)


def _sigma(run: Run, name: str) -> float:
    return float(np.nanmedian(run.recording.sigma[name]))
