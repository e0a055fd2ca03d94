"""The table of a study: one row a case, its inputs first; and as netCDF over the axes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.answers.quantities import direction_text
from rr_opt.answers.study import StudyAnswer
from rr_opt.report.archive import whole
from rr_opt.report.document import Column, Table
from rr_opt.report.trajectory_file import netcdf_writer
from rr_opt.version import __version__

_OF_OPTIMUM = (
    ("speed", "m/s", "mean speed along the path, positive along platform 1"),
    ("amplitude", "rad", "largest |phi - offset|"),
    ("period", "s", "period of the gait"),
    ("offset", "rad", "mean of phi"),
    ("ratio", "1", "J20/J10"),
    ("cycle_length", "m", "path per period"),
    ("turn", "rad", "heading gained per period"),
    ("radius", "m", "of the circle; empty if straight"),
    ("peak_angle", "rad", "largest |phi|"),
    ("peak_rate", "rad/s", "largest |dphi/dt|"),
    ("peak_torque", "N m", "largest |torque| of the servo"),
    ("least_s1", "m", "smallest S1 = c1 cos phi + c2"),
    ("energy_per_metre", "J/m", "positive work of the servo per metre of path, none given back"),
    ("net_energy_per_metre", "J/m", "net work of the servo per metre: what friction takes"),
    ("cost_of_transport", "1", "energy_per_metre over the weight"),
)
_LIMITS = (("angle", "rad"), ("rate", "rad/s"), ("torque", "N m"), ("singularity", "m"))
_BOUNDS = (("amplitude", "rad"), ("period", "s"), ("offset", "rad"), ("inertia_ratio", ""))


def study_table(result: StudyAnswer) -> Table:
    """Every column; a cell is None where the case has no such thing."""
    columns, cells = zip(*_columns(result), strict=True)
    return Table(columns, tuple(zip(*cells, strict=True)))


def _columns(result: StudyAnswer) -> Iterator[tuple[Column, list[Any]]]:
    """Each column, and its cells."""
    rows = result.rows
    inputs = [result.study.inputs(case) for case in range(len(rows))]

    def of_row(name: str, unit: str, meaning: str, cell: Callable[[Any], Any]) -> Any:
        return Column(name, unit, meaning=meaning), [cell(row) for row in rows]

    def of_optimum(name: str, unit: str, meaning: str, cell: Callable[[Any], Any]) -> Any:
        return of_row(name, unit, meaning, lambda row: row.optimum and cell(row.optimum))

    yield Column("case", "1", meaning="number of the case"), list(range(len(rows)))
    for axis in result.study.axes:
        for line in axis.lines:
            unit = "" if line.numbers is None else line.key.unit or "1"
            yield (
                Column(line.key.name, unit, meaning="varied"),
                [one[line.key.name] for one in inputs],
            )
    yield of_row("status", "", "how the case ended", lambda row: row.status.value)
    branch = "family of optima that it belongs to"
    yield Column("branch", "1", meaning=branch), list(result.branches)
    warm = "from cold initial guesses, or from neighbours' optima: warm"
    yield of_row("started", "", warm, lambda row: row.started)
    yield of_optimum("drives", "", "which way", lambda one: direction_text(one.speed))
    for name, unit, meaning in _OF_OPTIMUM:
        yield of_optimum(name, unit, meaning, attrgetter(name))
    active = "active limits and bounds"
    yield of_optimum("held_by", "", active, lambda one: "; ".join(one.held))
    for of, what, quantities in (
        ("prices", "limit", _LIMITS),
        ("bound_prices", "active bound", _BOUNDS),
    ):
        for name, unit in quantities:
            per = f"m/s per {unit}" if unit else "m/s"
            # What is not active costs nothing.
            yield of_optimum(
                f"price_{name}",
                per,
                f"speed gained per unit of the {what}",
                lambda one, of=of, name=name: getattr(one, of).get(name, 0.0),
            )
    for end, word in enumerate(("least", "most")):
        yield of_row(
            f"expected_{word}",
            "m/s",
            f"{word} |speed| that the neighbours let expect",
            lambda row, end=end: row.expected and row.expected[end],
        )
    yield of_row("seconds", "s", "of CPU spent on the case", lambda row: row.seconds)
    yield of_row("message", "", "the outcome in words", lambda row: row.message)


def write_netcdf(path: Path, result: StudyAnswer) -> Path:
    """Write every column over the axes of the study, with units and meanings."""
    xarray = netcdf_writer()
    study = result.study
    names = [axis.lines[0].key.name for axis in study.axes]
    inputs = {line.key.name for axis in study.axes for line in axis.lines}
    data = xarray.Dataset(attrs={"title": study.name, "source": f"rr-opt {__version__}"})
    for name, axis in zip(names, study.axes, strict=True):
        for line in axis.lines:
            steps = line.numbers or [str(value) for value in line.values]
            data = data.assign_coords({line.key.name: (name, np.array(steps))})
            data[line.key.name].attrs.update(units=line.key.unit or "1")
    for column, cells in _columns(result):
        if column.name not in inputs:
            data[column.name] = (names, _array(column, cells).reshape(study.shape))
            data[column.name].attrs.update(long_name=column.meaning)
            if column.unit:
                data[column.name].attrs.update(units=column.unit)
    with whole(path) as temporary:
        data.to_netcdf(temporary, engine="h5netcdf")
    return path


def _array(column: Column, cells: list[Any]) -> np.ndarray:
    if not column.unit:
        return np.array([cell or "" for cell in cells], object)
    return np.array([math.nan if cell is None else cell for cell in cells], float)
