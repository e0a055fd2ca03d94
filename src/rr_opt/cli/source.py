"""What a file gives to drive; and what a result does, whatever its status."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rr_opt.outcome import InputError

if TYPE_CHECKING:
    from rr_opt.files.document import Document
    from rr_opt.robot.gait import Gait
    from rr_opt.robot.parameters import Robot


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
    from rr_opt.files import InvalidFileError, robot_from  # noqa: PLC0415
    from rr_opt.files.gait_record import gait_from  # noqa: PLC0415
    from rr_opt.files.issue import shown  # noqa: PLC0415

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
