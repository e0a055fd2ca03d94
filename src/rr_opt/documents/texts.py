"""Texts that are kept in files: prose with computed numbers in it, and the captions of figures.

Prose is Markdown with Jinja2 expressions: sections `# key: Title`, each of paragraphs. Filters
write a number: `n(3)` to three significant digits, `f(1)` to one decimal, `e` as a power of ten,
`span` as a range.
"""

import math
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

from rr_opt.documents.document import Captions
from rr_opt.formatting import number


@dataclass(frozen=True)
class Prose:
    """A section: its title and its paragraphs."""

    title: str
    paragraphs: tuple[str, ...]


def prose(package: str, name: str, **context: Any) -> dict[str, Prose]:
    """The sections of `texts/NAME` in a package, by key. Raises UndefinedError for a value that the
    context does not have."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader(package, "texts"),
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
        autoescape=False,
    )
    environment.filters |= {
        "n": number,
        "f": lambda value, digits: f"{value:.{digits}f}",
        "e": lambda value: f"{value:.0e}",
        "span": _span,
    }
    environment.globals["zip"] = zip
    text = environment.get_template(name).render(**context)
    sections = {}
    for section in f"\n{text}".split("\n# ")[1:]:
        head, *paragraphs = filter(None, map(str.strip, section.split("\n\n")))
        key, _, title = head.partition(": ")
        sections[key] = Prose(title, tuple(paragraphs))
    return sections


def _span(low: float, high: float, digits: int = 3) -> str:
    """`0.5 to 1.2`, or `above 0.5` where there is no upper end."""
    if math.isinf(high):
        return f"above {number(low, digits)}"
    return f"{number(low, digits)} to {number(high, digits)}"


def captions(kind: str) -> Captions:
    """Of the figures of a kind of result, by name; see the head of data/captions.md."""
    text = (files("rr_opt") / "data" / "captions.md").read_text(encoding="utf-8")
    own = text.partition(f"\n# {kind}\n")[2].partition("\n# ")[0]
    found = {}
    for part in own.split("\n## ")[1:]:
        head, alt, *caption = (" ".join(one.split()) for one in part.strip().split("\n\n"))
        name, _, title = head.partition(": ")
        found[name] = (title, alt, " ".join(caption))
    return found
