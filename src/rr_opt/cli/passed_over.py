"""The warning that some of a robot's effects have no place in what a verb computes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from rr_opt.robot.parameters import Robot


def tell_passed_over(robot: Robot) -> None:
    """One line on stderr, if the robot has such effects."""
    if not robot.physics:
        return
    from rr_opt.physics.effects import Port  # noqa: PLC0415
    from rr_opt.physics.steady_effects import passed_over  # noqa: PLC0415

    names, of_servo = passed_over(robot), passed_over(robot, Port.ACTUATION)
    if not names:
        return
    told = (
        f"warning: {', '.join(names)}: passed over here. The motion is that of a level, even floor "
        "without side slip, driven by the angle that the servo makes."
    )
    if of_servo:
        told += f" Command the servo so that it makes this angle in spite of {', '.join(of_servo)}."
    typer.echo(told, err=True)
