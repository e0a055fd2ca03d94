"""The reproduction as a page, a record, text, and a folder."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

from rr_opt import __version__
from rr_opt.answers.quantities import number
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.html import CSS, Badge, Cell, card, figure, table
from rr_opt.report.text import columns
from rr_paper.printed import CITATION
from rr_paper.report.audit import Section, Value
from rr_paper.report.audit_runs import sections
from rr_paper.report.cells import csv_text, curves, markdown, shown
from rr_paper.reproduction import Reproduction


@dataclass(frozen=True)
class Reproduced:
    """What was found, the sections that tell it, the fingerprint of the input, and the speed of the
    typical gait by a MuJoCo model, m/s, if there was one."""

    found: Reproduction
    sections: tuple[Section, ...]
    sha256: str
    mujoco: float | None

    @property
    def lead(self) -> str:
        """What was done, in a sentence or two."""
        rows = (*self.found.tables.table2, *self.found.tables.table3)
        near = sum(one.near_mean for one in rows)
        return (
            "The tables and figures again, by the shipped prototype, and what was found on the "
            f"way. {near} of {len(rows)} measured averages hold the model's speed within their "
            "interval; Table 2's amplitude and the friction were fitted to them."
        )


def reproduced(found: Reproduction, sha256: str, mujoco: float | None = None) -> Reproduced:
    """The reproduction with its sections."""
    return Reproduced(found, sections(found, mujoco), sha256, mujoco)


def record(result: Reproduced) -> dict[str, Any]:
    """The content of reproduce.json: the tables of all sections, in the units of their heads."""
    return {
        "status": "reproduced",
        "message": result.lead,
        "paper": CITATION,
        "mujoco_speed": result.mujoco,
        "sections": {
            one.key: {
                "title": one.title,
                "finding": one.finding,
                "sentences": list(one.sentences),
                "rows": [dict(zip(one.head, map(_finite, row), strict=True)) for row in one.rows],
            }
            for one in result.sections
        },
        "version": __version__,
        "input_sha256": result.sha256,
    }


def _finite(value: Value) -> Value:
    """The value, or None for no bound."""
    return None if isinstance(value, float) and math.isinf(value) else value


def summary(result: Reproduced, files: Sequence[Path]) -> str:
    """The findings as text for a terminal."""
    lines = ["The paper, reproduced and audited.", ""]
    for one in result.sections:
        lines += [one.title, f"  {one.finding}"]
    told = [("files" if not i else "", str(file)) for i, file in enumerate(files)]
    return "\n".join([*lines, "", *columns(told)]) + "\n"


_CAPTIONS = {
    "figure3": (
        "Beside Fig. 3: a start from rest",
        "The paper does not say which gait it shows; here a row of Table 3 is driven. The average "
        "is the displacement of P over a sliding period, as in the paper.",
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
        "is paler than its ground, the model is too fast. Right: cuts at the two periods.",
    ),
    "figure6": (
        "Beside Fig. 6: three offsets",
        "From rest at the dot and once round. The paper prints no radius to hold these against.",
    ),
    "signs": (
        "The signs of equation (3)",
        "Two derivations and the corrected equation lie on one line; the printed one does not.",
    ),
    "readings": (
        "What the nine averages say about readings",
        "p by Student's t of three runs. No reading of J20/J10 stands out.",
    ),
    "period": (
        "What the period does",
        "With viscous friction every robot is near 4. The intervals allow it; v_exp does not.",
    ),
}


def page(result: Reproduced, figures: Mapping[str, str]) -> str:
    """The whole page; figures are SVG texts by name."""
    wide = "".join(figure(figures[name], *_CAPTIONS[name]) for name in ("figure4", "figure5"))
    columns = [
        "".join(figure(figures[name], *_CAPTIONS[name]) for name in names)
        for names in (("figure3", "signs"), ("figure6", "period"))
    ]
    grid = "".join(f"<div>{column}</div>" for column in columns)
    body = [
        f'<header><p class="kind">Roller Racer · the paper, reproduced</p>'
        f"<h1>The paper&#39;s tables and figures again, and what does not hold</h1>"
        f'<p class="lead">{escape(result.lead)}</p></header>',
        _tables(result),
        wide,
        f'<div class="grid">{grid}</div>',
        figure(figures["readings"], *_CAPTIONS["readings"]),
        *(_card(one) for one in result.sections if one.key != "columns"),
        f"<footer>{escape(CITATION)} · rr-opt {escape(__version__)} · input SHA-256 "
        f"<code>{escape(result.sha256)}</code></footer>",
    ]
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>The paper, reproduced</title><style>{CSS}</style></head>\n<body><main>\n"
        + "\n".join(body)
        + "\n</main></body></html>\n"
    )


def _tables(result: Reproduced) -> str:
    """Tables 2 and 3 beside the model, and what their columns may mean."""
    head = ["Table", "J20/J10", "T, s", "α, rad", "Printed mean, mm/s", "Printed v_exp, mm/s",
            "Model, mm/s", "Within the interval"]  # fmt: skip
    rows: list[list[Cell]] = []
    for one in (*result.found.tables.table2, *result.found.tables.table3):
        row = one.row
        rows.append(
            [
                "2" if row.amplitude is None else "3",
                number(row.ratio),
                number(row.period),
                number(one.amplitude, 3) + (" (fitted)" if row.amplitude is None else ""),
                f"{1e3 * row.mean:.1f} ± {1e3 * row.half_width:.0f}",
                f"{1e3 * row.other:.1f}",
                f"{1e3 * one.speed:.1f}",
                Badge("yes", "yes") if one.near_mean else Badge("no", "no"),
            ]
        )
    columns = next(one for one in result.sections if one.key == "columns")
    return card("Tables 2 and 3, printed and computed", table(head, rows) + _words(columns))


def _card(section: Section) -> str:
    rows = [[_cell(cell) for cell in row] for row in section.rows]
    return card(section.title, _words(section) + table(section.head, rows))


def _words(section: Section) -> str:
    told = "".join(f"<p>{escape(one)}</p>" for one in section.sentences)
    return f"<p><b>{escape(section.finding)}</b></p>{told}"


def _cell(value: Value) -> Cell:
    return shown(value)


FIGURES = ("figure3", "figure4", "figure5", "figure6", "signs", "readings", "period")
PAGE, AUDIT, RECORD = "report.html", "audit.md", "reproduce.json"


def write_reproduction(result: Reproduced, folder: Path, *, figures: bool) -> list[Path]:
    """Write everything; returns the files. What an earlier run left is removed before.

    A section's table goes to a CSV of its name; that of the columns holds Tables 2 and 3.
    """
    lines = curves(result.found)
    tables = {
        f"{'tables' if one.key == 'columns' else f'audit-{one.key}'}.csv": csv_text(
            one.head, one.rows
        )
        for one in result.sections
    }
    remove(folder, (PAGE, AUDIT, RECORD, *lines, *tables, *(f"{name}.svg" for name in FIGURES)))
    written = [
        write_text(folder / AUDIT, markdown(result.sections, result.lead)),
        write_json(folder / RECORD, record(result)),
        *(write_text(folder / name, text) for name, text in {**tables, **lines}.items()),
    ]
    if not figures:
        return written
    # Here and not above: without figures matplotlib need not be loaded.
    from rr_paper.report.figures import draw

    drawn = draw(result.found)
    written += [write_text(folder / f"{name}.svg", drawn[name]) for name in FIGURES]
    return [write_text(folder / PAGE, page(result, drawn)), *written]
