"""Pieces of HTML: every text that goes in is escaped here."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape

CSS = """
:root { --ink:#1f2933; --grey:#5b6773; --line:#dde3e8; --ground:#f4f6f8; --card:#fff;
  --good:#00704f; --bad:#a3341b; --blue:#0072b2; color-scheme: light; }
* { box-sizing: border-box; }
body { margin:0; background:var(--ground); color:var(--ink); line-height:1.5;
  font:16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; }
main { max-width:1180px; margin:0 auto; padding:28px 24px 48px; }
.kind { color:var(--grey); font-size:.86rem; letter-spacing:.02em; margin:0 0 6px; }
header { background:var(--card); border:1px solid var(--line); border-left:6px solid var(--good);
  border-radius:10px; padding:20px 24px; margin-bottom:20px; }
header.bad { border-left-color:var(--bad); }
h1 { font-size:1.6rem; line-height:1.25; margin:0; text-wrap:balance; }
h2 { font-size:1.08rem; margin:0 0 10px; }
.lead { margin:.6rem 0 0; color:var(--grey); max-width:75ch; }
.tiles { display:grid; grid-template-columns:repeat(auto-fit,minmax(150px,1fr)); gap:12px;
  margin-bottom:20px; }
.tile { background:var(--card); border:1px solid var(--line); border-radius:10px;
  padding:12px 16px; }
.tile b { display:block; font-size:1.3rem; font-weight:650; white-space:nowrap; }
.tile span { color:var(--grey); font-size:.86rem; display:block; }
.grid { display:grid; grid-template-columns:repeat(2,minmax(0,1fr)); column-gap:20px; }
.card { background:var(--card); border:1px solid var(--line); border-radius:10px;
  padding:18px 20px; margin:0 0 20px; min-width:0; }
figure img { display:block; width:100%; height:auto; }
figcaption { color:var(--grey); font-size:.9rem; margin-top:8px; }
ul.checks { list-style:none; margin:0; padding:0; }
ul.checks li { padding:7px 0 7px 30px; position:relative; border-top:1px solid var(--line); }
ul.checks li:first-child { border-top:0; }
ul.checks li::before { content:"\\2713"; position:absolute; left:4px; font-weight:700;
  color:var(--good); }
ul.checks li.bad { color:var(--bad); font-weight:600; }
ul.checks li.bad::before { content:"\\2717"; color:var(--bad); }
table { border-collapse:collapse; width:100%; font-size:.94rem; }
th { text-align:left; color:var(--grey); font-weight:600; border-bottom:1.5px solid var(--line);
  padding:6px 14px 6px 0; vertical-align:bottom; }
td { border-bottom:1px solid var(--line); padding:7px 14px 7px 0; vertical-align:top;
  font-variant-numeric:tabular-nums; }
tr:last-child td { border-bottom:0; }
.badge { display:inline-block; border-radius:999px; padding:0 9px; font-size:.8rem; font-weight:600;
  border:1px solid currentColor; }
.measured, .yes { color:var(--good); } .fitted { color:var(--blue); } .assumed { color:#96590a; }
.no, .unsaid { color:var(--grey); }
footer { color:var(--grey); font-size:.84rem; overflow-wrap:anywhere; }
code { font-size:.92em; }
@media (max-width:860px) {
  main { padding:14px 12px 32px; }
  header, .card { padding:14px; }
  h1 { font-size:1.25rem; }
  .grid { grid-template-columns:minmax(0,1fr); }
  .tiles { grid-template-columns:repeat(2,minmax(0,1fr)); gap:10px; }
  .tile b { font-size:1.1rem; }
  .card, .tiles, header { margin-bottom:14px; }
  thead { display:none; }
  tr { display:block; padding:8px 0; border-bottom:1px solid var(--line); }
  tr:last-child { border-bottom:0; }
  td { display:flex; gap:12px; border:0; padding:2px 0; justify-content:space-between; }
  td::before { content:attr(data-label); color:var(--grey); flex:0 0 34%; }
  td:first-child { font-weight:650; } td:first-child::before { display:none; }
  td:empty { display:none; }
  td > span.cell { text-align:right; overflow-wrap:anywhere; }
}
@media print { body { background:#fff; } .card, header, .tile { break-inside:avoid; } }
"""


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
