"""A folder with an experiment file and its recordings, to an Experiment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from rr_opt.files.experiment_file import FILE_NAME, experiment_path, named_files, read_plan
from rr_opt.files.experiment_plan import ExperimentPlan, MarkerPlaces, PlannedRun
from rr_opt.files.issue import InvalidFileError, Issue, has_errors
from rr_opt.messages import shown
from rr_opt.model.experiment import Experiment, Recording, Run
from rr_opt.outcome import InputError
from rr_opt.recordings.markers.layout import Layout
from rr_opt.recordings.readers.marker_rows import MarkerData
from rr_opt.recordings.readers.netcdf import commanded_gait, is_netcdf
from rr_opt.recordings.readers.registry import read_file
from rr_opt.recordings.readers.servo_log import ServoLog
from rr_opt.recordings.warnings import texts


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
    from rr_opt.recordings.markers.pose import recording_from_markers

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


def read_experiment(folder: str | Path) -> Experiment:
    """The experiment of a folder with `experiment.yaml`, or of that file, recordings cleaned.

    A recording with a servo's log is put on the command's clock, as far as the log can tell it.
    Raises InvalidFileError with everything that is wrong in the file and in every recording.
    """
    file = experiment_path(Path(folder))
    if file != Path(folder) and not file.exists():
        raise InputError(
            f"{folder}: Read a folder without {FILE_NAME}. Expected that file, which names the "
            "robot and the recordings. `rr-opt schema experiment` tells its keys."
        )
    plan, read, issues = _read(folder)
    if plan is None:
        raise InvalidFileError(issues)
    return _experiment(plan, [_cleaned(one) for one in read])


def experiment_of(folder: str | Path) -> tuple[Experiment | None, list[Issue]]:
    """The experiment as read (None if an issue is an error), and all issues, doubts as warnings.

    A file that cannot be read is an issue too; nothing is raised, and no recording is cleaned.
    """
    plan, read, issues = _read(folder)
    if plan is None:
        return None, issues
    return _experiment(plan, [one.run for one in read]), issues


def _experiment(plan: ExperimentPlan, runs: Sequence[Run]) -> Experiment:
    return Experiment(plan.robot, plan.noise, plan.uncertainty, tuple(runs), plan.name, plan.sha256)


def _cleaned(read: ReadRun) -> Run:
    # Here and not above: they load scipy, which a look for mistakes does without.
    from rr_opt.recordings.cleaning import clean
    from rr_opt.recordings.clocks.synchrony import synchronised, with_doubts

    run, recording = read.run, read.run.recording
    if read.log is not None:
        recording = with_doubts(synchronised(recording, read.log, run.gait, run.start))
    made = clean(recording)
    doubts = (*recording.doubts, *texts(made.doubts))
    return replace(run, recording=replace(made.recording, doubts=doubts))


def _read(folder: str | Path) -> tuple[ExperimentPlan | None, list[ReadRun], list[Issue]]:
    """The plan (None if an issue is an error), what its runs' files hold, and all issues."""
    try:
        plan, issues = read_plan(folder)
    except InvalidFileError as error:
        return None, [], [*error.issues, *_in_files(Path(folder))]
    runs: list[ReadRun] = []
    for number, planned in enumerate(plan.runs):
        run, found = read_run(plan, number, planned)
        issues += found
        if run is not None:
            runs.append(run)
    return (None if has_errors(issues) else plan), runs, issues


def _in_files(folder: Path) -> list[Issue]:
    """What is wrong in the recordings of an experiment file that is wrong itself."""
    issues: list[Issue] = []
    for file in named_files(folder):
        try:
            read_file(file)
        except InputError as error:
            issues += error.issues if isinstance(error, InvalidFileError) else []
    return issues
