"""A folder with an experiment file and its recordings, to an Experiment."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from rr_opt.experiment.experiment import Experiment, Run
from rr_opt.files.experiment.file import named_files, read_plan
from rr_opt.files.issue import InvalidFileError, Issue, has_errors
from rr_opt.outcome import InputError
from rr_opt.recordings.planned_run import layout_for, read_run
from rr_opt.recordings.readers import read_file

__all__ = ["experiment_of", "layout_for", "read_experiment"]


def read_experiment(folder: str | Path) -> Experiment:
    """The experiment of a folder with `experiment.yaml`, or of that file, recordings cleaned.

    Raises InvalidFileError with everything that is wrong in the file and in every recording.
    """
    # Here and not above: it loads scipy, which a look for mistakes does without.
    from rr_opt.recordings.clean import clean  # noqa: PLC0415

    experiment, issues = experiment_of(folder)
    if experiment is None:
        raise InvalidFileError(issues)
    cleaned = [clean(run.recording) for run in experiment.runs]
    runs = [
        replace(
            run,
            recording=replace(one.recording, doubts=(*run.recording.doubts, *map(str, one.doubts))),
        )
        for run, one in zip(experiment.runs, cleaned, strict=True)
    ]
    return replace(experiment, runs=tuple(runs))


def experiment_of(folder: str | Path) -> tuple[Experiment | None, list[Issue]]:
    """The experiment as read (None if an issue is an error), and all issues, doubts as warnings.

    A file that cannot be read is an issue too; nothing is raised, and no recording is cleaned.
    """
    try:
        plan, issues = read_plan(folder)
    except InvalidFileError as error:
        return None, [*error.issues, *_in_files(Path(folder))]
    runs: list[Run] = []
    for number, planned in enumerate(plan.runs):
        run, found = read_run(plan, number, planned)
        issues += found
        if run is not None:
            runs.append(run)
    if has_errors(issues):
        return None, issues
    experiment = Experiment(plan.robot, plan.noise, plan.uncertainty, tuple(runs), plan.name)
    return experiment, issues


def _in_files(folder: Path) -> list[Issue]:
    """What is wrong in the recordings of an experiment file that is wrong itself."""
    issues: list[Issue] = []
    for file in named_files(folder):
        try:
            read_file(file)
        except InputError as error:
            issues += error.issues if isinstance(error, InvalidFileError) else []
    return issues
