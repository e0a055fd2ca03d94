"""`rr-opt inspect FILE`: read a recording, clean it, and tell every doubt."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rr_opt.cli.options import Figures, json_option, out_option
from rr_opt.cli.steps import Steps
from rr_opt.outcome import InputError

if TYPE_CHECKING:
    from rr_opt.model.gait import Gait


class Start(StrEnum):
    """How a recording begins."""

    REST = "rest"
    RUNNING = "running"


def inspect(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="FILE|FOLDER",
            help="A recording (plain CSV, Vicon CSV, C3D, TRC or netCDF), or the folder of an "
            "experiment.",
        ),
    ],
    *,
    layout: Annotated[
        Path | None,
        typer.Option(
            metavar="YAML", help="Where each marker sits; estimated from the recording if left out."
        ),
    ] = None,
    servo_log: Annotated[
        Path | None, typer.Option(metavar="CSV", help="The servo's log, on its own clock.")
    ] = None,
    amplitude: Annotated[
        str | None, typer.Option(help="Commanded amplitude, rad, or with a unit.")
    ] = None,
    period: Annotated[str | None, typer.Option(help="Commanded period, s.")] = None,
    offset: Annotated[str | None, typer.Option(help="Commanded offset, rad.")] = None,
    start: Annotated[
        Start, typer.Option(help="The robot stood still until t = 0, or was running.")
    ] = Start.RUNNING,
    out: Annotated[Path | None, out_option("out/NAME-inspect")] = None,
    netcdf: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Also write the recording, with its flags, as netCDF."),
    ] = None,
    figures: Figures = True,
    json: Annotated[bool, json_option("inspection.json")] = False,
) -> None:
    """Read a recording, clean it, and tell every doubt.

    Nothing is filled in or dropped: outliers are flagged, gaps stay gaps. Writes inspection.json
    and report.html.
    """
    with Steps() as steps:
        steps("reading")
        from rr_opt.recordings.inspection import inspect_experiment, inspect_file, is_experiment
        from rr_opt.report.archive import file_for_result, folder_for_results, strict_json
        from rr_opt.report.inspect.page import summary, write_inspection, write_recording
        from rr_opt.report.inspect.record import record

        name = _name_of(source)
        folder = folder_for_results(out or Path("out") / f"{name}-inspect")
        if netcdf is not None:
            file_for_result(netcdf)
        gait = _gait(amplitude, period, offset)
        if is_experiment(source):
            _refuse_options(layout, servo_log, gait, netcdf)
            found = inspect_experiment(source, steps)
        else:
            found = [
                inspect_file(
                    source, layout=layout, servo_log=servo_log, gait=gait, start=start.value
                )
            ]
        sha256 = _sha256(source)
        written = write_inspection(name, sha256, found, folder, figures=figures, progress=steps)
        if netcdf is not None:
            written.append(write_recording(netcdf, found[0]))
    if json:
        typer.echo(strict_json(record(name, sha256, found)), nl=False)
    else:
        typer.echo(summary(found, written), nl=False)


def _gait(amplitude: str | None, period: str | None, offset: str | None) -> Gait | None:
    """The gait of the options; None if there is none."""
    if amplitude is None and period is None and offset is None:
        return None
    from rr_opt.cli.motion_input import read_options
    from rr_opt.model.gait import SineGait

    read = read_options(amplitude=amplitude, period=period, offset=offset)
    if "amplitude" not in read or "period" not in read:
        raise InputError(
            "The command was given in part. Expected --amplitude and --period, and --offset unless "
            "it is 0. Give both, or neither."
        )
    return SineGait(read["amplitude"], read["period"], read.get("offset", 0.0))


def _refuse_options(
    layout: Path | None, servo_log: Path | None, gait: Gait | None, netcdf: Path | None
) -> None:
    """Of an experiment its file says all this. Raises InputError."""
    given = {"--layout": layout, "--servo-log": servo_log, "--amplitude": gait, "--netcdf": netcdf}
    wrong = [option for option, value in given.items() if value is not None]
    if wrong:
        raise InputError(
            f"{' and '.join(wrong)} came with an experiment. Expected one recording: the "
            "experiment's file says how each was made. Name the file of a recording."
        )


def _name_of(source: Path) -> str:
    full = source.resolve()
    if source.is_dir() or full.name == "experiment.yaml":
        return full.name if source.is_dir() else full.parent.name
    return full.stem


def _sha256(source: Path) -> str:
    from rr_opt.files.experiment_file import read_plan
    from rr_opt.recordings.inspection import is_experiment

    if is_experiment(source):
        return read_plan(source)[0].sha256
    import hashlib  # loads OpenSSL, which help can do without

    return hashlib.sha256(source.read_bytes()).hexdigest()
