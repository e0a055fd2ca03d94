"""A study in words, as a page and as a folder."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.answers.quantities import QUANTITIES, direction_text, number, speed_text, with_unit
from rr_opt.answers.study import StudyAnswer, front
from rr_opt.outcome import Status
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.html import Badge, Cell, card, document, figure, table
from rr_opt.report.study.table import columns_of, csv_text, write_netcdf
from rr_opt.report.text import columns
from rr_opt.version import __version__


def summary(result: StudyAnswer, files: list[Path]) -> str:
    """The study as text for a terminal."""
    study, rows = result.study, result.rows
    head = f"{study.name}: {result.message}"
    told: list[tuple[str, ...]] = [
        ("cases", " x ".join(map(str, study.shape)) + f" = {len(rows)}", _outcomes(result)),
        ("branches", str(len({one for one in result.branches if one}))),
        ("started", ", ".join(f"{n} {how}" for how, n in Counter(r.started for r in rows).items())),
    ]
    best = result.fastest
    optimum = rows[best].optimum if best is not None else None
    if optimum:
        told += [
            ("fastest", speed_text(optimum.speed), result.inputs_text(best or 0)),
            ("", _gait_text(optimum), f"held by {', '.join(optimum.held) or 'nothing'}"),
        ]
        least = int(np.nanargmin(result.values("cost_of_transport")))
        cheap = rows[least].optimum
        if cheap:
            text = f"{number(cheap.energy_per_metre)} J/m, {1e3 * abs(cheap.speed):.1f} mm/s"
            told.append(("thriftiest", text, result.inputs_text(least)))
    told += [("files" if not i else "", str(file)) for i, file in enumerate(files)]
    return "\n".join([head, "", *columns(told)]) + "\n"


def _outcomes(result: StudyAnswer) -> str:
    words = {"optimal": "optimal", "infeasible": "infeasible", "not_converged": "not converged"}
    return ", ".join(f"{n} {words[status.value]}" for status, n in result.counts.items() if n)


def _gait_text(optimum: Any) -> str:
    return f"{with_unit(optimum.amplitude, 'rad')}, {with_unit(optimum.period, 's')}"


def record(result: StudyAnswer) -> dict[str, Any]:
    """The content of study.json, SI: the table's columns row by row, and the gaits."""
    table = columns_of(result)
    study, speed = result.study, result.speed
    cases = []
    for number_, row in enumerate(result.rows):
        one: dict[str, Any] = {column.name: column.cells[number_] for column in table}
        one["gait"] = dict(row.optimum.gait) if row.optimum else None
        one["continued_from"] = list(row.continued)
        cases.append({key: _finite(value) for key, value in one.items()})
    return {
        "status": "studied",
        "message": result.message,
        "study": study.name,
        "counts": {status.value: count for status, count in result.counts.items()},
        "varied": [[line.key.name for line in axis.lines] for axis in study.axes],
        "shape": list(study.shape),
        "pareto": {
            name: front(result.values(name), speed) for name in ("peak_torque", "energy_per_metre")
        },
        "cases": cases,
        "units": {column.name: column.unit for column in table if column.unit},
        "version": __version__,
        "input_sha256": study.sha256,
    }


def _finite(value: Any) -> Any:
    """An endless limit is null in JSON."""
    return None if isinstance(value, float) and not np.isfinite(value) else value


_CAPTIONS = {
    "speed": (
        "Speed over what was varied",
        "A line for each combination of the other inputs. Triangles point up for forward and down "
        "for backward. Dotted: the optimum jumps to another branch.",
    ),
    "map": (
        "Speed over two inputs",
        "A cell a case; thick lines part branches, the star is the fastest. Hatched: no optimum. "
        "If more than two keys were varied, a cell shows the fastest of its cases.",
    ),
    "held": (
        "What holds the optimum where",
        "The limits and bounds that the best gait stands on. Hatched on a map: no optimum.",
    ),
    "pareto": (
        "What speed costs",
        "Each dot is a case. No case is both faster and cheaper than one on the front. Energy is "
        "the servo's positive work per metre of path; what it brakes is not given back.",
    ),
}
_MOST_ROWS = 300


def page(result: StudyAnswer, figures: Mapping[str, str]) -> str:
    """The whole page; figures are SVG texts by name."""
    body = [
        _header(result),
        _tiles(result),
        _gallery(figures),
        card("Fast for what they cost", _front_table(result)),
        card("Cases without an optimum", _failures(result)),
        card("All cases" if len(result.rows) <= _MOST_ROWS else f"The first {_MOST_ROWS} cases",
             _cases_table(result, range(min(len(result.rows), _MOST_ROWS)))),
        "<footer>Each optimum was held against its limits and a fine simulation; a sweep for one "
        "of them is `rr-opt maximize-speed`. "
        f"rr-opt {escape(__version__)} · input SHA-256 "
        f"<code>{escape(result.study.sha256)}</code></footer>",
    ]  # fmt: skip
    return document(f"{result.study.name}: {_verdict(result)}", body)


def _verdict(result: StudyAnswer) -> str:
    speed = 1e3 * result.speed
    if result.fastest is None:
        return f"None of {len(result.rows)} cases has an optimum"
    return f"{len(result.rows)} cases, from {np.nanmin(speed):.1f} to {np.nanmax(speed):.1f} mm/s"


def _header(result: StudyAnswer) -> str:
    good = result.fastest is not None
    lead = " ".join([result.message, *result.warnings])
    return (
        f'<header class="{"" if good else "bad"}"><p class="kind">Roller Racer · '
        f"{escape(result.study.name)} · study</p><h1>{escape(_verdict(result))}</h1>"
        f'<p class="lead">{escape(lead)}</p></header>'
    )


def _tiles(result: StudyAnswer) -> str:
    counts = result.counts
    cold = sum(row.started != "warm" for row in result.rows)
    least = result.values("cost_of_transport")
    tiles = [
        (str(counts[Status.OPTIMAL]), f"of {len(result.rows)} cases have an optimum"),
        (str(counts[Status.INFEASIBLE]), "have no feasible gait"),
        (str(counts[Status.NOT_CONVERGED]), "did not converge"),
        (str(len({one for one in result.branches if one})), "branches of optima"),
        (str(cold), "cases checked from cold starts"),
        ("–" if np.isnan(least).all() else number(float(np.nanmin(least)), 3),
         "least cost of transport"),
    ]  # fmt: skip
    inner = "".join(
        f'<div class="tile"><b>{escape(value)}</b><span>{escape(words)}</span></div>'
        for value, words in tiles
    )
    return f'<div class="tiles">{inner}</div>'


def _gallery(figures: Mapping[str, str]) -> str:
    """Two columns of figures, one below the other where the screen is narrow."""
    columns = [
        "".join(figure(figures[name], *_CAPTIONS[name]) for name in names if name in figures)
        for names in (("speed", "held"), ("map", "pareto"))
    ]
    inner = "".join(f"<div>{column}</div>" for column in columns if column)
    return f'<div class="grid">{inner}</div>' if inner else ""


def _front_table(result: StudyAnswer) -> str:
    """The cases that are on a front, the fastest first."""
    fronts = {name: front(result.values(name), result.speed)
              for name in ("peak_torque", "energy_per_metre")}  # fmt: skip
    cases = sorted({case for found in fronts.values() for case in found},
                   key=lambda case: -result.speed[case])  # fmt: skip
    return _cases_table(result, cases[:20])


def _failures(result: StudyAnswer) -> str:
    rows: list[list[Cell]] = [
        [result.inputs_text(case), Badge(row.status.value.replace("_", " "), "no"), row.message]
        for case, row in enumerate(result.rows)
        if row.optimum is None
    ]
    return table(["Case", "Status", "Why"], rows[:_MOST_ROWS]) if rows else ""


def _cases_table(result: StudyAnswer, cases: Iterable[int]) -> str:
    head = ["Case", "Speed", "Amplitude", "Period", "Torque", "Energy", "Held by", "Branch"]
    rows: list[list[Cell]] = []
    for case in cases:
        row = result.rows[case]
        one = row.optimum
        if one is None:
            told: list[Cell] = ["–"] * 5
            rows.append([result.inputs_text(case), *told, row.status.value.replace("_", " "), "–"])
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


TABLE, NETCDF, RECORD, PAGE = "study.csv", "study.nc", "study.json", "report.html"
FIGURES = ("speed", "map", "held", "pareto")


def check_wishes(*, netcdf: bool) -> None:
    """Raise InputError, before anything is computed, for a file that cannot be made here."""
    if netcdf:
        from rr_opt.report.trajectory_file import netcdf_writer

        netcdf_writer()


def write_study(result: StudyAnswer, folder: Path, *, netcdf: bool, figures: bool) -> list[Path]:
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
    from rr_opt.report.figures.active_limits import draw

    drawn = draw(result)
    for name, svg in drawn.items():
        written.append(write_text(folder / f"{name}.svg", svg))
    return [write_text(folder / PAGE, page(result, drawn)), *written]
