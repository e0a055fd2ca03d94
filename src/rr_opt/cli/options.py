"""Arguments and options shared by verbs, and how they are read."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeVar

import typer

from rr_opt.cli.steps import StepDisplay, silent
from rr_opt.outcome import InputError, Status

if TYPE_CHECKING:
    from rr_opt.api.load import RobotWithGait
    from rr_opt.model.gait import Gait
    from rr_opt.model.problem import Problem
    from rr_opt.results.result import Result

Read = TypeVar("Read")


@contextmanager
def naming(source: Path | None) -> Iterator[None]:
    """Errors within this context name the file, as its gait may come from there."""
    try:
        yield
    except InputError as error:
        if source is None or str(source) in str(error):
            raise
        raise InputError(f"{source}: {error}") from None


def place(text: str) -> Path:
    """A path named by the user. Raises InputError for an empty name.

    An empty one, such as from an unset script variable, would be the current folder.
    """
    if not text.strip():
        raise InputError(
            "--out: Read an empty name. Expected the name of a folder or a file. "
            "Name one, `.` for the current folder, or omit --out."
        )
    return Path(text)


def out_option(shown: str, help: str = "Folder for the results.", metavar: str = "DIR") -> Any:
    """--out; shown: the default shown in the help."""
    return typer.Option("--out", "-o", parser=place, metavar=metavar, help=help, show_default=shown)


def json_option(file: str) -> Any:
    """--json, which prints the content of the file."""
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
    str | None, typer.Option(help="Run on a dask cluster: tcp://HOST:PORT of its scheduler.")
]

Force = Annotated[
    bool, typer.Option("--force", help="Overwrite a result that answers another question.")
]


def results_folder(out: Path | None, name: str) -> Path:
    """--out, or out/NAME. Raises InputError, before anything is computed, if it cannot be made."""
    from rr_opt.documents.archive import folder_for_results

    return folder_for_results(out or Path("out") / name)


def motion_folder(out: Path | None, name: str, film: Any, format: Any = "csv") -> Path:
    """The folder of a motion. Raises InputError also for files that cannot be made here."""
    from rr_opt.results.motion import check_files

    check_files(format, film)
    return results_folder(out, name)


TURN_UNITS = {"heading": "deg", "radius": "m", "within": "s", "length": "m"}
"""What a turn can specify, with the unit shown."""


def turn_words(asked: Mapping[str, Any]) -> list[str]:
    """The requested turn, in words without spaces."""
    sizes = {key: asked[key] for key in TURN_UNITS if asked.get(key) is not None}
    shown = {key: math.degrees(size) if key == "heading" else size for key, size in sizes.items()}
    whole = ["whole"] if asked.get("cycles") == "whole" else []
    return [*(f"{key}-{size:.6g}{TURN_UNITS[key]}" for key, size in shown.items()), *whole]


def require_same_turn(folder: Path, asked: Mapping[str, Any], force: bool) -> None:
    """Raise InputError if the folder has the result of another turn, or of none."""
    import json

    file = folder / "result.json"
    if force or not file.is_file():
        return
    try:
        turn = json.loads(file.read_text(encoding="utf-8")).get("turn") or {}
        there = dict(turn.get("asked") or {})
    except (OSError, ValueError, AttributeError, TypeError):
        return
    if there != asked:
        words = (
            f"the turn {' '.join(turn_words(there))}"
            if there
            else "the fastest gait without a turn"
        )
        raise InputError(
            f"{file}: The file has the answer to another question: {words}. Expected a folder for "
            "this one. Give another with --out, or overwrite it with --force."
        )


def read_options(**given: str | float | None) -> dict[str, float]:
    """The options that were given, in SI. Raises InputError with all mistakes in them."""
    from rr_opt.api.load import read_arguments

    return read_arguments(given, prefix="--")


def read_problem(path: Path | None) -> Problem:
    """The problem of a file (None: the shipped one); warnings go to stderr."""
    from rr_opt.api.load import load, shipped

    return shipped() if path is None else read(load, path)


def read(load: Callable[[Path], Read], path: Path) -> Read:
    """The object that a library function loads from a file; warnings go to stderr."""
    from rr_opt.api.load import InputWarning

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        found = load(path)
    if not silent():
        for warning in caught:
            typer.echo(str(warning.message), err=True)
    return found


def read_columns(text: str | None) -> dict[str, str] | None:
    """The column of each channel of --columns; None if it was not given."""
    if text is None:
        return None
    pairs = [pair.partition("=") for pair in text.split(",")]
    if not all(channel.strip() and name.strip() for channel, _, name in pairs):
        raise InputError(
            f"--columns: Read {text!r}. Expected a column for each channel: `t=time,psi=yaw`."
        )
    return {channel.strip(): name.strip() for channel, _, name in pairs}


def read_command(**sizes: str | None) -> Gait | None:
    """The commanded gait of --amplitude, --period and --offset; None if there is none."""
    read = read_options(**sizes)
    if not read:
        return None
    if "amplitude" not in read or "period" not in read:
        raise InputError(
            "Read only part of a command. Expected --amplitude and --period, and --offset unless "
            "it is 0. Give both, or neither."
        )
    from rr_opt.model.gait import SineGait

    return SineGait(read["amplitude"], read["period"], read.get("offset", 0.0))


def read_gait(path: Path | None, **given: str | float | None) -> RobotWithGait:
    """The robot and gait of a file (None: the prototype), with the given options for the gait.

    All options are read, so that every mistake in them is reported; warnings go to stderr.
    """
    from rr_opt.api.load import load_gait

    options = read_options(**given)
    sizes = {name: options.get(name) for name in ("amplitude", "period", "offset")}
    driven = load_gait(path, **sizes)
    warn(driven.warnings)
    return driven


def result_name(path: Path | None) -> str:
    """The name of a result: the folder it is in; for other files, as for a problem."""
    from rr_opt.files.problem_file import name_of

    if path is not None and path.name == "result.json":
        return path.resolve().parent.name
    return name_of(path)


def warn(sentences: Iterable[str]) -> None:
    """Warnings on stderr."""
    if not silent():
        for sentence in sentences:
            typer.echo(f"warning: {sentence}", err=True)


Radius = Annotated[
    str | None,
    typer.Option(help="Radius of the circle in m, or with a unit; positive to the left."),
]
Heading = Annotated[
    str | None,
    typer.Option(help="Change of heading in rad, or with a unit: '90 deg'; positive to the left."),
]
Within = Annotated[str | None, typer.Option(help="Maximum time for the change of heading, s.")]
Length = Annotated[
    str | None, typer.Option(help="Maximum path length for the change of heading, m.")
]
Cycles = Annotated[
    Literal["any", "whole"],
    typer.Option(help="whole: change the heading in a whole number of periods."),
]

SetPoints = Annotated[
    Literal["csv", "c-header", "servo"],
    typer.Option(
        "--format",
        help="csv: time and angle in rad and degrees; c-header: a C array; "
        "servo: counts of the servo CDS5516.",
    ),
]
KeepPeriod = Annotated[
    bool, typer.Option("--keep-period", help="Adjust the rate instead of the period.")
]

WithinLimits = Annotated[
    bool, typer.Option(help="Lower the amplitude until every step is within the limits.")
]

Trajectory = Annotated[Literal["csv", "netcdf"], typer.Option("--format", help="Trajectory file.")]
Film = Annotated[Literal["gif", "mp4"] | None, typer.Option(help="Also make an animation.")]
From = Annotated[
    Literal["rest", "steady"], typer.Option(help="From rest, or from the steady state.")
]

Seconds = Annotated[float, typer.Option(help="Simulated time, s.")]
Samples = Annotated[float, typer.Option(help="Samples per second.")]
PointRate = Annotated[
    float | None,
    typer.Option(
        help="Set points per second; default: 125 or, for servo, the highest rate below that at "
        "which the largest step is a whole number of counts.",
        show_default=False,
    ),
]
PointFile = Annotated[Path | None, out_option("out/NAME-...", "The file to write.", "FILE")]
MotionFolder = Annotated[Path | None, out_option("out/NAME-motion", "Folder for the files.")]

Recorded = Annotated[
    Path,
    typer.Argument(
        metavar="FILE|FOLDER",
        help="A recording (plain CSV, Vicon, Motive or Qualisys export, C3D, TRC, netCDF or ROS "
        "bag), or the folder of an experiment.",
    ),
]
Layout = Annotated[
    Path | None,
    typer.Option(
        metavar="YAML", help="Position of each marker; default: estimated from the recording."
    ),
]
ServoLog = Annotated[
    Path | None, typer.Option(metavar="CSV", help="The servo's log, on its own clock.")
]
Columns = Annotated[
    str | None,
    typer.Option(
        metavar="CHANNEL=COLUMN,...",
        help="Which columns of a text file hold the channels t, x, y, psi, phi: "
        "'psi=yaw [deg],t=time'.",
    ),
]
CommandedAmplitude = Annotated[
    str | None, typer.Option(help="Commanded amplitude in rad, or with a unit.")
]
CommandedPeriod = Annotated[str | None, typer.Option(help="Commanded period, s.")]
CommandedOffset = Annotated[str | None, typer.Option(help="Commanded offset, rad.")]
Start = Annotated[
    Literal["rest", "running"],
    typer.Option(help="Whether the robot stood still until t = 0 or was already running."),
]
NetCDF = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Also write the recording, with its flags, as netCDF."),
]


def show(
    result: Result,
    steps: StepDisplay | None = None,
    place: Path | None = None,
    *,
    json: bool,
    **how: Any,
) -> None:
    """Print a result and its warnings, write it as requested (`how`), and print its files.

    The text comes first, as figures take longer. Exits with an error status if the result has one.
    """
    from rr_opt.documents.archive import strict_json
    from rr_opt.documents.rendering import columns

    warn(result.warnings)
    files: Sequence[Path] = ()
    if not json:
        typer.echo(result.summary(), nl=False)
    if steps and place:
        with steps:
            files = result.save(place, progress=steps, **how)
    if json:
        typer.echo(strict_json(result.record(files)), nl=False)
    elif files:
        rows = [("" if k else "files", str(file)) for k, file in enumerate(files)]
        typer.echo("\n".join(["", *columns(rows)]))
    if result.status is not Status.OPTIMAL:
        typer.echo(result.message, err=True)
        raise typer.Exit(result.status.exit_code)
