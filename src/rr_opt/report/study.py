"""The report of a study."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.documents import document as doc
from rr_opt.documents.report import Report
from rr_opt.documents.texts import captions
from rr_opt.formatting import direction_text, number, speed_text, with_unit
from rr_opt.outcome import Status
from rr_opt.report.study_table import study_columns, study_csv, write_netcdf
from rr_opt.report.trajectory_file import netcdf_writer
from rr_opt.results.inputs import axis_words, held_words
from rr_opt.results.study import SolvedStudy

COSTS = ("peak_torque", "energy_per_metre")
_MOST_ROWS = 300


def study_record(result: SolvedStudy) -> dict[str, Any]:
    """The content of study.json, SI: the table's columns row by row, and the gaits."""
    columns = study_columns(result)
    cases = ({c.name: c.cells[k] for c in columns} for k in range(len(result.rows)))
    return {
        "status": "studied",
        "message": result.message,
        "study": result.study.name,
        "counts": {status.value: count for status, count in result.counts.items()},
        "varied": [[line.key.name for line in axis.lines] for axis in result.study.axes],
        "shape": result.study.shape,
        "pareto": {name: result.front(name) for name in COSTS},
        "cases": [
            {
                **record,
                "gait": dict(row.optimum.gait) if row.optimum else None,
                "continued_from": row.continued,
            }
            for record, row in zip(cases, result.rows, strict=True)
        ],
        "units": {column.name: column.unit for column in columns if column.unit},
    }


def study_document(result: SolvedStudy, figures: Sequence[doc.Figure] = ()) -> doc.Document:
    """What was found, in figures and tables."""
    speed, cases = 1e3 * result.speed, len(result.rows)
    good = result.fastest is not None
    title = f"None of {cases} cases has an optimum"
    if good:
        span = f"{np.nanmin(speed):.1f} to {np.nanmax(speed):.1f} mm/s"
        title = f"The best speed of {cases} cases ranges from {span}"
    shown = min(cases, _MOST_ROWS)
    return doc.Document(
        name=result.study.name,
        kind="study",
        title=title,
        lead=" ".join([result.message, *result.warnings]),
        good=good,
        sections=(
            doc.Section("", (doc.Facts(_key_facts(result), key=True),), brief=False),
            doc.Section("", (doc.Facts(tuple(_facts(result))),)),
            doc.gallery(figures),
            doc.Section("Fastest for their cost", (_front_table(result),), brief=False),
            doc.Section("Cases without an optimum", (_failures(result),), brief=False),
            doc.Section(
                "All cases" if shown == cases else f"The first {shown} cases",
                (_cases_table(result, range(shown)),),
                brief=False,
            ),
        ),
        footer=(
            "Each optimum was checked against its limits and a fine simulation; `rr-opt "
            "maximize-speed` also checks a case against a sweep.",
            *doc.versions(result.study.sha256),
        ),
    )


def _facts(result: SolvedStudy) -> Iterator[doc.Fact]:
    rows, shape = result.rows, result.study.shape
    product = f"{' x '.join(map(str, shape))} = " if len(shape) > 1 else ""
    ended = ", ".join(f"{count} {status.words}" for status, count in result.counts.items() if count)
    started = Counter(row.started for row in rows)
    yield doc.Fact("cases", f"{product}{len(rows)}", ended)
    yield doc.Fact("branches", str(len({one for one in result.branches if one})))
    yield doc.Fact("solved from", ", ".join(f"{n} {how}" for how, n in started.items()))
    best = result.fastest
    optimum = rows[best].optimum if best is not None else None
    if best is None or optimum is None:
        return
    gait = f"{with_unit(optimum.amplitude, 'rad')}, {with_unit(optimum.period, 's')}"
    yield doc.Fact("fastest", speed_text(optimum.speed), result.inputs_text(best))
    yield doc.Fact("", gait, f"limited by {', '.join(held_words(optimum.held))}")
    least = int(np.nanargmin(result.values("cost_of_transport")))
    cheap = rows[least].optimum
    if cheap:
        text = f"{number(cheap.energy_per_metre)} J/m, {1e3 * abs(cheap.speed):.1f} mm/s"
        yield doc.Fact("least energy", text, result.inputs_text(least))


def _key_facts(result: SolvedStudy) -> tuple[doc.Fact, ...]:
    counts, least = result.counts, result.values("cost_of_transport")
    cold = sum(row.started != "warm" for row in result.rows)
    cost = "–" if np.isnan(least).all() else number(float(np.nanmin(least)), 3)
    return (
        doc.Fact(f"of {len(result.rows)} cases have an optimum", str(counts[Status.OPTIMAL])),
        doc.Fact("have no feasible gait", str(counts[Status.INFEASIBLE])),
        doc.Fact("did not converge", str(counts[Status.NOT_CONVERGED])),
        doc.Fact("branches of optima", str(len({one for one in result.branches if one}))),
        doc.Fact("cases checked from cold starts", str(cold)),
        doc.Fact("least cost of transport", cost),
    )


def _front_table(result: SolvedStudy) -> doc.Table:
    """The cases that are on a front, the fastest first."""
    fronts = [result.front(name) for name in COSTS]
    cases = sorted({case for found in fronts for case in found}, key=lambda k: -result.speed[k])
    return _cases_table(result, cases[:20])


def _failures(result: SolvedStudy) -> doc.Table:
    rows = [
        [result.inputs_text(case), doc.Badge(row.status.words), row.message]
        for case, row in enumerate(result.rows)
        if row.optimum is None
    ]
    return doc.table(["Case", "Status", "Why"], rows[:_MOST_ROWS])


def _cases_table(result: SolvedStudy, cases: Iterable[int]) -> doc.Table:
    axes = list(map(axis_words, result.study.axes))
    head = [*axes, "Speed", "Amplitude", "Period", "Torque", "Energy", "Limited by", "Branch"]
    rows = []
    for case in cases:
        row, values = result.rows[case], result.value_texts(case)
        one = row.optimum
        if one is None:
            rows.append([*values, *[None] * 5, row.status.words, None])
            continue
        rows.append(
            [
                *values,
                f"{1e3 * abs(one.speed):.1f} mm/s {direction_text(one.speed)}",
                with_unit(one.amplitude, "rad", 3),
                with_unit(one.period, "s", 3),
                with_unit(one.peak_torque, "N m", 3),
                with_unit(one.energy_per_metre, "J/m", 3),
                ", ".join(held_words(one.held)),
                str(result.branches[case]),
            ]
        )
    return doc.table(head, rows)


def check_files(*, netcdf: bool) -> None:
    """Raise InputError, before anything is computed, for a file that cannot be made here."""
    if netcdf:
        netcdf_writer()


class _Report(Report):
    def save(
        self, result: SolvedStudy, path: str | Path, *, netcdf: bool = False, **options: Any
    ) -> list[Path]:
        """Write study.csv, study.json and, if asked for, study.nc, with figures and page."""
        check_files(netcdf=netcdf)
        written = super().save(result, path, **options)
        return [*written, write_netcdf(Path(path) / "study.nc", result)] if netcdf else written


REPORT = _Report(
    study_record,
    study_document,
    "study.json",
    tables=lambda result: {"study.csv": study_csv(result)},
    others=("study.csv", "study.nc"),
    figures="rr_opt.report.figures.study",
    captions=captions("study"),
)
