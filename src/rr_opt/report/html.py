"""Pieces of HTML: every text that goes in is escaped here."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape

from rr_opt.report.page_style import CSS


@dataclass(frozen=True)
class Badge:
    """A short word in a coloured frame; `kind` names its colour in the style sheet."""

    text: str
    kind: str


Cell = str | Badge


def document(title: str, body: Iterable[str], style: str = "") -> str:
    """A whole page of its parts, those that are not empty; style: CSS beside the common one."""
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)}</title><style>{CSS}{style}</style></head>\n<body><main>\n"
        + "\n".join(part for part in body if part)
        + "\n</main></body></html>\n"
    )


def card(title: str, body: str) -> str:
    """A titled section; nothing if there is nothing to show."""
    return f'<section class="card"><h2>{escape(title)}</h2>{body}</section>' if body else ""


def table(head: Sequence[str], rows: Iterable[Sequence[Cell]]) -> str:
    """A table that turns into a list of cards where the screen is narrow."""
    lines = [
        "<tr>"
        + "".join(
            f'<td data-label="{escape(label)}">{_cell(cell)}</td>'
            for label, cell in zip(head, row, strict=True)
        )
        + "</tr>"
        for row in rows
    ]
    titles = "".join(f"<th>{escape(label)}</th>" for label in head)
    return f"<table><thead><tr>{titles}</tr></thead><tbody>{''.join(lines)}</tbody></table>"


def figure(svg: str, title: str, caption: str) -> str:
    """A drawing inside the page itself, as a card with its caption."""
    data = base64.b64encode(svg.encode()).decode()
    return (
        f'<figure class="card"><h2>{escape(title)}</h2>'
        f'<img alt="{escape(title)}" src="data:image/svg+xml;base64,{data}">'
        f"<figcaption>{escape(caption)}</figcaption></figure>"
    )


def _cell(cell: Cell) -> str:
    if isinstance(cell, Badge):
        return f'<span class="badge {escape(cell.kind)}">{escape(cell.text)}</span>'
    return f'<span class="cell">{escape(cell)}</span>' if cell else ""
