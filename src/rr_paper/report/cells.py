"""Tables of the audit as text, and the numbers behind the figures as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence

import numpy as np

from rr_opt.answers.quantities import number
from rr_paper.report.audit import Section, Value
from rr_paper.reproduction import Reproduction
from rr_paper.surfaces import RATE_LIMIT, SpeedSurface

_ROUNDING = 1e-10


def shown(value: Value) -> str:
    """A cell for people."""
    if value is None:
        return "–"
    if isinstance(value, str):
        return value
    return f"{value:.0e}" if 0 < abs(value) < _ROUNDING else number(value, 4)


def csv_text(head: Sequence[str], rows: Iterable[Sequence[Value]]) -> str:
    """A table as CSV, numbers with nine digits; empty where there is none."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(
        ["" if cell is None else cell if isinstance(cell, str) else f"{cell:.9g}" for cell in row]
        for row in rows
    )
    return text.getvalue()


def markdown(sections: Iterable[Section], lead: str) -> str:
    """The audit as a Markdown page."""
    parts = ["# The paper, audited", lead]
    for section in sections:
        parts += [f"## {section.title}", f"**{section.finding}**", *section.sentences]
        parts.append(
            "\n".join(
                f"| {' | '.join(cells)} |"
                for cells in (
                    section.head,
                    ["---"] * len(section.head),
                    *([shown(cell) for cell in row] for row in section.rows),
                )
            )
        )
    return "\n\n".join(parts) + "\n"


_THINNED = (5, 10, 5)
"""Of the surfaces every so many amplitudes, ratios and periods are written: 0.05 rad, 0.01 and
0.05 s, the steps of the paper or finer."""


def curves(found: Reproduction) -> dict[str, str]:
    """CSV texts by file name; SI units."""
    amplitude, ratio, period = _THINNED
    start, drive = found.start, found.signs.driven
    average = dict(zip(np.round(start.t, 9), start.speed, strict=True))
    driven = start.driven
    return {
        "figure3.csv": csv_text(
            ("t", "x", "y", "psi", "phi", "average_speed"),
            [
                (*row, average.get(round(row[0], 9)))
                for row in _columns(driven.t, driven.x, driven.y, driven.psi, driven.phi)
            ],
        ),
        "figure4.csv": _surface(found.ratio_surface, amplitude, ratio),
        "figure5.csv": _surface(found.period_surface, amplitude, period),
        "figure6.csv": csv_text(
            ("offset", "t", "x", "y"),
            [
                (one.gait.offset, *row)
                for one in found.turning.circles
                for row in _columns(one.driven.t, one.driven.x, one.driven.y)[::5]
            ],
        ),
        "signs.csv": csv_text(
            ("t", *(f"v {name}" for name in drive.v)), _columns(drive.t, *drive.v.values())
        ),
    }


def _surface(found: SpeedSurface, every_amplitude: int, every: int) -> str:
    rows: list[tuple[Value, ...]] = [
        (
            float(found.amplitude[i]),
            float(found.ratio[j]),
            float(found.period[j]),
            float(found.speed[i, j]),
            float(found.rate[i, j]),
            str(int(found.rate[i, j] <= RATE_LIMIT)),
        )
        for j in range(0, len(found.ratio), every)
        for i in range(0, len(found.amplitude), every_amplitude)
    ]
    head = ("amplitude", "ratio", "period", "speed", "peak_rate", "keeps_30_rpm")
    return csv_text(head, rows)


def _columns(*arrays: np.ndarray) -> list[tuple[float, ...]]:
    return [tuple(row) for row in np.column_stack(arrays).tolist()]
