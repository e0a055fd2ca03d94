"""Tables of the audit as text: for people with few digits, for programs with all of them."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence

from rr_opt.report.paper.audit.section import Section, Value
from rr_opt.report.quantities import number

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
