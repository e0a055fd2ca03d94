"""report.html of an inspection: one file that opens anywhere, the doubts first."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape

import numpy as np

from rr_opt import __version__
from rr_opt.recordings.inspection import Inspection
from rr_opt.recordings.sizes import size_text
from rr_opt.report.html import Badge, Cell, card, figure, table
from rr_opt.report.inspect.summary import rows
from rr_opt.report.page_style import CSS

_CAPTIONS = {
    "path": ("The joint's path", "P seen from above. Arrows: platform 1's heading."),
    "channels": (
        "Channels",
        "What is taken as data. Bands: gaps; gaps of up to 0.1 s are bridged by a thin line, in "
        "this figure only. Crosses: flagged samples, those within the axes.",
    ),
    "command": (
        "phi against its command",
        "Above: samples at their phase of the period. Below: the difference over time.",
    ),
    "rigid": (
        "Markers on rigid platforms",
        "What is left of a fit of two rigid platforms joined at P: by frame, and by marker.",
    ),
    "noise": (
        "Noise",
        "From sixth differences, with a 95 % interval, against the stated noise. White noise is "
        "the same at half the frequency; behind a low-pass filter it is larger there.",
    ),
}
_COLUMNS = (("path", "noise", "rigid"), ("channels", "command"))


def page(
    name: str, sha256: str, found: Sequence[Inspection], drawn: Sequence[Mapping[str, str]]
) -> str:
    """The whole page; drawn: of each recording its figures, SVG texts by name."""
    several = len(found) > 1
    body = [_header(name, found), card("Recordings", _table(found)) if several else ""]
    for one, figures in zip(found, drawn, strict=True):
        title = one.name if several else "What was read"
        body += [card(title, _of_one(one)), _gallery(figures, one.name if several else "")]
    body.append(
        f"<footer>rr-opt {escape(__version__)} · input SHA-256 "
        f"<code>{escape(sha256)}</code></footer>"
    )
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(name)}: {escape(_verdict(found))}</title><style>{CSS}</style></head>\n"
        "<body><main>\n" + "\n".join(part for part in body if part) + "\n</main></body></html>\n"
    )


def _verdict(found: Sequence[Inspection]) -> str:
    count = sum(len(one.doubts) for one in found)
    what = f"{len(found)} recordings" if len(found) > 1 else "A recording"
    if not count:
        return f"{what} without a doubt"
    return f"{what} with {count} doubt{'s' if count > 1 else ''}"


def _header(name: str, found: Sequence[Inspection]) -> str:
    doubted = [one.name for one in found if one.doubts]
    lead = "Nothing looks wrong in what was read."
    if doubted:
        lead = (
            "Read each doubt below before the recording is used. Nothing was filled in or dropped."
        )
    return (
        f'<header class="{"bad" if doubted else ""}"><p class="kind">Roller Racer · '
        f"{escape(name)} · recordings</p><h1>{escape(_verdict(found))}</h1>"
        f'<p class="lead">{escape(lead)}</p></header>'
    )


def _table(found: Sequence[Inspection]) -> str:
    head = ["Recording", "Samples", "Length", "Noise of x", "Noise of phi", "Doubts"]
    lines: list[list[Cell]] = []
    for one in found:
        noise, t = one.cleaned.noise, one.recording.t
        count = len(one.doubts)
        lines.append(
            [
                one.name,
                str(len(t)),
                f"{t[-1] - t[0]:.4g} s",
                size_text("x", noise["x"].sigma),
                size_text("phi", noise["phi"].sigma),
                Badge(str(count), "assumed") if count else Badge("none", "yes"),
            ]
        )
    return table(head, lines)


def _of_one(found: Inspection) -> str:
    items = "".join(f'<li class="bad">{escape(text)}</li>' for text in found.doubts)
    doubts = f'<ul class="checks">{items or "<li>No doubts.</li>"}</ul>'
    facts = [[name.strip(), text] for name, text in rows(found)]
    sigma = {name: float(np.median(one)) for name, one in found.recording.sigma.items()}
    facts.append(["sigma taken", ", ".join(f"{n} {size_text(n, s)}" for n, s in sigma.items())])
    return doubts + table(["What", "Found"], facts)


def _gallery(figures: Mapping[str, str], prefix: str) -> str:
    columns = []
    for names in _COLUMNS:
        column = ""
        for name in names:
            if name in figures:
                title, caption = _CAPTIONS[name]
                column += figure(figures[name], f"{prefix}: {title}" if prefix else title, caption)
        columns.append(column)
    return f'<div class="grid">{"".join(f"<div>{one}</div>" for one in columns if one)}</div>'
