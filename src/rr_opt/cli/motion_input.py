"""What `simulate` and `export` drive: the robot and the gait of a robot, a problem or a result."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from rr_opt.cli.passed_over import tell_passed_over
from rr_opt.cli.source import Source, source_of_result
from rr_opt.outcome import InputError

if TYPE_CHECKING:
    from rr_opt.robot.gait import Gait

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


def _source(path: Path | None, options: dict[str, float]) -> Source:
    from rr_opt.cli.default_gait import doubts  # noqa: PLC0415
    from rr_opt.files import read_document, read_problem  # noqa: PLC0415
    from rr_opt.files.kind import kind_of  # noqa: PLC0415
    from rr_opt.robot.gait import SineGait  # noqa: PLC0415

    if path is not None and path.is_file():
        document = read_document(path)
        if kind_of(document) == "result":
            return source_of_result(document)
        if "platform1" in document.data:
            from rr_opt.files import read_robot  # noqa: PLC0415

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
