"""One entry of an experiment's `recordings`, read: the recording, its servo log, every doubt."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rr_opt.experiment.experiment import Run
from rr_opt.experiment.recording import Recording
from rr_opt.files.experiment.plan import ExperimentPlan, MarkerPlaces, PlannedRun
from rr_opt.files.issue import InvalidFileError, Issue, has_errors, shown
from rr_opt.outcome import InputError
from rr_opt.recordings.layout import Layout
from rr_opt.recordings.markers_file import MarkerData
from rr_opt.recordings.netcdf import commanded_gait, is_netcdf
from rr_opt.recordings.readers import read_file
from rr_opt.recordings.servo_log_file import ServoLog


@dataclass(frozen=True)
class ReadRun:
    """A run as its files have it, and the servo's log of it."""

    run: Run
    log: ServoLog | None


def read_run(
    plan: ExperimentPlan, number: int, planned: PlannedRun
) -> tuple[ReadRun | None, list[Issue]]:
    """The run (None if an issue is an error), and all issues; nothing is raised."""
    issues: list[Issue] = []
    recording = log = None
    try:
        recording = _recording(plan, planned.file)
        issues += _other_command(plan, number, planned, recording)
    except InputError as error:
        issues += _issues(plan, number, "file", error)
    try:
        log = _servo_log(plan, planned.servo_log) if planned.servo_log else None
    except InputError as error:
        issues += _issues(plan, number, "servo_log", error)
    for one in (recording, log):
        if one is not None:
            issues += [
                Issue("warning", "", doubt, None, one.source.get("file", one.name))
                for doubt in one.doubts
            ]
    if recording is None or has_errors(issues):
        return None, issues
    return ReadRun(Run(recording, planned.gait, planned.use, planned.start), log), issues


def _other_command(
    plan: ExperimentPlan, number: int, planned: PlannedRun, recording: Recording
) -> list[Issue]:
    """A warning where a file that says what was commanded says something else.

    Raises InputError if what it says cannot be read.
    """
    if not is_netcdf(planned.file):
        return []
    said = commanded_gait(planned.file)
    if said is None or np.allclose(said.angle(recording.t), planned.gait.angle(recording.t)):
        return []
    message = "Read another gait than the file says was commanded. The one written here was taken."
    return [plan.document.issue("warning", ("recordings", number, "gait"), message)]


def _issues(plan: ExperimentPlan, number: int, key: str, error: InputError) -> list[Issue]:
    """What went wrong with a file: where it went wrong in it, or else where the file is named."""
    if isinstance(error, InvalidFileError):
        return list(error.issues)
    return [plan.document.issue("error", ("recordings", number, key), str(error))]


def _recording(plan: ExperimentPlan, file: Path) -> Recording:
    """The motion that a file holds. Raises InputError."""
    read = read_file(file, plan.noise, plan.counts)
    if isinstance(read, ServoLog):
        raise InputError(
            f"Read {shown(file.name)}, a servo's log. Expected a recording of the robot. "
            "Name the log under `servo_log`."
        )
    if isinstance(read, Recording):
        return read
    if plan.markers is None:
        raise InputError(
            f"Read {shown(file.name)}, a marker file. Expected `markers`, the place of each on "
            f"the robot; the file has {shown(', '.join(read.labels))}. Add the key."
        )
    # Here and not above: it loads scipy, which a plain recording does without.
    from rr_opt.recordings.from_markers import recording_from_markers  # noqa: PLC0415

    return recording_from_markers(read, layout_for(read, plan.markers), plan.noise.position)


def layout_for(data: MarkerData, places: MarkerPlaces) -> Layout:
    """The layout under the names that a file's markers have, whose subject may be left out.

    Raises InputError if the file lacks all markers of a platform.
    """
    subject = f"{data.source.get('subject', '')}:"
    platforms = []
    for platform, given in (("platform1", places.platform1), ("platform2", places.platform2)):
        named = {name.removeprefix(subject): place for name, place in given.items()}
        if not set(named) & set(data.labels):
            raise InputError(
                f"Read the markers {shown(', '.join(data.labels))} in {shown(data.name)}. Expected "
                f"some of `markers.{platform}`: {shown(', '.join(given))}. Correct the names."
            )
        platforms.append(named)
    return Layout(*platforms, up=places.up)


def _servo_log(plan: ExperimentPlan, file: Path) -> ServoLog:
    read = read_file(file, plan.noise, plan.counts)
    if not isinstance(read, ServoLog):
        raise InputError(
            f"Read {shown(file.name)}, which is no servo's log. Expected CSV with the header row "
            "`t,goal,present`. Name it under `file` if it is the recording."
        )
    return read
