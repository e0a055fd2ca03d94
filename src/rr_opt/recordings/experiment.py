"""A folder with an experiment file and its recordings, to an Experiment."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from rr_opt.array import Array
from rr_opt.files.experiment_file import FILE_NAME, experiment_path, named_files, read_plan
from rr_opt.files.experiment_plan import ExperimentPlan, PlannedRun
from rr_opt.files.issue import InvalidFileError, Issue, has_errors
from rr_opt.model.experiment import Experiment, Run
from rr_opt.outcome import InputError
from rr_opt.recordings.inspection import Circumstances, Inspection, inspected
from rr_opt.recordings.readers import ReadOptions, read_file
from rr_opt.recordings.readers.netcdf import commanded_gait
from rr_opt.recordings.usable import stops

Progress = Callable[[str], object]


def is_experiment(path: Path) -> bool:
    """Whether a path is an experiment's folder or file, and not one recording."""
    return path.is_dir() or path.suffix.lower() in (".yaml", ".yml")


def read_experiment(folder: str | Path) -> Experiment:
    """The experiment of a folder with `experiment.yaml`, or of that file, recordings cleaned.

    A recording with a servo's log is put on the command's clock, as far as the log can tell it.
    Raises InvalidFileError with everything that is wrong in the file and in every recording.
    """
    file = experiment_path(Path(folder))
    if file != Path(folder) and not file.exists():
        raise InputError(
            f"{folder}: Read a folder without {FILE_NAME}. Expected that file, which names the "
            "robot and the recordings. `rr-opt schema experiment` lists its keys."
        )
    experiment, issues = experiment_of(folder)
    if experiment is None:
        raise InvalidFileError(issues)
    return experiment


def experiment_of(folder: str | Path) -> tuple[Experiment | None, list[Issue]]:
    """The same (None if an issue is an error), and all issues, doubts as warnings.

    Doubts that keep a recording from being diagnosed stay with it, for `usable.checked`.
    A file that cannot be read is an issue too; nothing is raised.
    """
    try:
        plan, issues = read_plan(folder)
    except InvalidFileError as error:
        return None, [*error.issues, *_in_files(Path(folder))]
    runs: list[Run] = []
    for number, planned in enumerate(plan.runs):
        found, told = _inspected(plan, number, planned, estimate=False)
        issues += told
        if found is not None:
            recording = found.recording
            file = recording.source.get("file", recording.name)
            told = [one for one in recording.doubts if not stops(one)]
            issues += [Issue("warning", "", one, None, file) for one in told]
            runs.append(Run(recording, planned.gait, planned.use, planned.start))
    if has_errors(issues):
        return None, issues
    made = Experiment(plan.robot, plan.noise, plan.uncertainty, tuple(runs), plan.name, plan.sha256)
    return made, issues


def inspect_experiment(path: Path, progress: Progress) -> list[Inspection]:
    """Every recording of an experiment file or its folder.

    Raises InvalidFileError with everything that is wrong in the file and in every recording.
    """
    plan, _ = read_plan(path)
    inspections: list[Inspection] = []
    issues: list[Issue] = []
    for number, planned in enumerate(plan.runs):
        progress(f"recording {number + 1} of {len(plan.runs)}")
        found, told = _inspected(plan, number, planned, estimate=True)
        issues += told
        inspections += [found] if found is not None else []
    if has_errors(issues):
        raise InvalidFileError(issues)
    return inspections


def _inspected(
    plan: ExperimentPlan, number: int, planned: PlannedRun, *, estimate: bool
) -> tuple[Inspection | None, list[Issue]]:
    """A recording (None if an issue is an error), and all issues; nothing is raised.

    estimate: the places of markers that the plan does not give.
    """
    options = ReadOptions(plan.noise, plan.counts, plan.columns)
    known = Circumstances(
        robot=plan.robot,
        layout=plan.markers,
        options=options,
        gait=planned.gait,
        start=planned.start,
        servo_log=planned.servo_log,
    )
    try:
        found = inspected(planned.file, known, estimate=estimate)
        return found, _other_command(plan, number, planned, found.recording.t)
    except InvalidFileError as error:
        return None, list(error.issues)
    except InputError as error:
        return None, [plan.document.issue("error", ("recordings", number, "file"), str(error))]


def _other_command(plan: ExperimentPlan, number: int, planned: PlannedRun, t: Array) -> list[Issue]:
    """A warning where a file that says what was commanded says something else.

    Raises InputError if what it says cannot be read.
    """
    said = commanded_gait(planned.file)
    if said is None or np.allclose(said.angle(t), planned.gait.angle(t)):
        return []
    message = "Read another gait than the file says was commanded. The one written here was taken."
    return [plan.document.issue("warning", ("recordings", number, "gait"), message)]


def _in_files(folder: Path) -> list[Issue]:
    """What is wrong in the recordings of an experiment file that is wrong itself."""
    issues: list[Issue] = []
    for file in named_files(folder):
        try:
            read_file(file)
        except InputError as error:
            issues += error.issues if isinstance(error, InvalidFileError) else []
    return issues
