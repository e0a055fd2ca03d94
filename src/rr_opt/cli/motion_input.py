"""What `simulate` and `export` drive: the robot and the gait of a robot, a problem or a result."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rr_opt.outcome import InputError

if TYPE_CHECKING:
    from rr_opt.files.document import Document
    from rr_opt.robot.gait import Gait
    from rr_opt.robot.parameters import Robot

AMPLITUDE, PERIOD, OFFSET = 0.785, 1.0, 0.0
"""The gait where none is given: the paper's run with T = 1 s."""


def robot_and_gait(path: Path | None) -> tuple[Robot, Gait]:
    """The robot of a file (None: the prototype) and its gait.

    A result has its own gait, of whatever shape. Of a problem the values that it fixes are taken,
    and the others are the paper's run, brought within the problem's bounds.
    """
    from rr_opt.files import read_document, read_problem  # noqa: PLC0415
    from rr_opt.files.kind import kind_of  # noqa: PLC0415
    from rr_opt.robot.gait import SineGait  # noqa: PLC0415

    if path is not None and path.is_file():
        document = read_document(path)
        if kind_of(document) == "result":
            return _of_result(document)
        if "platform1" in document.data:
            from rr_opt.files import read_robot  # noqa: PLC0415

            return read_robot(path), SineGait(AMPLITUDE, PERIOD, OFFSET)
    problem = read_problem(path)
    gait = problem.gait
    return problem.robot, SineGait(
        gait.amplitude.clip(AMPLITUDE), gait.period.clip(PERIOD), gait.offset.clip(OFFSET)
    )


def read_options(**given: str | float | None) -> dict[str, float]:
    """The options that were given, in SI, each a number or a text with its unit.

    Raises InputError with everything that is wrong with all of them.
    """
    from rr_opt.files.quantity import Quantity  # noqa: PLC0415

    kinds = {
        "amplitude": Quantity("rad", "30 deg", at_least=0),
        "period": Quantity("s", "1.2 s", above=0),
        "offset": Quantity("rad", "10 deg"),
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
    from rr_opt.cli.problem_input import name_of  # noqa: PLC0415

    if path is not None and path.name == "result.json":
        return path.resolve().parent.name
    return name_of(path)


def _of_result(document: Document) -> tuple[Robot, Gait]:
    from rr_opt.files import InvalidFileError, robot_from  # noqa: PLC0415
    from rr_opt.files.gait_record import gait_from  # noqa: PLC0415

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
    return read, gait
