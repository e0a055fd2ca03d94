"""What verbs read, warn of, and say about progress and results."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from rr_opt.outcome import InputError

if TYPE_CHECKING:
    from rr_opt.model.problem import Problem
    from rr_opt.model.robot import Robot


def place(text: str) -> Path:
    """A path that the user named. Raises InputError for no name at all.

    Without this an empty one, as an unset variable of a script leaves it, is the current folder.
    """
    if not text.strip():
        raise InputError(
            "--out: Read an empty name. Expected the name of a folder or a file. "
            "Name one, `.` for the current folder, or leave --out away."
        )
    return Path(text)


def tell_passed_over(robot: Robot) -> None:
    """One line on stderr, if the robot has such effects."""
    if not robot.physics:
        return
    from rr_opt.effects.effect import Port
    from rr_opt.motion.dynamics import ignored_in_steady_cycle

    names, of_servo = ignored_in_steady_cycle(robot), ignored_in_steady_cycle(robot, Port.ACTUATION)
    if not names:
        return
    told = (
        f"warning: {', '.join(names)}: passed over here. The motion is that of a level, even floor "
        "without side slip, driven by the angle that the servo makes."
    )
    if of_servo:
        told += f" Command the servo so that it makes this angle in spite of {', '.join(of_servo)}."
    typer.echo(told, err=True)


def read(path: Path | None) -> tuple[Problem, str]:
    """The problem of a file (None: the shipped one), and its fingerprint."""
    from rr_opt.files.lint import lint_file
    from rr_opt.files.problem_file import input_sha256, read_problem

    problem = read_problem(path)
    if path is not None:
        for issue in lint_file(path):
            typer.echo(str(issue), err=True)
    tell_passed_over(problem.robot)
    return problem, input_sha256(path)


def name_of(path: Path | None) -> str:
    """What a problem is called: its folder if the file is a problem.yaml, else the file."""
    if path is None:
        return "prototype"
    full = path.resolve()
    return full.parent.name if full.name == "problem.yaml" else full.stem
