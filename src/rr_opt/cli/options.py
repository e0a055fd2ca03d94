"""Arguments and options that verbs have in common, and how they are read."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rr_opt.cli.steps import silent
from rr_opt.outcome import InputError

if TYPE_CHECKING:
    from rr_opt.api.load import RobotWithGait
    from rr_opt.model.problem import Problem


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


def out_option(shown: str, help: str = "Folder for the results.", metavar: str = "DIR") -> Any:
    """--out; shown: what it is if left out."""
    return typer.Option("--out", "-o", parser=place, metavar=metavar, help=help, show_default=shown)


def json_option(file: str) -> Any:
    """--json, which prints what the file holds."""
    return typer.Option("--json", help=f"Print only {file} on stdout.")


ProblemFile = Annotated[
    Path | None,
    typer.Argument(
        help="Problem file, its folder, or a robot file; default: the paper's prototype."
    ),
]
Driven = Annotated[
    Path | None,
    typer.Argument(
        metavar="[FILE]",
        help="Robot file, problem file or result.json; default: the paper's prototype.",
    ),
]
Amplitude = Annotated[str | None, typer.Option(help="Amplitude in rad, or with a unit: '30 deg'.")]
Period = Annotated[str | None, typer.Option(help="Period in s, or with a unit.")]
Offset = Annotated[str | None, typer.Option(help="Offset in rad, or with a unit.")]
Summary = Annotated[
    bool, typer.Option("--json", help="Print only a machine-readable summary on stdout.")
]
Figures = Annotated[
    bool, typer.Option("--figures/--no-figures", help="Draw figures and write report.html.")
]
Workers = Annotated[
    int | None, typer.Option(help="Number of processes.", min=1, show_default="one per core")
]
Scheduler = Annotated[
    str | None, typer.Option(help="Work on a dask cluster: tcp://HOST:PORT of its scheduler.")
]


def results_folder(out: Path | None, name: str) -> Path:
    """--out, or out/NAME. Raises InputError, before anything is computed, if it cannot be made."""
    from rr_opt.documents.archive import folder_for_results

    return folder_for_results(out or Path("out") / name)


def read_options(**given: str | float | None) -> dict[str, float]:
    """The options that were given, in SI. Raises InputError with all that is wrong with them."""
    from rr_opt.api.arguments import read_arguments

    return read_arguments(given, prefix="--")


def read_problem(path: Path | None) -> Problem:
    """The problem of a file (None: the shipped one); what looks wrong goes to stderr."""
    from rr_opt.api.load import InputWarning, load, shipped

    if path is None:
        return shipped()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        problem = load(path)
    if not silent():
        for warning in caught:
            typer.echo(str(warning.message), err=True)
    return problem


def read_gait(path: Path | None, options: dict[str, float]) -> RobotWithGait:
    """What a file (None: the prototype) gives to drive; warnings go to stderr."""
    from rr_opt.api.load import load_gait

    sizes = {name: options.get(name) for name in ("amplitude", "period", "offset")}
    driven = load_gait(path, **sizes)
    warn(driven.warnings)
    return driven


def result_name(path: Path | None) -> str:
    """What a result is called: the folder it lies in; anything else as a problem is."""
    from rr_opt.files.problem_file import name_of

    if path is not None and path.name == "result.json":
        return path.resolve().parent.name
    return name_of(path)


def warn(sentences: Iterable[str]) -> None:
    """Warnings on stderr."""
    if not silent():
        for sentence in sentences:
            typer.echo(f"warning: {sentence}", err=True)
