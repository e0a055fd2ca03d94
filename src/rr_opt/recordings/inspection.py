"""One recording, read, cleaned and looked at: everything that a page or a script shows of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from rr_opt.files.experiment_file import experiment_path, read_plan
from rr_opt.files.experiment_plan import ExperimentPlan, MarkerPlaces, PlannedRun, places_from
from rr_opt.files.issue import InvalidFileError, Issue, has_errors
from rr_opt.files.problem_file import kind_of
from rr_opt.files.source import read_document
from rr_opt.model.experiment import Recording, Start
from rr_opt.model.gait import Gait
from rr_opt.outcome import InputError
from rr_opt.recordings.cleaning import Cleaned, clean
from rr_opt.recordings.clocks.clock_fit import ClockFit
from rr_opt.recordings.clocks.clocks import against_command
from rr_opt.recordings.clocks.synchrony import Synchrony, synchronised
from rr_opt.recordings.clocks.warnings import command_doubts, start_doubts
from rr_opt.recordings.experiment import layout_for
from rr_opt.recordings.markers.layout import Layout
from rr_opt.recordings.markers.pose import MarkerFit, fit_markers
from rr_opt.recordings.readers.marker_rows import MarkerData
from rr_opt.recordings.readers.registry import read_file
from rr_opt.recordings.readers.servo_log import ServoLog
from rr_opt.recordings.warnings import Doubt, texts


@dataclass(frozen=True)
class Inspection:
    """What was found of one recording.

    markers   the rigid fit, of marker files
    gait      what the servo was told, where it is known
    command   phi against it
    synchrony what the servo's log says of the clocks, where there is one
    doubts    all of them, the reader's first
    """

    cleaned: Cleaned
    markers: MarkerFit | None
    gait: Gait | None
    command: ClockFit | None
    synchrony: Synchrony | None
    doubts: tuple[str, ...]

    @property
    def recording(self) -> Recording:
        """With all flags set."""
        return self.cleaned.recording

    @property
    def name(self) -> str:
        """Of the file."""
        return self.recording.name


@dataclass(frozen=True)
class Told:
    """What is known of a recording beside its file; all of it may be unknown.

    noise  standard deviation of a marker's coordinate, m
    """

    layout: Layout | None = None
    noise: float | None = None
    gait: Gait | None = None
    start: Start = "running"
    log: ServoLog | None = None


def inspect(read: Recording | MarkerData, told: Told) -> Inspection:
    """Clean a recording and look at it. Raises InputError if markers make no robot."""
    markers = None
    if isinstance(read, MarkerData):
        markers = fit_markers(read, told.layout, told.noise)
        recording = markers.recording
    else:
        recording = read
    first: list[Doubt] = []
    synchrony = None
    if told.log is not None:
        synchrony = synchronised(recording, told.log, told.gait, told.start)
        recording = synchrony.recording
        first += synchrony.doubts
        if markers is not None:
            markers = replace(markers, recording=recording)
    cleaned = clean(recording)
    doubts = [*cleaned.doubts, *first]
    command = None
    if told.gait is not None:
        rest = told.start == "rest"
        t, phi = cleaned.recording.t, cleaned.recording.data("phi")
        command = against_command(t, phi, told.gait, from_rest=rest)
        shifted = synchrony is not None and synchrony.shift is not None
        period = told.gait.period
        doubts += command_doubts(command, from_rest=rest, period=period, clock_known=shifted)
        doubts += start_doubts(float(t[0]), period) if rest else ()
    said = (*recording.doubts, *(told.log.doubts if told.log else ()), *texts(doubts))
    return Inspection(cleaned, markers, told.gait, command, synchrony, said)


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
