"""Recordings, read and cleaned, with everything that looks wrong in them."""

from __future__ import annotations

from pathlib import Path
from typing import NoReturn

from rr_opt.documents.archive import file_for_result
from rr_opt.files.experiment_file import read_plan
from rr_opt.files.source import fingerprint
from rr_opt.model.experiment import Start
from rr_opt.model.gait import Gait
from rr_opt.outcome import InputError
from rr_opt.recordings.experiment import inspect_experiment, is_experiment
from rr_opt.recordings.inspection import inspect_file
from rr_opt.results.inspection import InspectedRecordings
from rr_opt.results.result import Progress, quiet


def inspect(
    source: str | Path,
    *,
    layout: str | Path | None = None,
    servo_log: str | Path | None = None,
    gait: Gait | None = None,
    start: Start = "running",
    progress: Progress = quiet,
) -> InspectedRecordings:
    """A recording, or all of an experiment's folder, read and cleaned.

    Nothing is filled in or dropped: outliers are flagged, gaps stay gaps. Of one recording,

    layout     YAML file that says where each marker sits; None: estimated
    servo_log  the servo's log, on its own clock
    gait       what was commanded
    start      `rest`: the robot stood still until t = 0

    Raises InputError for what cannot be read.
    """
    path = Path(source)
    if is_experiment(path):
        given = {"layout": layout, "servo_log": servo_log, "gait": gait}
        wrong = [name for name, value in given.items() if value is not None]
        if wrong:
            _refuse(wrong)
        found = inspect_experiment(path, progress)
        sha256 = read_plan(path)[0].sha256
    else:
        layout_file, log = (None if one is None else Path(one) for one in (layout, servo_log))
        found = [inspect_file(path, layout=layout_file, servo_log=log, gait=gait, start=start)]
        sha256 = fingerprint([path])
    return InspectedRecordings(name_of(path), sha256, tuple(found))


def name_of(source: Path) -> str:
    """What an inspection is called: the experiment's folder, or the recording's file."""
    full = source.resolve()
    if source.is_dir() or full.name == "experiment.yaml":
        return full.name if source.is_dir() else full.parent.name
    return full.stem


def check_files(source: Path, netcdf: Path | None) -> None:
    """Raise InputError, before anything is read, for a netCDF file that cannot be made."""
    if netcdf is None:
        return
    file_for_result(netcdf)
    if is_experiment(source):
        _refuse(["netcdf"])


def _refuse(given: list[str]) -> NoReturn:
    """Of an experiment its file says all this. Raises InputError."""
    options = " and ".join(f"--{name.replace('_', '-')}" for name in given)
    raise InputError(
        f"{options} came with an experiment. Expected one recording: the experiment's file says "
        "how each was made. Name the file of a recording."
    )
