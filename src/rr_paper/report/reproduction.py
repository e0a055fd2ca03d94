"""The reproduction as a page, a Markdown audit, a record, text for a terminal, and CSV files."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.answers.quantities import number
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.html import Badge, Cell, card, document, figure, table
from rr_opt.report.text import columns as in_columns
from rr_opt.version import __version__
from rr_paper.publication import CITATION, RATE_LIMIT
from rr_paper.report.audit import Section, Value
from rr_paper.report.audit_gaits import sections
from rr_paper.report.csv_text import csv_text
from rr_paper.reproduction import Reproduction
from rr_paper.surfaces import SpeedSurface

FIGURES = ("figure3", "figure4", "figure5", "figure6", "signs", "readings", "period")
PAGE, AUDIT, RECORD = "report.html", "audit.md", "reproduce.json"

_TINY = 1e-10
"""Below this a cell shows the order of magnitude alone: it is rounding."""


def lead(found: Reproduction) -> str:
    """What was done, in a sentence or two."""
    rows = found.tables.rows
    return (
        "The tables and figures recomputed for the shipped prototype, and what was found on the "
        f"way. For {sum(one.within_mean for one in rows)} of {len(rows)} measured averages the "
        "model's speed is within their interval; Table 2's amplitude and the friction were fitted "
        "to them."
    )


def record(found: Reproduction, sha256: str) -> dict[str, Any]:
    """The content of reproduce.json: the tables of all sections, in the units of their heads."""

    def finite(value: Value) -> Value:
        return None if isinstance(value, float) and math.isinf(value) else value

    return {
        "status": "reproduced",
        "message": lead(found),
        "paper": CITATION,
        "mujoco_speed": found.mujoco,
        "sections": {
            one.key: {
                "title": one.title,
                "finding": one.finding,
                "sentences": list(one.sentences),
                "rows": [dict(zip(one.head, map(finite, row), strict=True)) for row in one.rows],
            }
            for one in sections(found)
        },
        "version": __version__,
        "input_sha256": sha256,
    }


def summary(found: Reproduction, files: Sequence[Path]) -> str:
    """The findings as text for a terminal."""
    lines = ["The paper, reproduced and audited.", ""]
    for one in sections(found):
        lines += [one.title, f"  {one.finding}"]
    paths = [("files" if not i else "", str(file)) for i, file in enumerate(files)]
    return "\n".join([*lines, "", *in_columns(paths)]) + "\n"


def markdown(found: Reproduction) -> str:
    """The audit as a Markdown page."""
    parts = ["# The paper, audited", lead(found)]
    for one in sections(found):
        rows = [one.head, ["---"] * len(one.head), *(map(_cell, row) for row in one.rows)]
        lines = "\n".join(f"| {' | '.join(cells)} |" for cells in rows)
        parts += [f"## {one.title}", f"**{one.finding}**", *one.sentences, lines]
    return "\n\n".join(parts) + "\n"


def _cell(value: Value) -> str:
    if value is None:
        return "–"
    if isinstance(value, str):
        return value
    return f"{value:.0e}" if 0 < abs(value) < _TINY else number(value, 4)


def curves(found: Reproduction) -> dict[str, str]:
    """CSV texts by file name; SI units."""
    start, driven, motion = found.start, found.start.driven, found.signs.comparison
    average = dict(zip(np.round(start.t, 9), start.speed, strict=True))
    run = _rows(driven.t, driven.x, driven.y, driven.psi, driven.phi)
    # The surfaces are thinned to the paper's steps or finer: 0.05 rad, 0.01 and 0.05 s.
    return {
        "figure3.csv": csv_text(
            ("t", "x", "y", "psi", "phi", "average_speed"),
            [(*row, average.get(round(row[0], 9))) for row in run],
        ),
        "figure4.csv": _surface(found.ratio_surface, 10),
        "figure5.csv": _surface(found.period_surface, 5),
        "figure6.csv": csv_text(
            ("offset", "t", "x", "y"),
            [
                (one.gait.offset, *row)
                for one in found.turning.circles
                for row in _rows(one.driven.t, one.driven.x, one.driven.y)[::5]
            ],
        ),
        "signs.csv": csv_text(
            ("t", *(f"v {name}" for name in motion.v)), _rows(motion.t, *motion.v.values())
        ),
    }


def _surface(surface: SpeedSurface, every: int) -> str:
    """Every fifth amplitude, and every so many ratios or periods."""
    rows: list[tuple[Value, ...]] = [
        (
            *map(float, (surface.amplitude[i], surface.ratio[j], surface.period[j])),
            *map(float, (surface.speed[i, j], surface.rate[i, j])),
            str(int(surface.rate[i, j] <= RATE_LIMIT)),
        )
        for j in range(0, len(surface.ratio), every)
        for i in range(0, len(surface.amplitude), 5)
    ]
    head = ("amplitude", "ratio", "period", "speed", "peak_rate", "keeps_30_rpm")
    return csv_text(head, rows)


def _rows(*arrays: np.ndarray) -> list[tuple[float, ...]]:
    return [tuple(row) for row in np.column_stack(arrays).tolist()]


_CAPTIONS = {
    "figure3": (
        "Beside Fig. 3: a start from rest",
        "The paper does not say which gait it shows; here it is a row of Table 3. The average is "
        "the displacement of P over a sliding period, as in the paper.",
    ),
    "figure4": (
        "Beside Fig. 4: J20/J10 and amplitude",
        "Left: means of Table 2 (mm/s, 95 % intervals) in the colour of their speed, at the "
        "amplitude that fits best. Right: the same rows over the amplitude that the paper leaves "
        "out.",
    ),
    "figure5": (
        "Beside Fig. 5: period and amplitude",
        "Left: means of Table 3 (mm/s, 95 % intervals) in the colour of their speed; where a dot "
        "is paler than its surroundings, the model is too fast. Right: cuts at the two periods.",
    ),
    "figure6": (
        "Beside Fig. 6: three offsets",
        "One lap, from rest at the dot. The paper prints no radius to compare these with.",
    ),
    "signs": (
        "The signs of equation (3)",
        "Two derivations and the corrected equation coincide; the printed one does not.",
    ),
    "readings": (
        "What the nine averages say about readings",
        "p by Student's t of three runs. No definition of J20/J10 stands out.",
    ),
    "period": (
        "The effect of the period",
        "With viscous friction every robot is near 4. The intervals allow it; v_exp does not.",
    ),
}


def page(found: Reproduction, sha256: str, figures: Mapping[str, str]) -> str:
    """The whole page; figures are SVG texts by name."""

    def drawn(*names: str) -> str:
        return "".join(figure(figures[name], *_CAPTIONS[name]) for name in names)

    audit = {one.key: one for one in sections(found)}
    columns = audit.pop("columns")
    grid = "".join(f"<div>{drawn(*names)}</div>" for names in (("figure3", "signs"),
                                                               ("figure6", "period")))  # fmt: skip
    body = [
        '<header><p class="kind">Roller Racer · the paper, reproduced</p>'
        "<h1>The paper&#39;s tables and figures recomputed, and what does not hold</h1>"
        f'<p class="lead">{escape(lead(found))}</p></header>',
        card("Tables 2 and 3, printed and computed", _tables(found) + _sentences(columns)),
        drawn("figure4", "figure5"),
        f'<div class="grid">{grid}</div>',
        drawn("readings"),
        *(
            card(one.title, _sentences(one) + table(one.head, [[*map(_cell, r)] for r in one.rows]))
            for one in audit.values()
        ),
        f"<footer>{escape(CITATION)} · rr-opt {escape(__version__)} · input SHA-256 "
        f"<code>{escape(sha256)}</code></footer>",
    ]
    return document("The paper, reproduced", body)


def _tables(found: Reproduction) -> str:
    """Tables 2 and 3 beside the model."""
    head = ["Table", "J20/J10", "T, s", "α, rad", "Printed mean, mm/s", "Printed v_exp, mm/s",
            "Model, mm/s", "Within the interval"]  # fmt: skip
    rows: list[list[Cell]] = []
    for one in found.tables.rows:
        row, fitted = one.row, one.row.amplitude is None
        rows.append(
            [
                "2" if fitted else "3",
                number(row.ratio),
                number(row.period),
                number(one.amplitude, 3) + (" (fitted)" if fitted else ""),
                f"{1e3 * row.mean:.1f} ± {1e3 * row.half_width:.0f}",
                f"{1e3 * row.other:.1f}",
                f"{1e3 * one.speed:.1f}",
                Badge("yes", "yes") if one.within_mean else Badge("no", "no"),
            ]
        )
    return table(head, rows)


def _sentences(section: Section) -> str:
    rest = "".join(f"<p>{escape(one)}</p>" for one in section.sentences)
    return f"<p><b>{escape(section.finding)}</b></p>{rest}"


def write_reproduction(
    found: Reproduction, sha256: str, folder: Path, *, figures: bool
) -> list[Path]:
    """Write everything, after removing the files of an earlier run; returns the files.

    The table of each section goes to a CSV file; that of the columns holds Tables 2 and 3.
    """
    texts = {
        "tables.csv" if one.key == "columns" else f"audit-{one.key}.csv": csv_text(
            one.head, one.rows
        )
        for one in sections(found)
    } | curves(found)
    remove(folder, (PAGE, AUDIT, RECORD, *texts, *(f"{name}.svg" for name in FIGURES)))
    written = [
        write_text(folder / AUDIT, markdown(found)),
        write_json(folder / RECORD, record(found, sha256)),
        *(write_text(folder / name, text) for name, text in texts.items()),
    ]
    if not figures:
        return written
    # Here and not above, so that matplotlib is not loaded without figures.
    from rr_paper.report.figures import draw

    drawn = draw(found)
    written += [write_text(folder / f"{name}.svg", drawn[name]) for name in FIGURES]
    return [write_text(folder / PAGE, page(found, sha256, drawn)), *written]
