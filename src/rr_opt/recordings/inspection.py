"""The single entry point: a recording is read, put on the command's clock, cleaned and examined."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from rr_opt.files.experiment_file import layout_from, layout_in
from rr_opt.files.issue import InvalidFileError, Issue, refuse, required
from rr_opt.files.problem_file import kind_of
from rr_opt.files.source import read_document
from rr_opt.messages import shown
from rr_opt.model.experiment import Layout, Recording, Start
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot
from rr_opt.outcome import InputError
from rr_opt.recordings.cleaning import Cleaned, clean
from rr_opt.recordings.clock_fit import ClockFit
from rr_opt.recordings.markers.calibration import Calibration
from rr_opt.recordings.markers.pose import MarkerFit, fit_markers
from rr_opt.recordings.nuisances import nuisances
from rr_opt.recordings.nuisances.evidence import ExaminedRecording
from rr_opt.recordings.readers import MarkerData, ReadOptions, ServoLog, read_file
from rr_opt.recordings.servo_clock import Synchrony, synchronised


@dataclass(frozen=True, kw_only=True)
class Circumstances:
    """What is known about a recording besides its file; all of it may be unknown.

    robot    as its builder believes it to be
    layout   of the markers, or as recordings of the robot show it; None: as this one shows it
    options  with which its files are read
    """

    robot: Robot | None = None
    layout: Layout | Calibration | None = None
    options: ReadOptions = field(default_factory=ReadOptions)
    gait: Gait | None = None
    start: Start = "running"
    servo_log: Path | None = None


@dataclass(frozen=True)
class Inspection:
    """The findings on one recording.

    markers    the rigid fit, of marker files
    gait       the command, where it is known
    command    phi against it
    synchrony  what the servo's log says about the clocks, where there is one
    doubts     all of them: of reading, of the log, of cleaning, and of phi against its command
    """

    cleaned: Cleaned
    markers: MarkerFit | None
    gait: Gait | None
    command: ClockFit | None
    synchrony: Synchrony | None
    doubts: tuple[str, ...]

    @property
    def recording(self) -> Recording:
        """With all flags set, and all doubts."""
        return self.cleaned.recording

    @property
    def name(self) -> str:
        """Of the file."""
        return self.recording.name


def inspected(file: Path, known: Circumstances, *, layout: Path | None = None) -> Inspection:
    """The content of a file, with all that is known of it.

    layout: a YAML file with the markers' places. Raises InvalidFileError with all errors in the
    file and in the servo's log, and InputError, naming the file, if it is another kind of file.
    """
    if layout is not None:
        known = replace(known, layout=read_layout(layout))
    found = in_file(file, *read_both(file, known), known)
    if layout is not None and found.markers is None:
        refuse(
            str(layout),
            f"Read the places of markers. Expected a marker file to go with them, but {file.name} "
            "already has the motion. Omit --layout.",
        )
    return found


def in_file(
    file: Path, read: Recording | MarkerData, log: ServoLog | None, known: Circumstances
) -> Inspection:
    """The same of its content. Raises InvalidFileError if markers make no robot."""
    try:
        return inspect(read, log, known)
    except InputError as error:
        refuse(str(file), str(error))


def read_both(file: Path, known: Circumstances) -> tuple[Recording | MarkerData, ServoLog | None]:
    """What a file and its servo's log hold.

    Raises InvalidFileError with all errors in both, and InputError, naming the file, if one is
    another kind of file.
    """
    found: list[Any] = []
    issues: list[Issue] = []
    for path, log in ((file, False), (known.servo_log, True)):
        try:
            options = replace(known.options, log=log)
            found.append(None if path is None else read_file(path, options))
        except InvalidFileError as error:
            issues += error.issues
    if issues:
        raise InvalidFileError(issues)
    read, log = found
    if isinstance(read, ServoLog):
        raise InputError(
            f"Read {shown(file.name)}, a servo's log. Expected a recording of the robot. Name the "
            "log under `servo_log`, or with --servo-log, beside a recording."
        )
    if known.servo_log is not None and not isinstance(log, ServoLog):
        raise InputError(
            f"Read {shown(known.servo_log.name)}, which is no servo's log. Expected CSV with the "
            "header row `t,goal,present`. Name it under `file` if it is the recording."
        )
    noise = known.options.noise
    if noise is not None and isinstance(read, MarkerData) and read.lever is not None:
        read = replace(read, lever=noise.position / noise.angle)
    return read, log


def inspect(read: Recording | MarkerData, log: ServoLog | None, known: Circumstances) -> Inspection:
    """Inspect the content of a file. Raises InputError if markers make no robot."""
    markers = synchrony = None
    if isinstance(read, MarkerData):
        layout, noise = known.layout, known.options.noise
        if isinstance(layout, Layout):
            layout = layout_for(read, layout)
        markers = fit_markers(read, layout, noise.position if noise else None)
        recording = markers.recording
        if read.lever is not None and noise is None:
            # Poses show no noise of their own.
            sigma = {one: np.full(len(recording), np.nan) for one in recording.channels}
            recording = replace(recording, sigma=MappingProxyType(sigma))
    else:
        recording = read
    if log is not None:
        synchrony = synchronised(recording, log, known.gait, known.start)
        doubts = (*recording.doubts, *log.doubts, *synchrony.doubts)
        recording = replace(synchrony.recording, doubts=doubts)
    if markers is not None:
        markers = replace(markers, recording=recording)
    cleaned = clean(recording)
    evidence = ExaminedRecording(
        cleaned.recording, known.robot, known.gait, known.start,
        clock_known=synchrony is not None and synchrony.shift is not None,
        framed=markers is None or known.layout is not None,
    )  # fmt: skip
    doubts = (*recording.doubts, *cleaned.doubts)
    if not any(one.level == "error" for one in cleaned.doubts):
        doubts += nuisances(evidence)
    cleaned = replace(cleaned, recording=replace(cleaned.recording, doubts=doubts))
    return Inspection(cleaned, markers, known.gait, evidence.command, synchrony, doubts)


def layout_for(data: MarkerData, stated: Layout) -> Layout:
    """The layout under the names that a file's markers have, whose subject may be left out.

    Raises InputError if the file lacks all markers of a platform.
    """
    subject = f"{data.source.get('subject', '')}:"
    platforms = []
    for platform, given in (("platform1", stated.platform1), ("platform2", stated.platform2)):
        named = {name.removeprefix(subject): place for name, place in given.items()}
        if not set(named) & set(data.labels):
            raise InputError(
                f"Read the markers {shown(', '.join(data.labels))}. Expected some of "
                f"`markers.{platform}`: {shown(', '.join(given))}. Correct the names."
            )
        platforms.append(named)
    return Layout(*platforms, up=stated.up)


def read_layout(path: Path) -> Layout:
    """The places of markers in a YAML file: its own keys, or those of its section `markers`.

    Raises InvalidFileError.
    """
    document = read_document(path)
    if "markers" in document.data:
        return required(*layout_in(document))
    if "robot" in document.data and kind_of(document) == "experiment":
        message = "Read an experiment without `markers`. Expected the places of markers. Add them."
        raise InvalidFileError([document.error((), message)])
    return required(*layout_from(document))
