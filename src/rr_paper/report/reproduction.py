"""The reproduction as a document, a record and CSV files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.document import Document, Figure, Gallery, Section, csv_text
from rr_opt.report.text import markdown
from rr_opt.report.webpage import PAGE, write_page
from rr_opt.version import __version__
from rr_paper.publication import CITATION, RATE_LIMIT
from rr_paper.report.audit import Finding
from rr_paper.report.audit_gaits import findings
from rr_paper.reproduction import Reproduction
from rr_paper.tables import SpeedSurface

AUDIT, RECORD = "audit.md", "reproduce.json"

FIGURES = {
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
"""Title, alternative text and caption of each."""


def document(found: Reproduction, sha256: str, figures: Mapping[str, str]) -> Document:
    """The page, its Markdown and the text for a terminal; figures: SVG texts by name, or none."""
    rows = found.tables.rows
    audit = {
        one.key: Section(one.title, (one.finding, *one.sentences, one.table), brief=False)
        for one in findings(found)
    }

    def gallery(*names: str, wide: bool = False) -> Section:
        shown = []
        for name in names if figures else ():
            title, alt, caption = FIGURES[name]
            shown.append(Figure(name, title, figures[name], alt, caption))
        return Section("", (Gallery(tuple(shown), wide),), brief=False)

    return Document(
        "",
        "the paper, reproduced",
        "The paper's tables and figures recomputed, and what does not hold",
        "The tables and figures were recomputed for the shipped prototype. For "
        f"{sum(one.within_mean for one in rows)} of {len(rows)} measured averages the model's "
        "speed is within their interval; Table 2's amplitude and the friction were fitted to them.",
        (
            Section("Findings", tuple(f"{one.title}. {one.finding}" for one in findings(found))),
            audit.pop("columns"),
            gallery("figure4", "figure5", wide=True),
            gallery("figure3", "signs", "figure6", "period"),
            gallery("readings"),
            *audit.values(),
        ),
        footer=(CITATION, f"rr-opt {__version__}", f"input SHA-256 `{sha256}`"),
    )


def record(found: Reproduction, sha256: str) -> dict[str, Any]:
    """The content of reproduce.json: the tables of the audit, in the units of their heads."""
    return {
        "status": "reproduced",
        "message": document(found, sha256, {}).lead,
        "paper": CITATION,
        "mujoco_speed": found.mujoco,
        "sections": {one.key: _section_record(one) for one in findings(found)},
        "version": __version__,
        "input_sha256": sha256,
    }


def _section_record(one: Finding) -> dict[str, Any]:
    return {
        "title": one.title,
        "finding": one.finding,
        "sentences": list(one.sentences),
        "rows": one.table.records,
    }


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


def write_reproduction(
    found: Reproduction, sha256: str, folder: Path, *, figures: bool
) -> list[Path]:
    """Write everything, after removing the files of an earlier run; returns the files.

    The table of each finding goes to a CSV file; that of the columns holds Tables 2 and 3.
    """
    texts = curves(found)
    for one in findings(found):
        name = "tables.csv" if one.key == "columns" else f"audit-{one.key}.csv"
        texts[name] = one.table.csv(digits=9)
    remove(folder, (PAGE, AUDIT, RECORD, *texts, *(f"{name}.svg" for name in FIGURES)))
    drawn: dict[str, str] = {}
    if figures:
        # Here and not above, so that matplotlib is not loaded without figures.
        from rr_paper.report.figures import draw

        drawn = draw(found)
    page = document(found, sha256, drawn)
    written = [
        write_text(folder / AUDIT, markdown(page)),
        write_json(folder / RECORD, record(found, sha256)),
        *(write_text(folder / name, text) for name, text in texts.items()),
    ]
    return write_page(folder, page, written) if figures else written
