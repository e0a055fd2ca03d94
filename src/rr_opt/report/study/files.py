"""The folder of a study: the table, the record for scripts, the figures and the page."""

from __future__ import annotations

from pathlib import Path

from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.study.result import Studied
from rr_opt.report.study.summary import record
from rr_opt.report.study.table import columns_of, csv_text, write_netcdf

TABLE, NETCDF, RECORD, PAGE = "study.csv", "study.nc", "study.json", "report.html"
FIGURES = ("speed", "map", "held", "pareto")


def check_wishes(*, netcdf: bool) -> None:
    """Raise InputError, before anything is computed, for a file that cannot be made here."""
    if netcdf:
        from rr_opt.report.trajectory_file import netcdf_writer  # noqa: PLC0415

        netcdf_writer()


def write_study(result: Studied, folder: Path, *, netcdf: bool, figures: bool) -> list[Path]:
    """Write everything; returns the files. What an earlier run left is removed before."""
    remove(folder, (TABLE, NETCDF, RECORD, PAGE, *(f"{name}.svg" for name in FIGURES)))
    written = [
        write_text(folder / TABLE, csv_text(columns_of(result))),
        write_json(folder / RECORD, record(result)),
    ]
    if netcdf:
        written.append(write_netcdf(folder / NETCDF, result))
    if not figures:
        return written
    # Here and not above: without figures matplotlib need not be loaded.
    from rr_opt.report.figures.study.figures import draw  # noqa: PLC0415
    from rr_opt.report.study.page import page  # noqa: PLC0415

    drawn = draw(result)
    for name, svg in drawn.items():
        written.append(write_text(folder / f"{name}.svg", svg))
    return [write_text(folder / PAGE, page(result, drawn)), *written]
