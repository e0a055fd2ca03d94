"""An experiment file to a checked plan of what was done."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rr_opt.experiment.count_scale import CountScale
from rr_opt.experiment.experiment import Noise
from rr_opt.files.document import Document
from rr_opt.files.experiment.markers import places_from
from rr_opt.files.experiment.model import ExperimentModel
from rr_opt.files.experiment.plan import ExperimentPlan
from rr_opt.files.experiment.recordings import runs_from, usable
from rr_opt.files.experiment.robot_source import robot_of
from rr_opt.files.experiment.uncertainty import shares_of_nothing, uncertainty_of
from rr_opt.files.issue import InvalidFileError, Issue, has_errors, shown
from rr_opt.files.kind import kind_of
from rr_opt.files.model_issues import validate
from rr_opt.files.source import read_document
from rr_opt.robot.parameters import Robot

FILE_NAME = "experiment.yaml"


def experiment_path(path: Path) -> Path:
    """The experiment file of a folder; any other path as it is."""
    try:
        return path / FILE_NAME if path.is_dir() else path
    except (OSError, ValueError):
        return path


def read_plan(path: str | Path) -> tuple[ExperimentPlan, list[Issue]]:
    """The plan of an experiment file, or of its folder, and warnings.

    Raises InvalidFileError with all that is wrong; recordings are not read.
    """
    file = experiment_path(Path(path))
    document = read_document(file)
    if kind_of(document) != "experiment":
        message = (
            "Read a file that names no recordings. Expected an experiment, with `robot`, `noise` "
            "and `recordings`. `rr-opt schema experiment` tells its keys."
        )
        raise InvalidFileError([document.issue("error", (), message)])
    plan, issues = plan_from(document, file)
    if plan is None:
        raise InvalidFileError(issues)
    return plan, issues


def named_files(path: Path) -> list[Path]:
    """The recordings that an experiment file names and that are there, whatever is wrong in it."""
    file = experiment_path(path)
    try:
        entries: Any = read_document(file).data.get("recordings")
    except InvalidFileError:
        return []
    names = [
        entry.get("file")
        for entry in (entries if isinstance(entries, list) else [])
        if isinstance(entry, dict)
    ]
    return [file.parent / name for name in names if isinstance(name, str) and usable(file, name)]


def plan_from(document: Document, file: Path) -> tuple[ExperimentPlan | None, list[Issue]]:
    """The plan (None if an issue is an error), and all issues of the file and its robot."""
    model, issues = validate(ExperimentModel, document)
    robot, paths, found = robot_of(document, file)
    issues += found
    runs: Any = ()
    if "recordings" in document.data:
        runs, found = runs_from(document, file)
        issues += found
    markers = None
    if "markers" in document.data:
        markers, found = _markers(document)
        issues += found
    if model is not None and model.servo_counts.range == 0:
        message = "Read 0. Expected the angle that all counts cover. Write for example `300 deg`."
        issues.append(document.issue("error", ("servo_counts", "range"), message))
    if model is None or robot is None or has_errors(issues):
        return None, issues
    for key, message in shares_of_nothing(model.uncertainty, robot):
        issues.append(document.issue("warning", ("uncertainty", key), message))
    issues += _beyond_the_model(document, robot, [run.gait.peak_angle for run in runs])
    plan = ExperimentPlan(
        name=file.absolute().parent.name,
        document=document,
        robot=robot,
        noise=Noise(**model.noise.model_dump()),
        uncertainty=uncertainty_of(model.uncertainty, robot),
        runs=runs,
        markers=markers,
        counts=CountScale(**model.servo_counts.model_dump()),
        paths=(
            file,
            *paths,
            *(run.file for run in runs),
            *(run.servo_log for run in runs if run.servo_log is not None),
        ),
    )
    return plan, issues


def _markers(document: Document) -> tuple[Any, list[Issue]]:
    given = document.data["markers"]
    if isinstance(given, dict):
        return places_from(document.section("markers"))
    message = f"Read {shown(given)}. Expected `platform1` and `platform2`, each with its markers."
    return None, [document.issue("error", ("markers",), message)]


def _beyond_the_model(document: Document, robot: Robot, peaks: list[float]) -> list[Issue]:
    """Recordings that reach the posture where a model without side slip means nothing."""
    message = (
        "The gait reaches |phi| = {peak:.4g} rad, and beyond {limit:.4g} rad lies the singular "
        "posture, where a model without side slip means nothing."
    )
    limit = robot.singular_angle
    return [
        document.issue(
            "warning", ("recordings", at, "gait"), message.format(peak=peak, limit=limit)
        )
        for at, peak in enumerate(peaks)
        if peak >= limit
    ]
