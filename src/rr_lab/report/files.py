"""The files of a blind trial: the record, the table of cases, the figure, the page."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any

from rr_lab.report.summary import (
    CHANGED,
    ENGINES_TOLD,
    ISOLATION,
    headline,
    hidden_text,
    page_of,
    rate_text,
    record,
    said_text,
    share_text,
    summary,
    visible_text,
)
from rr_lab.trial import statistics as coverage
from rr_lab.trial.case import Case
from rr_lab.trial.confusion import DEFINITION
from rr_lab.trial.measures import BREAKDOWN, breakdown, by_engine, measures, side_by_side
from rr_lab.trial.statistics import Measure
from rr_lab.trial.trial import Opened
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.html import card, document, figure, table
from rr_opt.report.text import columns

HEAD = (
    "case", "kind", "engine", "strength", "nominal_off", "hidden", "visible_sigma",
    "refitted_sigma", "counted", "said", "outcome", "missed", "groups", "heldout_before",
    "heldout_refitted", "heldout_after", "wall_s", "cpu_s", "disturbance",
)  # fmt: skip


def csv_text(opened: Opened) -> str:
    """The table as CSV; where there are two effects the less visible one's sigma are told."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEAD)
    writer.writerows([_written(cell) for cell in _row(case)] for case in opened.cases)
    return text.getvalue()


def _row(case: Case) -> list[Any]:
    truth, claim = case.truth, case.claim
    groups = ["|".join(sorted(group)) for group in claim.groups] if claim else []
    return [
        case.id,
        truth.kind,
        truth.engine,
        truth.strength,
        truth.spread > 0,
        hidden_text(case),
        min(truth.seen.values(), default=None),
        min(truth.remains.values(), default=None),
        case.scored,
        said_text(case),
        case.outcome,
        case.missed,
        "; ".join(groups),
        claim.before if claim else None,
        claim.refitted if claim else None,
        claim.after if claim else None,
        case.wall,
        case.cpu,
        truth.disturbance,
    ]


def _written(cell: Any) -> Any:
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    return "" if cell is None else f"{cell:.6g}" if isinstance(cell, float) else cell


_TILES = ("false_claims", "single", "pair_both", "parameters", "outside", "no_answer")


def page(opened: Opened, drawn: str) -> str:
    """The whole page; drawn: the figure as SVG."""
    every = [one for one in measures(opened.cases) if one.rate.total]
    body = [
        _header(opened),
        _tiles(every),
        figure(drawn, "What was said of what was hidden", DEFINITION),
        card("Counts", _counts(every)),
        card("By engine", _engines(opened)),
        card("By effect, realisation and disturbance", _breakdown(opened)),
        card("Misses", _misses(opened)),
        card("Intervals that hold the true value", _coverage(opened)),
        f"<footer>rr-opt {escape(opened.version)} · seed <code>{escape(opened.seed)}</code> · code "
        f"SHA-256 <code>{escape(opened.code)}</code></footer>",
    ]
    return document(headline(opened), body)


def _header(opened: Opened) -> str:
    title = headline(opened)
    return (
        '<header><p class="kind">Roller Racer · blind trial of the diagnosis</p>'
        f'<h1>{escape(title)}</h1><p class="lead">{len(opened.cases)} cases. '
        f"{escape(ISOLATION)} {escape(CHANGED if opened.changed else '')}</p></header>"
    )


def _tiles(every: Sequence[Measure]) -> str:
    inner = "".join(
        f'<div class="tile"><b>{escape(rate_text(one.rate))}</b>'
        f"<span>{escape(one.title)}</span></div>"
        for one in every
        if one.name in _TILES
    )
    return f'<div class="tiles">{inner}</div>'


def _counts(every: Sequence[Measure]) -> str:
    head = ["What", "Count", "Share, 95 % interval", "What is counted"]
    rows = [[m.title, rate_text(m.rate), share_text(m.rate), m.definition] for m in every]
    return table(head, rows)


def _engines(opened: Opened) -> str:
    head = ["What", *by_engine(opened.cases)]
    rows = [
        [title, *(f"{rate_text(one.rate)}, {share_text(one.rate)}" for one in own)]
        for title, own in side_by_side(opened.cases)
    ]
    return f"<p>{escape(ENGINES_TOLD)}</p>{table(head, rows)}"


def _breakdown(opened: Opened) -> str:
    rows = [
        [what, key, rate_text(one), share_text(one)]
        for what, by_key in breakdown(opened.cases).items()
        for key, one in by_key.items()
    ]
    head = ["By", "What", "Right", "Share, 95 % interval"]
    return f"<p>{escape(BREAKDOWN)}</p>{table(head, rows)}" if rows else ""


def _misses(opened: Opened) -> str:
    if not opened.misses:
        return "<p>None.</p>"
    head = ["Case", "Outcome", "Engine", "Hidden", "Visible", "Said"]
    rows = [
        [
            *(case.id, case.outcome, case.truth.engine),
            *(hidden_text(case), visible_text(case), said_text(case)),
        ]
        for case in opened.misses
    ]
    links = " · ".join(
        f'<a href="{escape(page_of(case))}">{escape(case.id)}</a>' for case in opened.misses
    )
    return f"{table(head, rows)}<p>Their pages: {links}</p>"


def _coverage(opened: Opened) -> str:
    every = coverage.intervals(opened.cases)
    if not every:
        return ""
    rows = [
        [name, rate_text(one), share_text(one)] for name, one in coverage.by_quantity(every).items()
    ]
    return f"<p>{escape(coverage.DEFINITION)}</p>" + table(
        ["Quantity", "Count", "Share, 95 % interval"], rows
    )


def told(case: Case, folder: Path) -> str:
    """What was hidden, what was said, and where everything is."""
    rows = [
        ("case", case.id),
        ("kind", case.truth.kind),
        ("engine", case.truth.engine),
        ("disturbance", case.truth.disturbance),
        ("hidden", hidden_text(case)),
        ("visible", visible_text(case)),
        ("said", said_text(case)),
        ("outcome", case.outcome if case.scored else f"{case.outcome} (invisible, not counted)"),
        ("time", f"{case.wall:.0f} s, {case.cpu:.0f} s of CPU"),
        ("files", str(folder)),
    ]
    return "\n".join(columns([row for row in rows if row[1]])) + "\n"


RECORD, TABLE, SUMMARY, PAGE, FIGURE = (
    "proof.json", "cases.csv", "README.md", "report.html", "confusion.svg",
)  # fmt: skip


def write_proof(opened: Opened, folder: Path) -> list[Path]:
    """Write everything; returns the files in the order to name them."""
    remove(folder, (RECORD, TABLE, SUMMARY, PAGE, FIGURE))
    from rr_lab.report.confusion_figure import draw

    drawn = draw(opened)
    text = summary(opened).replace(
        "\n\n", f"\n\n![What was said of what was hidden]({FIGURE})\n\n", 1
    )
    return [
        write_text(folder / PAGE, page(opened, drawn)),
        write_text(folder / SUMMARY, text),
        write_json(folder / RECORD, record(opened)),
        write_text(folder / TABLE, csv_text(opened)),
        write_text(folder / FIGURE, drawn),
    ]
