"""A study as a document, as a record and as a folder."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.answers.quantities import QUANTITIES, direction_text, number, speed_text, with_unit
from rr_opt.answers.study import StudyAnswer, front
from rr_opt.outcome import Status
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.document import (
    Badge,
    Cell,
    Document,
    Fact,
    Facts,
    Figure,
    Gallery,
    Section,
    Table,
    table,
)
from rr_opt.report.study_table import study_table, write_netcdf
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
