"""The table of a study: one row a case, its inputs first; as CSV, and as netCDF over the axes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.answers.quantities import direction_text
from rr_opt.answers.study import StudyAnswer
from rr_opt.report import document
from rr_opt.report.archive import whole
from rr_opt.report.trajectory_file import netcdf_writer
from rr_opt.version import __version__


@dataclass(frozen=True)
class Column:
    """A column: its name, SI unit ("1": a plain number, "": a text), meaning, and its cells.

    A cell is None where the case has no such thing.
    """

    name: str
    unit: str
    meaning: str
    cells: tuple[Any, ...]


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


def columns_of(result: StudyAnswer) -> list[Column]:
    """Every column of the table, in order."""
    cases = range(len(result.rows))
    rows = result.rows
    return [
        Column("case", "1", "number of the case", tuple(cases)),
        *_inputs(result),
        Column("status", "", "how the case ended", tuple(row.status.value for row in rows)),
        Column("branch", "1", "family of optima that it belongs to", result.branches),
        Column("started", "", "from cold starts, or from neighbours' optima: warm",
               tuple(row.started for row in rows)),
        *_optimum(result),
        *(Column(f"expected_{word}", "m/s", f"{word} |speed| that the neighbours let expect",
                 tuple(row.expected and row.expected[end] for row in rows))
          for end, word in enumerate(("least", "most"))),
        Column("seconds", "s", "of CPU spent on the case", tuple(row.seconds for row in rows)),
        Column("message", "", "the outcome in words", tuple(row.message for row in rows)),
    ]  # fmt: skip


def _inputs(result: StudyAnswer) -> list[Column]:
    inputs = [result.study.inputs(case) for case in range(len(result.rows))]
    return [
        Column(
            line.key.name,
            "" if line.numbers is None else line.key.unit or "1",
            "varied",
            tuple(of[line.key.name] for of in inputs),
        )
        for axis in result.study.axes
        for line in axis.lines
    ]


def _optimum(result: StudyAnswer) -> list[Column]:
    found = [row.optimum for row in result.rows]

    def column(name: str, unit: str, meaning: str, cell: Any) -> Column:
        return Column(name, unit, meaning, tuple(one and cell(one) for one in found))

    def price(of: str, name: str) -> Any:
        # What does not hold the optimum costs nothing.
        return lambda one: getattr(one, of).get(name, 0.0)

    def per(unit: str) -> str:
        return f"m/s per {unit}" if unit else "m/s"

    return [
        column("drives", "", "which way", lambda one: direction_text(one.speed)),
        *(column(name, unit, meaning, lambda one, n=name: getattr(one, n))
          for name, unit, meaning in _OF_OPTIMUM),
        column("held_by", "", "active limits and bounds", lambda one: "; ".join(one.held)),
        *(column(f"price_{name}", per(unit), "speed gained per unit of the limit",
                 price("prices", name)) for name, unit in _LIMITS),
        *(column(f"price_{name}", per(unit), "speed gained per unit of the active bound",
                 price("bound_prices", name)) for name, unit in _BOUNDS),
    ]  # fmt: skip


def csv_text(columns: list[Column]) -> str:
    """The table as CSV: numbers with all digits, nothing where there is none."""
    rows = zip(*(column.cells for column in columns), strict=True)
    return document.csv_text([column.name for column in columns], rows, digits=12)


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
    for column in columns_of(result):
        if column.name not in inputs:
            data[column.name] = (names, _array(column).reshape(study.shape))
            data[column.name].attrs.update(long_name=column.meaning)
            if column.unit:
                data[column.name].attrs.update(units=column.unit)
    with whole(path) as temporary:
        data.to_netcdf(temporary, engine="h5netcdf")
    return path


def _array(column: Column) -> np.ndarray:
    if not column.unit:
        return np.array([cell or "" for cell in column.cells], object)
    return np.array([math.nan if cell is None else cell for cell in column.cells], float)
