"""A folder with an experiment file and its recordings, to an Experiment that can be diagnosed.

Nothing is corrected: the experimenter has to do that. A fault of the robot is no reason to refuse.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from rr_opt.array import Array
from rr_opt.files.experiment_file import ExperimentPlan, PlannedRun, named_files, read_plan
from rr_opt.files.issue import InvalidFileError, Issue, has_errors
from rr_opt.files.source import EXPERIMENT, experiment_path, recording_path
from rr_opt.messages import shown
from rr_opt.model.experiment import Experiment, Layout, Run
from rr_opt.model.parameters import Uncertainty
from rr_opt.outcome import InputError
from rr_opt.recordings.copies import Rows, copied, rows_of
from rr_opt.recordings.inspection import Circumstances, Inspection, in_file, read_both
from rr_opt.recordings.markers.calibration import Calibration, calibration
from rr_opt.recordings.readers import MarkerData, ReadOptions, read_file
from rr_opt.recordings.readers.netcdf import commanded_gait
from rr_opt.recordings.warnings import Notice, notice

Progress = Callable[[str], object]


def is_experiment(path: Path) -> bool:
    """Whether a path is an experiment's folder or file, and not one recording."""
    return recording_path(path).is_dir() or path.suffix.lower() in (".yaml", ".yml")


def read_experiment(folder: str | Path) -> Experiment:
    """The experiment of a folder with `experiment.yaml`, or of that file, recordings cleaned.

    A recording with a servo's log is put on the command's clock, as far as the log determines it.
    Raises InvalidFileError with everything that is wrong in the file and in every recording.
    """
    file = experiment_path(Path(folder))
    if file != Path(folder) and not file.exists():
        raise InputError(
            f"{folder}: Read a folder without {EXPERIMENT}. Expected that file, which names the "
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
    learnt, inspections, more = _inspections(plan)
    issues += more
    for planned, found in inspections:
        recording = found.recording
        file = recording.source.get("file", recording.name)
        doubts = (one for one in recording.doubts if not stops(one))
        issues += [Issue("warning", "", one, None, file) for one in doubts]
        runs.append(Run(recording, planned.gait, planned.use, planned.start))
    if has_errors(issues):
        return None, issues
    uncertainty = plan.uncertainty if learnt is None else _with_learnt(plan.uncertainty, learnt)
    made = Experiment(plan.robot, plan.noise, uncertainty, tuple(runs), plan.name, plan.sha256)
    return made, issues


_AXES = Uncertainty(0.1)
"""Of the zeros of psi and phi, rad, where they were learnt from the recordings: as wide as axles
that toe in may shift them, so that the recordings do not count twice."""


def _with_learnt(
    stated: Mapping[str, Uncertainty], learnt: Calibration
) -> Mapping[str, Uncertainty]:
    """The uncertainty of an experiment whose markers' places were learnt from its recordings.

    A servo that swings little leaves P undetermined along the robot, which amounts to another
    distance from P to both axles.
    """
    known = {"psi_zero": _AXES, "phi_zero": _AXES, **stated}
    for name in ("c1", "c2"):
        one = known.get(name, Uncertainty(0.0))
        known[name] = replace(one, sigma=math.hypot(one.sigma, learnt.joint))
    return MappingProxyType(known)


def inspect_experiment(path: Path, progress: Progress) -> list[Inspection]:
    """Every recording of an experiment file or its folder.

    Raises InvalidFileError with everything that is wrong in the file and in every recording.
    """
    _, inspections, issues = _inspections(read_plan(path)[0], progress)
    if has_errors(issues):
        raise InvalidFileError(issues)
    return [found for _, found in inspections]


def _inspections(
    plan: ExperimentPlan, progress: Progress = lambda _: None
) -> tuple[Calibration | None, list[tuple[PlannedRun, Inspection]], list[Issue]]:
    """The calibration of the markers, the recordings without an error, and all issues."""
    issues: list[Issue] = []
    contents: list[tuple[int, PlannedRun, Circumstances, Any]] = []
    for number, planned in enumerate(plan.runs):
        progress(f"recording {number + 1} of {len(plan.runs)}")
        known = Circumstances(
            robot=plan.robot,
            layout=plan.markers,
            options=ReadOptions(plan.noise, plan.counts, plan.columns),
            gait=planned.gait,
            start=planned.start,
            servo_log=planned.servo_log,
        )
        with _collected(plan, number, issues):
            contents.append((number, planned, known, read_both(planned.file, known)))
    learnt = None
    if plan.markers is None:
        several = [(n, read) for n, _, _, (read, _) in contents if isinstance(read, MarkerData)]
        learnt, more = _learnt(plan, several)
        issues += more
    inspections: list[tuple[PlannedRun, Inspection]] = []
    layout: Layout | Calibration | None = learnt
    for number, planned, stated, (read, log) in contents:
        known = stated
        if isinstance(read, MarkerData):
            if layout is None and plan.markers is None:
                continue
            if learnt is not None:
                known = replace(known, layout=layout)
                layout = learnt.layout  # what was learnt is reported once, with the first
        with _collected(plan, number, issues):
            found = in_file(planned.file, read, log, known)
            inspections.append((planned, found))
            issues += _other_command(plan, number, planned, found.recording.t)
    return learnt, inspections, issues


@contextmanager
def _collected(plan: ExperimentPlan, number: int, issues: list[Issue]) -> Iterator[None]:
    """Add errors of a recording to the issues; nothing is raised."""
    try:
        yield
    except InvalidFileError as error:
        issues += error.issues
    except InputError as error:
        issues.append(plan.document.error(("recordings", number, "file"), str(error)))


def _learnt(
    plan: ExperimentPlan, contents: Sequence[tuple[int, MarkerData]]
) -> tuple[Calibration | None, list[Issue]]:
    """The markers' places from all recordings together (None if there are none), and issues."""
    if not contents:
        return None, []
    gaits = [plan.runs[number].gait for number, _ in contents]
    try:
        found = calibration([read for _, read in contents], plan.robot, gaits)
    except InputError as error:
        why = str(error)
    else:
        if found.ordered:
            return found, []
        why = (
            "The robot drives too little to show the axes of its platforms."
            if found.axles is None
            else "Neither its axles nor phi show which is platform 1."
        )
    number, read = contents[0]
    message = (
        f"Read the markers {shown(', '.join(read.labels))}. Expected `markers`, the place of each "
        "on the robot, or recordings that show it, in which the robot drives and its joint moves. "
        f"{why} Add the key, or such a recording."
    )
    return None, [plan.document.error(("recordings", number, "file"), message)]


def _other_command(plan: ExperimentPlan, number: int, planned: PlannedRun, t: Array) -> list[Issue]:
    """A warning if a file that states its command states another one.

    Raises InputError if that command cannot be read.
    """
    said = commanded_gait(planned.file)
    if said is None or np.allclose(said.angle(t), planned.gait.angle(t)):
        return []
    message = "Read a gait other than the one the file says was commanded. This one was used."
    return [plan.document.warning(("recordings", number, "gait"), message)]


def _in_files(folder: Path) -> list[Issue]:
    """Errors in the recordings of an experiment file that has errors itself."""
    issues: list[Issue] = []
    files, columns = named_files(folder)
    for file in files:
        try:
            read_file(file, ReadOptions(columns=columns))
        except InputError as error:
            issues += error.issues if isinstance(error, InvalidFileError) else []
    return issues


def checked(experiment: Experiment) -> tuple[dict[int, str], list[str]]:
    """Why recordings cannot be diagnosed, in sentences: by index, each uninformative recording; and
    contradictions of the experiment file, in units, signs, clocks, the gait, or no recording left
    to fit."""
    left_out = dict(_left_out(experiment))
    wrong = [
        f"{run.name}: {one}"
        for run in experiment.runs
        for one in notices_of(run)
        if one.level == "error"
    ]
    kept = [run for k, run in enumerate(experiment.runs) if k not in left_out]
    half = [any(one.code == "command.half" for one in notices_of(run)) for run in kept]
    if not wrong and len(half) > 1 and all(half):
        wrong.append(notice("command.signs"))
    if not wrong and all(run.use != "fit" for run in experiment.runs):
        wrong.append(
            "All recordings are held out. Expected some to fit. Mark them with `use: fit`."
        )
    elif not wrong and all(run.use != "fit" for run in kept):
        wrong.append(
            "No recording is left to fit, so nothing can be learnt about this robot. Record a few "
            "periods in which it drives."
        )
    return left_out, wrong


def notices_of(run: Run) -> list[Notice]:
    """The warnings of its recording."""
    return [one for one in run.recording.doubts if isinstance(one, Notice)]


def stops(warning: str) -> bool:
    """Whether a recording with this warning cannot be diagnosed."""
    return isinstance(warning, Notice) and (warning.level == "error" or warning.kind == "useless")


def usable(experiment: Experiment) -> tuple[Experiment, tuple[str, ...]]:
    """The experiment without uninformative recordings, and a sentence on each of those.

    Raises InputError for recordings that contradict the experiment file, and if no recording is
    left to fit.
    """
    left_out, wrong = checked(experiment)
    if wrong:
        place = f"{experiment.name}/{EXPERIMENT}" if experiment.sha256 else experiment.name
        lines = (*left_out.values(), *wrong)
        raise InputError("\n".join(f"{place}: {line}" for line in lines))
    runs = tuple(run for k, run in enumerate(experiment.runs) if k not in left_out)
    return replace(experiment, runs=runs), tuple(left_out.values())


def _left_out(experiment: Experiment) -> Iterator[tuple[int, str]]:
    """Indices, and why they are left out. What is to be fitted goes before what is held out."""
    seen: list[tuple[str, Rows]] = []
    for k, run in sorted(enumerate(experiment.runs), key=lambda one: one[1].use != "fit"):
        rows = rows_of(run.recording)
        why = next((one for one in notices_of(run) if one.kind == "useless"), None)
        original = copied(rows, seen)
        if why is None and original is not None:
            why = notice("useless.copy", other=original)
        if why is not None:
            yield k, f"{run.name}: {why} It is left out."
        seen.append((run.name, rows))
