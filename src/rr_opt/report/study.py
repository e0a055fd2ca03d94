"""A study as a document, a record, a table (a row a case; netCDF over the axes) and a folder."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.answers.quantities import QUANTITIES, direction_text, number, speed_text, with_unit
from rr_opt.answers.study import StudyAnswer, front
from rr_opt.outcome import Status
from rr_opt.report.archive import remove, whole, write_json, write_text
from rr_opt.report.document import (
    Badge,
    Cell,
    Column,
    Document,
    Fact,
    Facts,
    Figure,
    Gallery,
    Section,
    Table,
    table,
)
from rr_opt.report.text import terminal
from rr_opt.report.trajectory_file import netcdf_writer
from rr_opt.report.webpage import PAGE, write_page
from rr_opt.version import __version__

_MOST_ROWS = 300
_COSTS = ("peak_torque", "energy_per_metre")


def study_document(result: StudyAnswer, figures: tuple[Figure, ...] = ()) -> Document:
    """The report of a study."""
    speed, cases = 1e3 * result.speed, len(result.rows)
    good = result.fastest is not None
    title = f"None of {cases} cases has an optimum"
    if good:
        title = f"{cases} cases, from {np.nanmin(speed):.1f} to {np.nanmax(speed):.1f} mm/s"
    shown = min(cases, _MOST_ROWS)
    return Document(
        name=result.study.name,
        kind="study",
        title=title,
        lead=" ".join([result.message, *result.warnings]),
        good=good,
        sections=(
            Section("", (Facts(_key_facts(result), key=True),), brief=False),
            Section("", (Facts(_facts(result)),)),
            Section("", (Gallery(figures),), brief=False),
            Section("Fast for what they cost", (_front_table(result),), brief=False),
            Section("Cases without an optimum", (_failures(result),), brief=False),
            Section(
                "All cases" if shown == cases else f"The first {shown} cases",
                (_cases_table(result, range(shown)),),
                brief=False,
            ),
        ),
        footer=(
            "Each optimum was checked against its limits and a fine simulation; `rr-opt "
            "maximize-speed` checks a case against a sweep too.",
            f"rr-opt {__version__}",
            f"input SHA-256 `{result.study.sha256}`",
        ),
    )


def summary(result: StudyAnswer, files: list[Path]) -> str:
    """The study as text for a terminal."""
    return terminal(study_document(result), files)


def _facts(result: StudyAnswer) -> tuple[Fact, ...]:
    study, rows = result.study, result.rows
    shape = " x ".join(map(str, study.shape))
    started = Counter(row.started for row in rows)
    facts = [
        Fact("cases", f"{shape} = {len(rows)}", _outcomes(result)),
        Fact("branches", str(len({one for one in result.branches if one}))),
        Fact("solved from", ", ".join(f"{n} {how}" for how, n in started.items())),
    ]
    best = result.fastest
    optimum = rows[best].optimum if best is not None else None
    if best is not None and optimum:
        gait = f"{with_unit(optimum.amplitude, 'rad')}, {with_unit(optimum.period, 's')}"
        facts += [
            Fact("fastest", speed_text(optimum.speed), result.inputs_text(best)),
            Fact("", gait, f"limited by {', '.join(optimum.held) or 'nothing'}"),
        ]
        least = int(np.nanargmin(result.values("cost_of_transport")))
        cheap = rows[least].optimum
        if cheap:
            text = f"{number(cheap.energy_per_metre)} J/m, {1e3 * abs(cheap.speed):.1f} mm/s"
            facts.append(Fact("least energy", text, result.inputs_text(least)))
    return tuple(facts)


def _outcomes(result: StudyAnswer) -> str:
    counts = result.counts.items()
    return ", ".join(f"{n} {status.value.replace('_', ' ')}" for status, n in counts if n)


def record(result: StudyAnswer) -> dict[str, Any]:
    """The content of study.json, SI: the table's columns row by row, and the gaits."""
    cases = study_table(result)
    study, speed = result.study, result.speed
    return {
        "status": "studied",
        "message": result.message,
        "study": study.name,
        "counts": {status.value: count for status, count in result.counts.items()},
        "varied": [[line.key.name for line in axis.lines] for axis in study.axes],
        "shape": list(study.shape),
        "pareto": {name: front(result.values(name), speed) for name in _COSTS},
        "cases": [
            {
                **record,
                "gait": dict(row.optimum.gait) if row.optimum else None,
                "continued_from": list(row.continued),
            }
            for record, row in zip(cases.records, result.rows, strict=True)
        ],
        "units": {column.name: column.unit for column in cases.columns if column.unit},
        "version": __version__,
        "input_sha256": study.sha256,
    }


_FIGURES = {
    "speed": (
        "Speed over what was varied",
        "Best speed of each case over the first input, a line for each value of the others",
        "A line for each combination of the other inputs. Triangles point up for forward and down "
        "for backward. Dotted: the optimum jumps to another branch.",
    ),
    "held": (
        "Active limits and bounds",
        "Which limits and bounds are active in each case",
        "The limits and bounds that limit the best gait. Hatched on a map: no optimum.",
    ),
    "map": (
        "Speed over two inputs",
        "Map of the best speed over two of the inputs",
        "A cell a case; thick lines part branches, the star is the fastest. Hatched: no optimum. "
        "If more than two keys were varied, a cell shows the fastest of its cases.",
    ),
    "pareto": (
        "What speed costs",
        "Speed of every case against peak torque and against energy per metre, with the fronts",
        "Each dot is a case. No case is both faster and cheaper than one on the front. Energy is "
        "the servo's positive work per metre of path; what it brakes is not given back.",
    ),
}


def _key_facts(result: StudyAnswer) -> tuple[Fact, ...]:
    counts, least = result.counts, result.values("cost_of_transport")
    cold = sum(row.started != "warm" for row in result.rows)
    cost = "–" if np.isnan(least).all() else number(float(np.nanmin(least)), 3)
    return (
        Fact(f"of {len(result.rows)} cases have an optimum", str(counts[Status.OPTIMAL])),
        Fact("have no feasible gait", str(counts[Status.INFEASIBLE])),
        Fact("did not converge", str(counts[Status.NOT_CONVERGED])),
        Fact("branches of optima", str(len({one for one in result.branches if one}))),
        Fact("cases checked from cold starts", str(cold)),
        Fact("least cost of transport", cost),
    )


def _front_table(result: StudyAnswer) -> Table:
    """The cases that are on a front, the fastest first."""
    fronts = [front(result.values(name), result.speed) for name in _COSTS]
    cases = sorted({case for found in fronts for case in found}, key=lambda k: -result.speed[k])
    return _cases_table(result, cases[:20])


def _failures(result: StudyAnswer) -> Table:
    rows: list[list[Cell]] = [
        [result.inputs_text(case), Badge(row.status.value.replace("_", " ")), row.message]
        for case, row in enumerate(result.rows)
        if row.optimum is None
    ]
    return table(["Case", "Status", "Why"], rows[:_MOST_ROWS])


def _cases_table(result: StudyAnswer, cases: Iterable[int]) -> Table:
    head = ["Case", "Speed", "Amplitude", "Period", "Torque", "Energy", "Limited by", "Branch"]
    rows: list[list[Cell]] = []
    for case in cases:
        row = result.rows[case]
        one = row.optimum
        if one is None:
            status = row.status.value.replace("_", " ")
            rows.append([result.inputs_text(case), *[None] * 5, status, None])
            continue
        rows.append(
            [
                result.inputs_text(case),
                f"{1e3 * abs(one.speed):.1f} mm/s {direction_text(one.speed)}",
                with_unit(one.amplitude, QUANTITIES["amplitude"].unit, 3),
                with_unit(one.period, "s", 3),
                with_unit(one.peak_torque, "N m", 3),
                with_unit(one.energy_per_metre, "J/m", 3),
                ", ".join(one.held) or "nothing",
                str(result.branches[case]),
            ]
        )
    return table(head, rows)


TABLE, NETCDF, RECORD = "study.csv", "study.nc", "study.json"


def check_wishes(*, netcdf: bool) -> None:
    """Raise InputError, before anything is computed, for a file that cannot be made here."""
    if netcdf:
        netcdf_writer()


def write_study(result: StudyAnswer, folder: Path, *, netcdf: bool, figures: bool) -> list[Path]:
    """Write everything; returns the files. What an earlier run left is removed before."""
    remove(folder, (TABLE, NETCDF, RECORD, PAGE, *(f"{name}.svg" for name in _FIGURES)))
    written = [
        write_text(folder / TABLE, study_table(result).csv()),
        write_json(folder / RECORD, record(result)),
    ]
    if netcdf:
        written.append(write_netcdf(folder / NETCDF, result))
    if not figures:
        return written
    # Here and not above: without figures matplotlib need not be loaded.
    from rr_opt.report.figures.active_limits import draw

    drawn: Mapping[str, str] = draw(result)
    shown = tuple(
        Figure(name, title, drawn[name], alt, caption)
        for name, (title, alt, caption) in _FIGURES.items()
        if name in drawn
    )
    return write_page(folder, study_document(result, shown), written)


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
