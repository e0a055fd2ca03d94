"""report.html of a blind trial: the picture, the counts, every miss."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from rr_opt.proof.opened import Opened
from rr_opt.proof.score import coverage
from rr_opt.proof.score.by_engine import by_engine, side_by_side
from rr_opt.proof.score.confusion import DEFINITION
from rr_opt.proof.score.measure import Measure
from rr_opt.proof.score.measures import measures
from rr_opt.report.html import card, document, figure, table
from rr_opt.report.proof.record import page_of
from rr_opt.report.proof.summary import CHANGED, ENGINES_TOLD, ISOLATION, headline
from rr_opt.report.proof.words import (
    hidden_text,
    rate_text,
    said_text,
    share_text,
    visible_text,
)

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
