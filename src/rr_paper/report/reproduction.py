"""The reproduction as a document, and its curves as CSV."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from rr_opt.documents.document import Document, Figure, Gallery, Section, csv_text, versions
from rr_opt.documents.report import Report
from rr_paper.publication import CITATION, RATE_LIMIT
from rr_paper.report.audit import findings
from rr_paper.reproduction import Reproduction
from rr_paper.tables import SpeedSurface

CAPTIONS = {
    "figure3": (
        "Beside Fig. 3: a start from rest",
        "The path of the joint from rest, and the average speed rising to its steady value.",
        "The paper does not say which gait it shows; here it is a row of Table 3. The average is "
        "the displacement of P over a sliding period, as in the paper.",
    ),
    "signs": (
        "The signs of equation (3)",
        "Speed of axle 1 over time: three curves on one another, a fourth apart.",
        "Two derivations and the corrected equation coincide; the printed one does not.",
    ),
    "figure4": (
        "Beside Fig. 4: J20/J10 and amplitude",
        "A map of speed with Table 2's rows, and their speeds over the amplitude.",
        "Left: means of Table 2 (mm/s, 95 % intervals) in the colour of their speed, at the "
        "amplitude that fits best. Right: the same rows over the amplitude that the paper leaves "
        "out.",
    ),
    "figure5": (
        "Beside Fig. 5: period and amplitude",
        "A map of speed with Table 3's rows, and cuts through it at 1 s and 2 s.",
        "Left: means of Table 3 (mm/s, 95 % intervals) in the colour of their speed; where a dot "
        "is paler than its surroundings, the model is too fast. Right: cuts at the two periods.",
    ),
    "figure6": (
        "Beside Fig. 6: three offsets",
        "Three circles through one point, the smaller the larger the offset.",
        "One lap, from rest at the dot. The paper prints no radius to compare these with.",
    ),
    "period": (
        "The effect of the period",
        "The ratio of speeds at 1 s and 2 s over the amplitude, with intervals.",
        "With viscous friction every robot is near 4. The intervals allow it; v_exp does not.",
    ),
    "readings": (
        "What the nine averages say about readings",
        "Chi-square of every reading for both columns.",
        "p by Student's t of three runs. No definition of J20/J10 stands out.",
    ),
}


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
    return curves(found) | {
        "tables.csv" if one.key == "columns" else f"audit-{one.key}.csv": one.table.csv(digits=9)
        for one in findings(found)
    }


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
    figures="rr_paper.report.figures",
    captions=CAPTIONS,
)
