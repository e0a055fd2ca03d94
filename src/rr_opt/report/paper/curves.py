"""The numbers behind the figures, as CSV."""

from __future__ import annotations

import numpy as np

from rr_opt.paper.reproduction import Reproduction
from rr_opt.paper.surfaces import RATE_LIMIT, SpeedSurface
from rr_opt.report.paper.audit.section import Value
from rr_opt.report.paper.cells import csv_text

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
