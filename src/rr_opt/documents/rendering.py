"""A document rendered: for a terminal, as Markdown, and as one HTML file that opens anywhere."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING
from urllib.parse import quote

from rr_opt.documents import document as doc

if TYPE_CHECKING:
    from jinja2 import Template
    from markupsafe import Markup


_WIDTH = 100
_PLAIN = " !()*+,-./:;=?@[]_{|}"
"""Characters that an SVG keeps in a data URI; base64 would be a quarter longer."""


def terminal(document: doc.Document) -> str:
    """The brief sections as text."""
    head = f"{document.name}: {document.title}" if document.name else document.title
    # The reason for a missing result goes to stderr.
    lead = f". {document.lead}" if document.lead and document.good else ""
    parts = [_wrapped(head + lead)] if head else []
    parts += [_section(section) for section in document.sections if section.brief]
    return "\n\n".join("\n".join(lines) for lines in parts if lines) + "\n"


def _section(section: doc.Section) -> list[str]:
    lines = [line for block in section.blocks if block for line in _lines(block)]
    if not lines or not section.title:
        return lines
    return [section.title, *(f"  {line}" if line else line for line in lines)]


def _lines(block: doc.Block) -> list[str]:
    match block:
        case str():
            return _wrapped(block)
        case doc.Facts():
            return _hanging([(fact.label, fact.text) for fact in block.items])
        case doc.Table():
            return columns(_cells(block)) + _wrapped(block.note)
        case doc.Checks():
            return _hanging(block.items)
        case doc.Chain():
            return columns([(step.name, f"{step.mark}  {step.detail}") for step in block.items])
        case doc.Gallery():
            return []


def _cells(block: doc.Table) -> list[list[str]]:
    return [list(block.head), *([doc.cell_text(cell) for cell in row] for row in block.rows)]


def columns(rows: Sequence[Sequence[str]]) -> list[str]:
    """Rows of cells in columns as wide as their widest cell, at least 8."""
    if not rows:
        return []
    count = max(len(row) for row in rows)
    widths = [max([6, *(len(row[i]) for row in rows if i < len(row) - 1)]) for i in range(count)]
    return ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]


def _hanging(rows: Sequence[tuple[str, str]]) -> list[str]:
    """Labels with their texts; a long text continues with a hanging indent."""
    width = max([6, *(len(label) for label, _ in rows)]) + 2
    return [
        line
        for label, words in rows
        for line in _wrapped(words, label.ljust(width), " " * width) or [label]
    ]


def _wrapped(words: str, first: str = "", later: str = "") -> list[str]:
    wrapper = textwrap.TextWrapper(
        _WIDTH, first, later, break_long_words=False, break_on_hyphens=False
    )
    return wrapper.wrap(words)


def markdown(document: doc.Document) -> str:
    """Every section as Markdown, the figures as links to files beside it."""
    parts = [f"# {document.title}", document.lead]
    for section in document.sections:
        blocks = [_marked(block) for block in section.blocks if block]
        parts += [f"## {section.title}" if blocks and section.title else "", *blocks]
    return "\n\n".join(part for part in (*parts, *document.footer) if part) + "\n"


def _marked(block: doc.Block) -> str:
    match block:
        case str():
            return block
        case doc.Facts():
            return "\n".join(f"- **{fact.label}**: {fact.text}" for fact in block.items)
        case doc.Table():
            return "\n\n".join(filter(None, (_marked_table(block), block.note)))
        case doc.Checks():
            return "\n".join(f"- {state}: {sentence}" for state, sentence in block.items)
        case doc.Chain():
            return "\n".join(f"- {s.name}: {s.mark} {s.detail}".rstrip() for s in block.items)
        case doc.Gallery():
            return "\n\n".join(f"![{figure.alt}]({figure.name}.svg)" for figure in block.items)


def _marked_table(block: doc.Table) -> str:
    """Padded, to be readable as plain text too."""
    head, *rows = _cells(block)
    for cells, row in zip(rows, block.rows, strict=True):
        for k, cell in enumerate(row):
            if isinstance(cell, doc.Link):
                cells[k] = f"[{cell.text}]({cell.target})"
    widths = [max(3, *(len(row[k]) for row in (head, *rows))) for k in range(len(head))]
    lines = ["| " + " | ".join(map(str.ljust, row, widths)) + " |" for row in (head, *rows)]
    lines.insert(1, "|" + "|".join("-" * (width + 2) for width in widths) + "|")
    return "\n".join(lines)


PAGE = "report.html"


def page(document: doc.Document) -> str:
    """The whole page; all text is escaped."""
    return _template().render(document=document)


@cache
def _template() -> Template:
    environment = doc.templates("rr_opt.documents", "templates", autoescape=True)
    environment.filters |= {
        "code": _code,
        "cell_text": doc.cell_text,
        "data_uri": lambda svg: f"data:image/svg+xml,{quote(svg, safe=_PLAIN)}",
        "kind": lambda block: type(block).__name__.lower(),
    }
    environment.tests |= {
        "badge": lambda cell: isinstance(cell, doc.Badge),
        "link": lambda cell: isinstance(cell, doc.Link),
        "count": lambda cell: doc.cell_text(cell)[:1].isdecimal(),
        "gallery": lambda block: isinstance(block, doc.Gallery),
        "tiles": lambda block: isinstance(block, doc.Facts) and block.key,
    }
    return environment.get_template("document.html")


def _code(text: str) -> Markup:
    """The text escaped, with typographic signs, backticks as code, and numbers kept on one line."""
    from markupsafe import Markup, escape

    signs = text.replace("->", "→").replace("+-", "±")
    whole = re.sub(r"(?<=\de)-(?=\d)", "\N{NON-BREAKING HYPHEN}", signs)
    return Markup(re.sub("`([^`]+)`", r"<code>\1</code>", str(escape(whole))))
