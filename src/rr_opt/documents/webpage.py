"""A document as one HTML file that opens anywhere, without network."""

from __future__ import annotations

import base64
import re
from functools import cache
from typing import TYPE_CHECKING

from rr_opt.documents import document as doc

if TYPE_CHECKING:
    from jinja2 import Template
    from markupsafe import Markup

PAGE = "report.html"

_KINDS = {
    doc.Facts: "facts",
    doc.Table: "table",
    doc.Checks: "checks",
    doc.Chain: "chain",
    doc.Gallery: "gallery",
}


def page(document: doc.Document) -> str:
    """The whole page; every text is escaped."""
    return _template().render(document=document)


@cache
def _template() -> Template:
    # Here and not above: without a page Jinja2 need not be loaded.
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("rr_opt.documents"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
    )
    environment.filters |= {
        "code": _code,
        "cell_text": doc.cell_text,
        "data_uri": _data_uri,
        "kind": _kind,
    }
    environment.tests |= {
        "badge": lambda cell: isinstance(cell, doc.Badge),
        "link": lambda cell: isinstance(cell, doc.Link),
        "gallery": lambda block: isinstance(block, doc.Gallery),
        "tiles": lambda block: isinstance(block, doc.Facts) and block.key,
    }
    return environment.get_template("document.html")


def _code(text: str) -> Markup:
    """The text escaped, and what stands in backticks as code."""
    from markupsafe import Markup, escape

    return Markup(re.sub("`([^`]+)`", r"<code>\1</code>", str(escape(text))))


def _data_uri(svg: str) -> str:
    return f"data:image/svg+xml;base64,{base64.b64encode(svg.encode()).decode()}"


def _kind(block: doc.Block) -> str:
    return _KINDS.get(type(block), "text")
