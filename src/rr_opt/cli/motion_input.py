"""What `simulate` and `export` drive: the robot and the gait of a robot, a problem or a result."""

from __future__ import annotations

import math
import shlex
from collections.abc import Container
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from rr_opt.cli.problem_input import tell_passed_over
from rr_opt.outcome import InputError

if TYPE_CHECKING:
    from rr_opt.files.yaml_text import Document
    from rr_opt.model.gait import Gait
    from rr_opt.model.problem import GaitBounds
    from rr_opt.model.robot import Robot


@dataclass(frozen=True)
class Source:
    """What a file gives to drive.

    status   of a result; None of a robot or a problem
    doubts   what a user may take this gait for that it is not
    """

    robot: Robot
    gait: Gait
    status: str | None = None
    doubts: tuple[str, ...] = ()


def source_of_result(document: Document) -> Source:
    """What a result gives. Raises InputError if it holds no gait, or a wrong one."""
    from rr_opt.files.gait_record import gait_from
    from rr_opt.files.issue import InvalidFileError
    from rr_opt.files.robot_file import robot_from
    from rr_opt.messages import shown

    robot: Any = document.data.get("robot")
    if not isinstance(document.data.get("gait"), dict) or not isinstance(robot, dict):
        raise InputError(
            f"{document.file}: The result holds no gait: its status is "
            f"`{document.data['status']}`. Give the result of a problem that was solved."
        )
    servo = robot.get("servo")
    if isinstance(servo, dict):
        # null in a result is a limit that does not exist.
        robot["servo"] = {key: math.inf if v is None else v for key, v in servo.items()}
    read, issues = robot_from(document.section("robot"))
    gait, found = gait_from(document.section("gait"))
    if read is None or gait is None:
        raise InvalidFileError([*issues, *found])
    status, message = (document.data.get(key) for key in ("status", "message"))
    if status == "optimal":
        return Source(read, gait, "optimal")
    why = f" {message}" if isinstance(message, str) else ""
    doubt = (
        f"{document.file}: The status of this result is {shown(status)} and not 'optimal'.{why} "
        "Its gait is driven all the same."
    )
    return Source(read, gait, status if isinstance(status, str) else shown(status), (doubt,))


def doubts(
    path: Path | None, gait: Gait, bounds: GaitBounds | None, options: Container[str]
) -> tuple[str, ...]:
    """What a user may take for the optimum of a file (None: the prototype), in whole sentences.

    bounds   of the problem; None of a robot file
    options  those that were given: with amplitude and period the user has chosen the gait
    """
    from rr_opt.answers.quantities import with_unit
    from rr_opt.cli.problem_input import name_of

    of = "the prototype" if path is None else str(path)
    units = {"amplitude": "rad", "period": "s"}
    defaults = [
        name
        for name in units
        if name not in options and not (bounds and getattr(bounds, name).fixed)
    ]
    shape = bounds.shape if bounds else "sine"
    told = []
    if defaults:
        values = [f"{name} {with_unit(getattr(gait, name), units[name])}" for name in defaults]
        told.append(
            f"No {' and '.join(defaults)} given. The default is driven, {' and '.join(values)} "
            f"after the paper's run, and not the optimum of {of}."
        )
    if shape != "sine":
        told.append(f"The problem asks for a `{shape}` gait, and a sine is driven.")
    if not told:
        return ()
    command = shlex.join(["rr-opt", "maximize-speed", *([] if path is None else [str(path)])])
    result = Path("out") / name_of(path) / "result.json"
    choice = ", or --amplitude and --period" if defaults else ""
    return (" ".join([*told, f"Run `{command}` first and give {result}{choice}."]),)


AMPLITUDE, PERIOD, OFFSET = 0.785, 1.0, 0.0
"""The gait where none is given: the paper's run with T = 1 s."""


def read_source(path: Path | None, options: dict[str, float]) -> Source:
    """What a file (None: the prototype) gives, with what the options say of its gait.

    A result has its own gait, of whatever shape. Of a problem the values that it fixes are taken,
    and the others are the paper's run, brought within the problem's bounds. Doubts go to stderr.
    """
    source = _source(path, options)
    for doubt in source.doubts:
        typer.echo(f"warning: {doubt}", err=True)
    tell_passed_over(source.robot)
    return replace(source, gait=with_options(source.gait, options))


def read_options(**given: str | float | None) -> dict[str, float]:
    """The options that were given, in SI, each a number or a text with its unit.

    Raises InputError with everything that is wrong with all of them.
    """
    from rr_opt.model import gait
    from rr_opt.units import Quantity

    kinds = {
        "amplitude": gait.AMPLITUDE,
        "period": gait.PERIOD,
        "offset": gait.OFFSET,
        "seconds": Quantity("s", "10", above=0),
        "rate": Quantity("1/s", "100", above=0),
    }
    values, wrong = {}, []
    for name, value in given.items():
        if value is not None:
            try:
                values[name] = kinds[name].read(value)
            except InputError as error:
                wrong.append(f"--{name}: {error}")
    if wrong:
        raise InputError("\n".join(wrong))
    return values


def with_options(gait: Gait, options: dict[str, float]) -> Gait:
    """The gait in its own shape with what the options say of amplitude, period and offset."""
    size = {name: getattr(gait, name) for name in ("amplitude", "period", "offset")}
    given = {name: value for name, value in options.items() if name in size}
    return gait.resized(**{**size, **given}) if given else gait


def result_name(path: Path | None) -> str:
    """What a result is called: the folder it lies in; anything else as the other verbs call it."""
    from rr_opt.cli.problem_input import name_of

    if path is not None and path.name == "result.json":
        return path.resolve().parent.name
    return name_of(path)


def _source(path: Path | None, options: dict[str, float]) -> Source:
    from rr_opt.files.problem_file import kind_of, read_problem
    from rr_opt.files.source import read_document
    from rr_opt.model.gait import SineGait

    if path is not None and path.is_file():
        document = read_document(path)
        if kind_of(document) == "result":
            return source_of_result(document)
        if "platform1" in document.data:
            from rr_opt.files.robot_file import read_robot

            gait = SineGait(AMPLITUDE, PERIOD, OFFSET)
            return Source(read_robot(path), gait, doubts=doubts(path, gait, None, options))
    if path is not None and path.is_dir():
        _require_problem(path)
    problem = read_problem(path)
    bounds = problem.gait
    gait = SineGait(
        bounds.amplitude.clip(AMPLITUDE), bounds.period.clip(PERIOD), bounds.offset.clip(OFFSET)
    )
    return Source(problem.robot, gait, doubts=doubts(path, gait, bounds, options))


def _require_problem(folder: Path) -> None:
    if not (folder / "problem.yaml").exists():
        result = folder / "result.json"
        raise InputError(
            f"{folder}: This is a folder without problem.yaml. Expected a result.json, a robot "
            "file, a problem file or its folder. "
            + (f"Give {result}." if result.is_file() else "Give one of them.")
        )
