"""A study in words for a terminal, and as study.json for scripts."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt import __version__
from rr_opt.report.quantities import number, speed_text, with_unit
from rr_opt.report.study.result import Studied, front
from rr_opt.report.study.table import columns_of
from rr_opt.report.text import columns


def summary(result: Studied, files: list[Path]) -> str:
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


def _outcomes(result: Studied) -> str:
    words = {"optimal": "optimal", "infeasible": "infeasible", "not_converged": "not converged"}
    return ", ".join(f"{n} {words[status.value]}" for status, n in result.counts.items() if n)


def _gait_text(optimum: Any) -> str:
    return f"{with_unit(optimum.amplitude, 'rad')}, {with_unit(optimum.period, 's')}"


def record(result: Studied) -> dict[str, Any]:
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
