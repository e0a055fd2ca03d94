"""From an experiment file to a checked plan of its runs; no recording is read yet."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

from rr_opt.files.experiment_model import (
    ColumnsModel,
    ExperimentModel,
    MarkersModel,
    RecordingModel,
    shares_of_nothing,
    uncertainty_of,
)
from rr_opt.files.fields import validate
from rr_opt.files.issue import InvalidFileError, Issue, has_errors, required
from rr_opt.files.problem_file import ROBOT, read_as
from rr_opt.files.record import gait_from
from rr_opt.files.robot_file import robot_from
from rr_opt.files.source import (
    experiment_path,
    fingerprint,
    is_result,
    linked,
    read_document,
    recording_path,
    unreadable,
)
from rr_opt.files.yaml_text import FileData
from rr_opt.messages import shown
from rr_opt.model.experiment import Column, CountScale, Layout, Noise, Start, Uncertainty, Use
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot


@dataclass(frozen=True)
class PlannedRun:
    """An entry of `recordings`, with the fields of Run; servo_log: the file of the servo's log."""

    file: Path
    gait: Gait
    use: Use
    start: Start
    servo_log: Path | None


@dataclass(frozen=True)
class ExperimentPlan:
    """The content of an experiment file.

    document  the file, for issues that only show when a recording is read
    paths     every file that makes up the experiment
    """

    name: str
    document: FileData
    robot: Robot
    noise: Noise
    uncertainty: Mapping[str, Uncertainty]
    runs: tuple[PlannedRun, ...]
    markers: Layout | None
    counts: CountScale
    columns: Mapping[str, Column]
    paths: tuple[Path, ...]

    @property
    def sha256(self) -> str:
        """The fingerprint of every file."""
        return fingerprint(self.paths)


def runs_from(document: FileData, file: Path) -> tuple[tuple[PlannedRun, ...], list[Issue]]:
    """The runs that could be read, and all issues; files are named relative to `file`."""
    sections, issues = document.entries(
        "recordings",
        "a list of recordings. Write for example "
        "`- {file: run01.csv, gait: {amplitude: 0.5, period: 1 s, offset: 0}}`",
        "{file: ..., gait: ...}",
    )
    runs: list[PlannedRun] = []
    for section in sections:
        run, found = _run(section, file)
        issues += found
        if run is not None:
            runs.append(run)
    issues += _twice(document, document.data["recordings"] if sections else [])
    return tuple(runs), issues or _uses(document, runs)


def _run(document: FileData, file: Path) -> tuple[PlannedRun | None, list[Issue]]:
    model, issues = validate(RecordingModel, document)
    gait, found = _gait(document, file) if "gait" in document.data else (None, [])
    issues += found
    named: dict[str, Path] = {}
    for key in ("file", "servo_log"):
        if isinstance(name := document.data.get(key), str):
            named[key] = recording_path(file.parent / name)
            if why := unreadable(named[key]):
                issues.append(document.error((key,), f"Read {shown(name)}. {why}"))
    if model is None or gait is None or issues:
        return None, issues
    return PlannedRun(named["file"], gait, model.use, model.start, named.get("servo_log")), issues


def _gait(document: FileData, file: Path) -> tuple[Gait | None, list[Issue]]:
    """The gait written in the entry, or that of the result that it names."""
    expected = (
        "the gait, or the name of a result that has it. Write for example "
        "`{amplitude: 0.5, period: 1 s, offset: 0}`"
    )
    found, named, issues = linked(document, "gait", file.parent, expected)
    if found is None:
        read = f"Read {shown(document.data['gait'])}. "
        why = issues[0].message.removeprefix(read)
        return None, [document.error(("gait",), f"{read}{why}")]
    if not named:
        return gait_from(found)
    if not is_result(found.data) or not isinstance(found.data.get("gait"), dict):
        given = shown(document.data["gait"])
        message = f"Read {given}, which has no gait. Expected a result of rr-opt."
        return None, [document.error(("gait",), message)]
    return gait_from(found.section("gait"))


def _twice(document: FileData, entries: list[object]) -> list[Issue]:
    """A recording listed twice would be both fitted and held out, or count double."""
    issues: list[Issue] = []
    seen: dict[str, int] = {}
    for index, entry in enumerate(entries):
        name = entry.get("file") if isinstance(entry, dict) else None
        if not isinstance(name, str):
            continue
        first = seen.setdefault(str(Path(name)), index)
        if first != index:
            message = f"Read {shown(name)}, which is also recordings[{first}]. Keep one of them."
            issues.append(document.error(("recordings", index, "file"), message))
    return issues


def _uses(document: FileData, runs: list[PlannedRun]) -> list[Issue]:
    """Requests that the recordings do not support."""
    uses = [run.use for run in runs]
    if "fit" not in uses:
        message = "No recording is marked to be fitted. Give at least one `use: fit`."
    elif "holdout" not in uses:
        message = "No recording is held out to check the fit. Give one of them `use: holdout`."
    else:
        return []
    return [document.warning(("recordings",), message)]


def read_plan(path: str | Path) -> tuple[ExperimentPlan, list[Issue]]:
    """The plan of an experiment file, or of its folder, and warnings.

    Raises InvalidFileError with all that is wrong; recordings are not read.
    """
    file = experiment_path(Path(path))
    expected = (
        "Read a file that names no recordings. Expected an experiment, with `robot`, `noise` "
        "and `recordings`. `rr-opt schema experiment` lists its keys."
    )
    plan, issues = plan_from(read_as("experiment", file, expected), file)
    return required(plan, issues), issues


def named_files(path: Path) -> tuple[list[Path], dict[str, Column]]:
    """The existing recordings that an experiment file names, even if the file has errors, and their
    columns. No recordings if those have errors: without them they cannot be read."""
    file = experiment_path(path)
    try:
        document = read_document(file)
    except InvalidFileError:
        return [], {}
    whole = replace(document, data={"columns": {}, "recordings": [], **document.data})
    columns, _ = validate(ColumnsModel, whole.section("columns"))
    entries: Any = whole.data["recordings"]
    if columns is None or not isinstance(entries, list):
        return [], {}
    names = [entry.get("file") for entry in entries if isinstance(entry, dict)]
    files = [file.parent / name for name in names if isinstance(name, str)]
    return [one for one in files if not unreadable(one)], _stated(columns)


def _stated(columns: Any) -> dict[str, Column]:
    return {name: one for name, one in dict(columns).items() if one is not None}


def plan_from(document: FileData, file: Path) -> tuple[ExperimentPlan | None, list[Issue]]:
    """The plan (None if an issue is an error), and all issues of the file and its robot."""
    model, issues = validate(ExperimentModel, document)
    robot, paths, runs, markers = None, (), (), None
    if "robot" in document.data:
        given, paths, found = linked(document, "robot", file.parent, ROBOT)
        issues += found
        if given is not None:
            robot, found = robot_from(given)
            issues += found
    if "recordings" in document.data:
        runs, found = runs_from(document, file)
        issues += found
    if "markers" in document.data:
        markers, found = layout_in(document)
        issues += found
    if model is not None and model.servo_counts.range == 0:
        message = "Read 0. Expected the angle that the counts span. Write for example `300 deg`."
        issues.append(document.error(("servo_counts", "range"), message))
    if model is None or robot is None or has_errors(issues):
        return None, issues
    for key, message in shares_of_nothing(model.uncertainty, robot):
        issues.append(document.warning(("uncertainty", key), message))
    for at, run in enumerate(runs):
        if run.gait.peak_angle >= robot.singular_angle:
            message = (
                f"The gait reaches |phi| = {run.gait.peak_angle:.4g} rad, past the singular "
                f"posture at {robot.singular_angle:.4g} rad, where a model without side slip is "
                "meaningless."
            )
            issues.append(document.warning(("recordings", at, "gait"), message))
    plan = ExperimentPlan(
        name=file.absolute().parent.name,
        document=document,
        robot=robot,
        noise=model.noise,
        uncertainty=uncertainty_of(model.uncertainty, robot),
        runs=runs,
        markers=markers,
        counts=model.servo_counts,
        columns=_stated(model.columns),
        paths=(
            file,
            *paths,
            *(run.file for run in runs),
            *(run.servo_log for run in runs if run.servo_log is not None),
        ),
    )
    return plan, issues


def layout_in(document: FileData) -> tuple[Layout | None, list[Issue]]:
    """The places in a file that has a key `markers` (None if there are issues), and all issues."""
    given = document.data["markers"]
    if isinstance(given, dict):
        return layout_from(document.section("markers"))
    message = f"Read {shown(given)}. Expected `platform1` and `platform2`, each with its markers."
    return None, [document.error(("markers",), message)]


def layout_from(document: FileData) -> tuple[Layout | None, list[Issue]]:
    """The places in the section `markers` (None if there are issues), and all issues."""
    model, issues = validate(MarkersModel, document)
    given = [document.data.get(name) for name in ("platform1", "platform2")]
    first, second = (one if isinstance(one, dict) else {} for one in given)
    for name in second:
        if name in first:
            message = f"Read the marker {shown(name)} on both platforms. Keep it on one of them."
            issues.append(document.error(("platform2", name), message))
    if model is None:
        return None, issues
    for platform in ("platform1", "platform2"):
        taken: dict[tuple[float, ...], str] = {}
        for name, place in getattr(model, platform).items():
            other = taken.setdefault(place[:2], name)
            if other != name and len(place) == 2:
                message = (
                    f"Read the place of {shown(other)} again. Expected a different one. Measure it."
                )
                issues.append(document.error((platform, name), message))
    if issues:
        return None, issues
    return Layout(
        MappingProxyType(model.platform1), MappingProxyType(model.platform2), model.up
    ), []
