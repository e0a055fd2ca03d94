"""The reproduction as a document, and its curves as CSV."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from rr_opt.documents.document import Document, Figure, Gallery, Section, csv_text, versions
from rr_opt.documents.report import Report
from rr_paper.audit import findings
from rr_paper.publication import CITATION, RATE_LIMIT, captions
from rr_paper.reproduction import Reproduction
from rr_paper.tables import SpeedSurface


def document(found: Reproduction, figures: Sequence[Figure] = ()) -> Document:
    """The page, its Markdown and the text for a terminal."""
    rows, audit = found.tables.rows, findings(found)
    drawn = {figure.name: figure for figure in figures}
    sections = {
        one.key: Section(one.title, (one.finding, *one.sentences, one.table), brief=False)
        for one in audit
    }

    def gallery(*names: str, wide: bool = False) -> Section:
        shown = tuple(drawn[name] for name in names if name in drawn)
        return Section("", (Gallery(shown, wide),), brief=False)

    return Document(
        "",
        "the paper, reproduced",
        "The paper's tables and figures recomputed, and what does not hold",
        "The tables and figures were recomputed for the shipped prototype. For "
        f"{sum(one.within_mean for one in rows)} of {len(rows)} measured averages the model's "
        "speed is within their interval; Table 2's amplitude and the friction were fitted to them.",
        (
            Section("Findings", tuple(f"{one.title}. {one.finding}" for one in audit)),
            sections.pop("columns"),
            gallery("figure4", "figure5", wide=True),
            gallery("figure3", "signs", "figure6", "period"),
            gallery("readings"),
            *sections.values(),
        ),
        footer=(CITATION, *versions(found.sha256)),
    )


def curves(found: Reproduction) -> dict[str, str]:
    """CSV texts by file name; SI units."""
    start, driven, motion = found.start, found.start.driven, found.signs.comparison
    average = dict(zip(np.round(start.t, 9), start.speed, strict=True))
    run = np.column_stack([driven.t, driven.x, driven.y, driven.psi, driven.phi])
    circles = [
        (one.gait.offset, *row)
        for one in found.turning.circles
        for row in np.column_stack([one.driven.t, one.driven.x, one.driven.y])[::5]
    ]
    return {
        "figure3.csv": csv_text(
            ("t", "x", "y", "psi", "phi", "average_speed"),
            [(*row, average.get(round(row[0], 9))) for row in run],
        ),
        # Thinned to the paper's steps or finer: 0.05 rad, 0.01 and 0.05 s.
        "figure4.csv": _surface(found.ratio_surface, 10),
        "figure5.csv": _surface(found.period_surface, 5),
        "figure6.csv": csv_text(("offset", "t", "x", "y"), circles),
        "signs.csv": csv_text(
            ("t", *(f"v {name}" for name in motion.v)),
            np.column_stack([motion.t, *motion.v.values()]),
        ),
    }


def _surface(surface: SpeedSurface, every: int) -> str:
    """Every fifth amplitude; `every`: the step of ratios or periods."""
    head = ("amplitude", "ratio", "period", "speed", "peak_rate", "keeps_30_rpm")
    rows = [
        (surface.amplitude[i], surface.ratio[j], surface.period[j], surface.speed[i, j],
         surface.rate[i, j], int(surface.rate[i, j] <= RATE_LIMIT))
        for j in range(0, len(surface.ratio), every)
        for i in range(0, len(surface.amplitude), 5)
    ]  # fmt: skip
    return csv_text(head, rows)


def record(found: Reproduction) -> dict[str, Any]:
    """The content of reproduce.json: the tables of the audit, in the units of their heads."""
    sections = {
        one.key: {
            "title": one.title,
            "finding": one.finding,
            "sentences": one.sentences,
            "rows": one.table.records,
        }
        for one in findings(found)
    }
    return {
        "status": "reproduced",
        "message": document(found).lead,
        "paper": CITATION,
        "mujoco_speed": found.mujoco,
        "sections": sections,
    }


def tables(found: Reproduction) -> dict[str, str]:
    """The curves, and the table of each finding; that of the columns holds Tables 2 and 3."""
    audit = {f"audit-{one.key}.csv": one.table.csv(digits=9) for one in findings(found)}
    audit["tables.csv"] = audit.pop("audit-columns.csv")
    return curves(found) | audit


REPORT = Report(
    record,
    document,
    "reproduce.json",
    "audit.md",
    tables=tables,
    others=(
        *("figure3.csv", "figure4.csv", "figure5.csv", "figure6.csv", "signs.csv", "tables.csv"),
        *("audit-signs.csv", "audit-left-out.csv", "audit-readings.csv", "audit-limits.csv"),
        *("audit-posture.csv", "audit-period.csv", "audit-amplitude.csv", "audit-turning.csv"),
    ),
    figures="rr_paper.figures",
    captions=captions("reproduction"),
)
