"""Files of recordings, and folders of experiments, read and inspected."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from rr_opt.experiment.experiment import Start
from rr_opt.experiment.recording import Recording
from rr_opt.files.experiment.file import experiment_path, read_plan
from rr_opt.files.experiment.markers import places_from
from rr_opt.files.experiment.plan import ExperimentPlan, MarkerPlaces, PlannedRun
from rr_opt.files.issue import InvalidFileError, Issue, has_errors
from rr_opt.files.kind import kind_of
from rr_opt.files.source import read_document
from rr_opt.outcome import InputError
from rr_opt.recordings.experiment import layout_for
from rr_opt.recordings.inspection import Inspection, Told, inspect
from rr_opt.recordings.markers_file import MarkerData
from rr_opt.recordings.readers import read_file
from rr_opt.recordings.servo_log_file import ServoLog
from rr_opt.robot.gait import Gait

Progress = Callable[[str], object]


def is_experiment(path: Path) -> bool:
    """Whether a path is an experiment's folder or file, and not one recording."""
    return path.is_dir() or path.suffix.lower() in (".yaml", ".yml")


def inspect_experiment(path: Path, progress: Progress) -> list[Inspection]:
    """Every recording of an experiment file or its folder.

    Raises InvalidFileError with everything that is wrong in the file and in every recording.
    """
    plan, _ = read_plan(experiment_path(path))
    found: list[Inspection] = []
    issues: list[Issue] = []
    for number, run in enumerate(plan.runs, 1):
        progress(f"recording {number} of {len(plan.runs)}")
        try:
            found.append(_of_plan(plan, run))
        except InvalidFileError as error:
            issues += error.issues
        except InputError as error:
            issues.append(Issue("error", "", str(error), None, str(run.file)))
    if has_errors(issues):
        raise InvalidFileError(issues)
    return found


def _of_plan(plan: ExperimentPlan, run: PlannedRun) -> Inspection:
    read = read_file(run.file, plan.noise, plan.counts)
    log = read_file(run.servo_log, plan.noise, plan.counts) if run.servo_log else None
    layout = None
    if isinstance(read, MarkerData) and plan.markers is not None:
        layout = layout_for(read, plan.markers)
    told = Told(layout, plan.noise.position, run.gait, run.start, _servo_log(log))
    return inspect(_robot(read), told)


def inspect_file(
    path: Path,
    *,
    layout: Path | None = None,
    servo_log: Path | None = None,
    gait: Gait | None = None,
    start: Start = "running",
) -> Inspection:
    """One recording. Raises InputError with what cannot be read or matched.

    layout: a YAML file with the markers' places; servo_log, gait and start: where they are known.
    """
    read = _robot(read_file(path))
    places = read_places(layout) if layout else None
    told = Told(gait=gait, start=start, log=_servo_log(read_file(servo_log) if servo_log else None))
    if places is not None:
        if not isinstance(read, MarkerData):
            raise InputError(
                f"{layout}: Read the places of markers. Expected a marker file beside them, and "
                f"{path.name} holds motion already. Leave --layout away."
            )
        told = replace(told, layout=layout_for(read, places))
    return inspect(read, told)


def read_places(path: Path) -> MarkerPlaces:
    """The places of markers in a YAML file: its own keys, or those of its section `markers`.

    Raises InvalidFileError.
    """
    document = read_document(path)
    if "markers" in document.data:
        document = document.section("markers")
    elif "robot" in document.data and kind_of(document) == "experiment":
        message = "Read an experiment without `markers`. Expected the places of markers. Add them."
        raise InvalidFileError([document.issue("error", (), message)])
    places, issues = places_from(document)
    if places is None:
        raise InvalidFileError(issues)
    return places


def _robot(read: Recording | MarkerData | ServoLog) -> Recording | MarkerData:
    if isinstance(read, ServoLog):
        raise InputError(
            f"{read.source.get('file', read.name)}: Read a servo's log. Expected a recording of "
            "the robot. Name the log with --servo-log, beside a recording."
        )
    return read


def _servo_log(read: object) -> ServoLog | None:
    if read is None or isinstance(read, ServoLog):
        return read
    raise InputError(
        "Read a recording of the robot. Expected a servo's log: CSV with the header row "
        "`t,goal,present`. Name the log."
    )
