"""User input, as files or numbers with units, to objects with a name and a fingerprint."""

import dataclasses
import hashlib
import math
import shlex
import warnings
from collections.abc import Container, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.files.issue import InvalidFileError
from rr_opt.files.lint import lint_file
from rr_opt.files.problem_file import kind_of, name_of, read_problem
from rr_opt.files.record import gait_from
from rr_opt.files.robot_file import read_robot, robot_from
from rr_opt.files.source import read_document
from rr_opt.files.yaml_text import FileData
from rr_opt.formatting import with_unit
from rr_opt.messages import shown
from rr_opt.model.ballast import inertia_ratio, load_count, with_inertia_ratio, with_load_count
from rr_opt.model.experiment import Experiment
from rr_opt.model.gait import AMPLITUDE, OFFSET, PERIOD, Gait, SineGait
from rr_opt.model.machine import MachineExperiment
from rr_opt.model.problem import GaitBounds, Limits, Problem, RatioChoice
from rr_opt.model.robot import Robot
from rr_opt.outcome import InputError
from rr_opt.units import Number


def identity(asked: Problem | Experiment) -> tuple[str, str]:
    """Its name, and the SHA-256 of its files, or of its values where there is no file."""
    name = asked.name or asked.robot.name or type(asked).__name__.lower()
    return name, asked.sha256 or fingerprint(asked)


def fingerprint(value: Any) -> str:
    """SHA-256, in hex, over the values; equal objects have equal ones."""
    return hashlib.sha256(_canonical(value)).hexdigest()


def _canonical(value: Any) -> bytes:
    if dataclasses.is_dataclass(value):
        parts = [(one.name, getattr(value, one.name)) for one in dataclasses.fields(value)]
        return type(value).__name__.encode() + _canonical(dict(parts))
    if isinstance(value, Mapping):
        return b"{" + b"".join(_canonical(key) + _canonical(value[key]) for key in value) + b"}"
    if isinstance(value, np.ndarray):
        return f"{value.dtype}{value.shape}".encode() + value.tobytes()
    if isinstance(value, tuple | list):
        return b"(" + b"".join(map(_canonical, value)) + b")"
    return f"{value!r},".encode()


QUANTITIES = {
    "amplitude": AMPLITUDE,
    "period": PERIOD,
    "offset": OFFSET,
    "seconds": Number("s", "10", above=0),
    "rate": Number("1/s", "100", above=0),
    "radius": Number("m", "1.5 m"),
    "heading": Number("rad", "90 deg"),
    "within": Number("s", "4 s", above=0),
    "length": Number("m", "80 cm", above=0),
}
"""Unit by the argument's name."""


def read_arguments(given: Mapping[str, float | str | None], prefix: str = "") -> dict[str, float]:
    """The arguments in SI, without those that are None.

    prefix: of the names in messages, `--` for options. Raises InputError with all mistakes in any
    of them.
    """
    values, wrong = {}, []
    for name, value in given.items():
        if value is not None:
            try:
                values[name] = QUANTITIES[name].read(value)
            except InputError as error:
                wrong.append(f"{prefix}{name}: {error}")
    if wrong:
        raise InputError("\n".join(wrong))
    return values


PathLike = str | Path


class InputWarning(UserWarning):
    """Something in a file looks wrong, but the file is usable."""


def load(path: PathLike) -> Problem:
    """The problem of a file, or of a folder with problem.yaml.

    A robot file stands for the shipped problem with that robot as it is and its servo's limits.
    Warns with InputWarning of suspicious values. Raises InputError with everything that is wrong.
    """
    problem = read_problem(path)
    for issue in lint_file(path):
        warnings.warn(str(issue), InputWarning, stacklevel=2)
    return problem


def load_robot(path: PathLike) -> Robot:
    """The robot of a robot file. Raises InputError with everything that is wrong."""
    return read_robot(Path(path))


def load_experiment(path: PathLike) -> Experiment | MachineExperiment:
    """The experiment of a folder with experiment.yaml and recordings, which are cleaned.

    Raises InputError with everything that is wrong in the file and in every recording.
    """
    from rr_opt.api.recordings import load_machine, machine_of
    from rr_opt.recordings.experiment import read_experiment

    machine = machine_of(path)
    return load_machine(path, machine) if machine else read_experiment(path)


def prototype() -> Robot:
    """The paper's prototype."""
    return shipped().robot


def shipped() -> Problem:
    """The problem of the paper's prototype that `rr-opt maximize-speed` solves."""
    return read_problem(None)


def problem_of(problem: Problem | PathLike) -> Problem:
    """A problem as it is, or that of a file."""
    return problem if isinstance(problem, Problem) else load(problem)


@dataclass(frozen=True)
class RobotWithGait:
    """A gait with the robot that is to drive it.

    status    of the result that the gait was taken from; None if it was not taken from one
    limits    of the problem that it solves; None likewise
    warnings  possible misunderstandings of what this gait is
    """

    robot: Robot
    gait: Gait
    status: str | None = None
    warnings: tuple[str, ...] = ()
    limits: Limits | None = None


_AMPLITUDE, _PERIOD, _OFFSET = 0.785, 1.0, 0.0
"""The default gait: the paper's run with T = 1 s."""


def load_gait(
    path: PathLike | None = None,
    *,
    amplitude: float | str | None = None,
    period: float | str | None = None,
    offset: float | str | None = None,
) -> RobotWithGait:
    """The robot of a file, and a gait for it; None: the paper's prototype.

    A result.json has its own gait, of any shape. A problem gives the values that it fixes; the
    others are those of the paper's run with T = 1 s, clipped to the bounds. amplitude (rad), period
    (s) and offset (rad), numbers or text with a unit, override the file. Raises InputError for a
    file without a robot or problem.
    """
    values = read_arguments({"amplitude": amplitude, "period": period, "offset": offset})
    source = _source(None if path is None else Path(path), values)
    gait = source.gait
    size = {name: getattr(gait, name) for name in ("amplitude", "period", "offset")}
    return replace(source, gait=gait.resized(**{**size, **values}) if values else gait)


def _source(path: Path | None, given: Container[str]) -> RobotWithGait:
    if path is not None and path.is_file():
        document = read_document(path)
        if kind_of(document) == "result":
            return _of_result(document)
        if "platform1" in document.data:
            gait = SineGait(_AMPLITUDE, _PERIOD, _OFFSET)
            return RobotWithGait(read_robot(path), gait, None, _doubts(path, gait, None, given))
    if path is not None and path.is_dir() and not (path / "problem.yaml").exists():
        result = path / "result.json"
        raise InputError(
            f"{path}: This is a folder without problem.yaml. Expected a result.json, a robot "
            "file, a problem file or its folder. "
            + (f"Give {result}." if result.is_file() else "Give one of them.")
        )
    problem = read_problem(path)
    bounds = problem.gait
    gait = SineGait(
        bounds.amplitude.clip(_AMPLITUDE), bounds.period.clip(_PERIOD), bounds.offset.clip(_OFFSET)
    )
    doubts = _doubts(path, gait, bounds, given)
    # The shipped problem optimises the ratio; the robot driven here is the prototype.
    if path is None or problem.inertia_ratio is None:
        return RobotWithGait(problem.robot, gait, None, doubts)
    robot, note = _with_nearest_ratio(problem.robot, problem.inertia_ratio)
    return RobotWithGait(robot, gait, None, (*doubts, *note))


def _with_nearest_ratio(robot: Robot, choice: RatioChoice) -> tuple[Robot, tuple[str, ...]]:
    """The robot with the allowed inertia ratio closest to its own, and remarks on it.

    Raises InputError if no whole number of loads gives an allowed one.
    """
    own = inertia_ratio(robot, choice.about)
    ratio = choice.bounds.clip(own)
    if choice.by == "loads" and choice.loads.whole:
        count = math.ceil(load_count(robot, ratio, choice.about, choice.loads) - 1e-9)
        loaded = replace(robot, platform2=with_load_count(robot.platform2, choice.loads, count))
        ratio = inertia_ratio(loaded, choice.about)
        if ratio > choice.bounds.high * (1 + 1e-9):
            raise InputError(
                "No whole number of loads gives an inertia ratio J20/J10 from "
                f"{choice.bounds.low:.4g} to {choice.bounds.high:.4g}. Widen `inertia_ratio`."
            )
    if ratio == own:
        return robot, ()
    made = with_inertia_ratio(robot, ratio, choice.about, choice.by, choice.loads)
    if choice.bounds.fixed:
        return made, ()
    return made, (
        f"The problem leaves the inertia ratio J20/J10 open from {choice.bounds.low:.4g} to "
        f"{choice.bounds.high:.4g}. The closest to the robot's own {own:.4g} is driven, "
        f"{ratio:.4g}, not the optimum.",
    )


def _of_result(document: FileData) -> RobotWithGait:
    """Raises InputError if it holds no gait, or a wrong one."""
    robot: Any = document.data.get("robot")
    if "command" in document.data:
        raise InputError(
            f"{document.file}: Read the drive of a route, which is not a gait. Its set points are "
            "in setpoints.csv next to it; `rr-opt route --animate gif` animates it."
        )
    if not isinstance(document.data.get("gait"), dict) or not isinstance(robot, dict):
        raise InputError(
            f"{document.file}: The result has no gait: its status is "
            f"`{document.data['status']}`. Give the result of a problem that was solved."
        )
    servo = robot.get("servo")
    if isinstance(servo, dict):
        # null in a result means no limit.
        robot["servo"] = {key: math.inf if v is None else v for key, v in servo.items()}
    read, issues = robot_from(document.section("robot"))
    gait, found = gait_from(document.section("gait"))
    if read is None or gait is None:
        raise InvalidFileError([*issues, *found])
    status, message = (document.data.get(key) for key in ("status", "message"))
    if status == "optimal":
        return RobotWithGait(read, gait, "optimal", limits=_limits(document))
    why = f" {message}" if isinstance(message, str) else ""
    doubt = (
        f"{document.file}: The status of this result is {shown(status)} and not 'optimal'.{why} "
        "Its gait is driven anyway."
    )
    return RobotWithGait(read, gait, status if isinstance(status, str) else shown(status), (doubt,))


def _limits(document: FileData) -> Limits | None:
    """The limits that a result names; None if it does not. Raises InputError for wrong ones."""
    rows: Any = document.data.get("limits")
    if not isinstance(rows, list):
        return None
    try:
        named = {
            str(row["name"]): math.inf if row["limit"] is None else float(row["limit"])
            for row in rows
        }
        if all(limit > 0 for limit in named.values()):
            return Limits(**named)
    except (KeyError, TypeError, ValueError):
        pass
    raise InputError(
        f"{document.file}: limits: Read an entry that is not a limit. Expected each with the "
        "`name` of a limit and a positive `limit`, or null for none, as rr-opt writes them."
    )


def _doubts(
    path: Path | None, gait: Gait, bounds: GaitBounds | None, given: Container[str]
) -> tuple[str, ...]:
    """Sentences on a gait that a user may mistake for the optimum of a file (None: the prototype).

    bounds  of the problem; None for a robot file
    given   gait arguments set by the user; amplitude and period together define the user's own gait
    """
    of = "the prototype" if path is None else str(path)
    units = {"amplitude": "rad", "period": "s"}
    defaults = [
        name for name in units if name not in given and not (bounds and getattr(bounds, name).fixed)
    ]
    shape = bounds.shape if bounds else "sine"
    notes = []
    if defaults:
        values = [f"{name} {with_unit(getattr(gait, name), units[name])}" for name in defaults]
        notes.append(
            f"No {' and '.join(defaults)} given. The default is driven, {' and '.join(values)} as "
            f"in the paper's run, not the optimum of {of}."
        )
    if shape != "sine":
        notes.append(f"The problem asks for a `{shape}` gait, but a sine is driven.")
    if not notes:
        return ()
    command = shlex.join(["rr-opt", "maximize-speed", *([] if path is None else [str(path)])])
    result = Path("out") / name_of(path) / "result.json"
    choice = ", or --amplitude and --period" if defaults else ""
    return (" ".join([*notes, f"Run `{command}` first and give {result}{choice}."]),)
