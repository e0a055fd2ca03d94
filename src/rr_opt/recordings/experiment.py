"""A folder with an experiment file and its recordings, to an Experiment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from rr_opt.experiment.experiment import Experiment, Run
from rr_opt.files.experiment.file import named_files, read_plan
from rr_opt.files.experiment.plan import ExperimentPlan
from rr_opt.files.issue import InvalidFileError, Issue, has_errors
from rr_opt.outcome import InputError
from rr_opt.recordings.doubts import texts
from rr_opt.recordings.planned_run import ReadRun, layout_for, read_run
from rr_opt.recordings.readers import read_file

__all__ = ["experiment_of", "layout_for", "read_experiment"]


def read_experiment(folder: str | Path) -> Experiment:
    """The experiment of a folder with `experiment.yaml`, or of that file, recordings cleaned.

    A recording with a servo's log is put on the command's clock, as far as the log can tell it.
    Raises InvalidFileError with everything that is wrong in the file and in every recording.
    """
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
    return Experiment(plan.robot, plan.noise, plan.uncertainty, tuple(runs), plan.name)


def _cleaned(read: ReadRun) -> Run:
    # Here and not above: they load scipy, which a look for mistakes does without.
    from rr_opt.recordings.clean import clean  # noqa: PLC0415
    from rr_opt.recordings.synchrony import synchronised, with_doubts  # noqa: PLC0415

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
