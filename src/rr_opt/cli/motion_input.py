"""What `simulate` drives: the robot and the gait of a robot file, a problem or a result."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rr_opt.outcome import InputError

if TYPE_CHECKING:
    from rr_opt.files.document import Document
    from rr_opt.problem import Interval
    from rr_opt.robot.gait import SineGait
    from rr_opt.robot.parameters import Robot

AMPLITUDE, PERIOD, OFFSET = 0.785, 1.0, 0.0
"""The gait where none is given: the paper's run with T = 1 s."""


def robot_and_gait(path: Path | None) -> tuple[Robot, SineGait]:
    """The robot of a file (None: the prototype) and its gait.

    A result has its own gait; of a problem the values that it fixes are taken, and the others
    are the paper's run, brought within the problem's bounds.
    """
    from rr_opt.files import read_document, read_problem  # noqa: PLC0415
    from rr_opt.robot.gait import SineGait  # noqa: PLC0415

    if path is not None and path.is_file():
        document = read_document(path)
        if {"status", "input_sha256"} <= document.data.keys():
            return _of_result(document)
        if "platform1" in document.data:
            from rr_opt.files import read_robot  # noqa: PLC0415

            return read_robot(path), SineGait(AMPLITUDE, PERIOD, OFFSET)
    problem = read_problem(path)
    gait = problem.gait
    return problem.robot, SineGait(
        _within(gait.amplitude, AMPLITUDE),
        _within(gait.period, PERIOD),
        _within(gait.offset, OFFSET),
    )


def with_options(
    gait: SineGait, amplitude: str | None, period: str | None, offset: str | None
) -> SineGait:
    """The gait with the values given on the command line, each a number or one with its unit."""
    changed = {
        name: _quantity(name, text, unit)
        for name, text, unit in (
            ("amplitude", amplitude, "rad"),
            ("period", period, "s"),
            ("offset", offset, "rad"),
        )
        if text is not None
    }
    gait = replace(gait, **changed)
    if gait.period <= 0:
        raise InputError(f"--period: Read {period}. Expected a time above 0, such as `1.2 s`.")
    return gait


def _quantity(name: str, text: str, unit: str) -> float:
    from rr_opt.files import to_si  # noqa: PLC0415

    try:
        value = to_si(text, unit)
    except InputError as error:
        raise InputError(f"--{name}: {error}") from None
    if not math.isfinite(value):
        raise InputError(f"--{name}: Read {text}. Expected a number.")
    return value


def _within(box: Interval, value: float) -> float:
    return box.clip(value)


def _of_result(document: Document) -> tuple[Robot, SineGait]:
    from rr_opt.files import InvalidFileError, robot_from  # noqa: PLC0415
    from rr_opt.robot.gait import SineGait  # noqa: PLC0415

    gait: Any = document.data.get("gait")
    robot: Any = document.data.get("robot")
    if not isinstance(gait, dict) or not isinstance(robot, dict):
        raise InputError(
            f"{document.file}: The result holds no gait: its status is "
            f"`{document.data['status']}`. Give the result of a problem that was solved."
        )
    servo = robot.get("servo")
    if isinstance(servo, dict):
        # null in a result is a limit that does not exist.
        robot["servo"] = {key: math.inf if v is None else v for key, v in servo.items()}
    read, issues = robot_from(document.section("robot"))
    if read is None:
        raise InvalidFileError(issues)
    try:
        return read, SineGait(*(float(gait[key]) for key in ("amplitude", "period", "offset")))
    except (KeyError, TypeError, ValueError):
        raise InputError(
            f"{document.file}: gait: Expected the numbers amplitude, period and offset."
        ) from None
