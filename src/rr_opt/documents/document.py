"""The model of a document: the content of a report, independent of how it is rendered.

A document has a verdict and sections; a section holds text, facts, tables, checks and figures.
`rendering` renders it for a terminal, as Markdown, and as a page. Where a text holds
`something in backticks`, it is a command, a key or a file name.

Prose with computed numbers in it, and the captions of figures, are kept in files. Prose is Markdown
with Jinja2 expressions: sections `# key: Title`, each of paragraphs. Filters write a number: `n(3)`
to three significant digits, `f(1)` to one decimal, `e` as a power of ten, `span` as a range.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from numpy.typing import NDArray

from rr_opt.formatting import number
from rr_opt.version import __version__

if TYPE_CHECKING:
    from jinja2 import Environment

Tone = Literal["good", "bad", "note", "warn", "quiet"]


@dataclass(frozen=True)
class Badge:
    """A word or two in a coloured frame."""

    text: str
    tone: Tone = "quiet"


@dataclass(frozen=True)
class Link:
    """A link to a file beside the page."""

    text: str
    target: str


Item = TypeVar("Item")
Cell = str | float | bool | Badge | Link | None
"""None: not applicable. Numbers are SI."""


@dataclass(frozen=True)
class Table:
    """Rows of cells below a heading for each column, with a note below them."""

    head: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    note: str = ""

    @property
    def records(self) -> list[dict[str, Any]]:
        """A dictionary for each row, by the headings; infinity and NaN are None."""
        return [dict(zip(self.head, map(_finite, row), strict=True)) for row in self.rows]

    def csv(self, digits: int = 12) -> str:
        """The table for scripts: headings, then rows, with empty cells for None."""
        return csv_text(self.head, self.rows, digits)

    def __bool__(self) -> bool:
        return bool(self.rows)


def table(head: Iterable[str], rows: Iterable[Sequence[Cell]], note: str = "") -> Table:
    """A table of any sequences."""
    return Table(tuple(head), tuple(map(tuple, rows)), note)


def table_of(
    items: Iterable[Item], columns: Mapping[str, Callable[[Item], Cell]], note: str = ""
) -> Table:
    """A row for each item; a column is its heading and what it shows of an item."""
    rows = (tuple(cell(item) for cell in columns.values()) for item in items)
    return Table(tuple(columns), tuple(rows), note)


def cell_text(cell: Cell) -> str:
    """A cell for people: a number to four digits, a dash for nothing."""
    if cell is None:
        return "–"
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    if isinstance(cell, int | float):
        return number(cell)
    return cell if isinstance(cell, str) else cell.text


def csv_text(names: Sequence[str], rows: Iterable[Sequence[Any]], digits: int = 9) -> str:
    """Rows as CSV under a header row: numbers to `digits` digits, empty for None and NaN."""
    # Every line end becomes "\n"; the CSV writer's own "\r\n" makes it quote cells with either.
    text = io.StringIO(newline=None)
    writer = csv.writer(text)
    writer.writerow(names)
    writer.writerows([_plain(cell, digits) for cell in row] for row in rows)
    return text.getvalue()


def csv_columns(names: Sequence[str], columns: Iterable[NDArray[Any]], digits: int = 9) -> str:
    """Columns of numbers as CSV, like `csv_text`."""
    return csv_text(names, zip(*(column.tolist() for column in columns), strict=True), digits)


def heading(name: str, unit: str) -> str:
    """The heading of a column of numbers: `speed [m/s]`; of plain numbers the name alone."""
    return f"{name} [{unit}]" if unit not in ("", "1") else name


_FORMULA = tuple("=+-@\t\r\n＝＋－＠")
"""Spreadsheets take a text that starts with one of these for a formula (OWASP, CSV injection): an
apostrophe is put before it."""


def _plain(cell: Any, digits: int) -> str:
    if cell is None or (isinstance(cell, float) and math.isnan(cell)):
        return ""
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    if isinstance(cell, float):
        return f"{cell:.{digits}g}"
    text = cell.text if isinstance(cell, Badge | Link) else str(cell)
    return f"'{text}" if isinstance(cell, str) and text.startswith(_FORMULA) else text


def _finite(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


@dataclass(frozen=True)
class Fact:
    """A value with its label and a detail: `(30 deg)`, `to the left`."""

    label: str
    value: str
    detail: str = ""

    @property
    def text(self) -> str:
        """Value and detail in a line."""
        if not self.detail:
            return self.value
        return f"{self.value}{' ' if self.detail.startswith('(') else ', '}{self.detail}"


@dataclass(frozen=True)
class Items:
    """A block of items; omitted if empty."""

    items: tuple[Any, ...]

    def __bool__(self) -> bool:
        return bool(self.items)


@dataclass(frozen=True)
class Facts(Items):
    """Facts one below another; large figures on a page if they are the key ones."""

    items: tuple[Fact, ...]
    key: bool = False


def facts(items: Iterable[Fact], *, key: bool = False) -> Facts:
    """Facts of any iterable."""
    return Facts(tuple(items), key)


@dataclass(frozen=True)
class Checks(Items):
    """Sentences, each with its outcome."""

    items: tuple[tuple[Literal["ok", "FAILED", "warning"], str], ...]


def checks(results: Iterable[tuple[bool, str]]) -> Checks:
    """What was checked: whether it passed, and the finding."""
    return Checks(tuple(("ok" if passed else "FAILED", finding) for passed, finding in results))


def warnings(sentences: Iterable[str]) -> Checks:
    """What may be wrong."""
    return Checks(tuple(("warning", sentence) for sentence in sentences))


@dataclass(frozen=True)
class Step:
    """A step of a chain; state sets its style: `fault`, `clear`, or anything else."""

    name: str
    state: str
    mark: str
    detail: str = ""


@dataclass(frozen=True)
class Chain(Items):
    """Steps that follow one another, side by side on a page."""

    items: tuple[Step, ...]


@dataclass(frozen=True)
class Figure:
    """A drawing.

    name     of its file, without the ending
    alt      what it shows, for those who cannot see it; not a repeat of the title
    caption  how to read it
    """

    name: str
    title: str
    svg: str
    alt: str
    caption: str = ""


Captions = Mapping[str, tuple[str, str, str]]
"""Title, alternative text and caption of figures by name."""


def captioned(captions: Captions, drawn: Mapping[str, str | tuple[str, str]]) -> tuple[Figure, ...]:
    """The figures that were drawn, in the order of the captions.

    drawn  by name, SVG texts, or pairs of an SVG text and a caption of its own
    """
    pairs = {name: (one, "") if isinstance(one, str) else one for name, one in drawn.items()}
    return tuple(
        Figure(name, title, pairs[name][0], alt, pairs[name][1] or caption)
        for name, (title, alt, caption) in captions.items()
        if name in pairs
    )


@dataclass(frozen=True)
class Gallery(Items):
    """Figures that flow in two columns where there is room; one below the other if `wide`."""

    items: tuple[Figure, ...]
    wide: bool = False


Block = str | Facts | Table | Checks | Chain | Gallery


@dataclass(frozen=True)
class Section:
    """Blocks under a title; `brief`: part of the summary on a terminal too."""

    title: str
    blocks: tuple[Block, ...]
    brief: bool = True


def section(title: str, *blocks: Block, brief: bool = True) -> Section:
    """A section of these blocks."""
    return Section(title, blocks, brief)


@dataclass(frozen=True)
class Document:
    """A report.

    name    of the input: the problem, the experiment
    kind    of report: `fastest gait`, `study`
    title   the outcome in a phrase
    lead    the outcome in a few sentences
    good    False if there is a cause for concern
    footer  versions, fingerprints
    machine what it is about
    """

    name: str
    kind: str
    title: str
    lead: str
    sections: tuple[Section, ...]
    good: bool = True
    footer: tuple[str, ...] = ()
    machine: str = "Roller Racer"

    @property
    def figures(self) -> tuple[Figure, ...]:
        """All figures, in order."""
        return tuple(
            figure
            for section in self.sections
            for block in section.blocks
            if isinstance(block, Gallery)
            for figure in block.items
        )


def versions(sha256: str) -> tuple[str, str]:
    """The footer of a report on an input with this fingerprint."""
    return f"rr-opt {__version__}", f"input SHA-256 `{sha256}`"


def gallery(figures: Iterable[Figure]) -> Section:
    """Figures as a section of the page; a terminal shows none."""
    return section("", Gallery(tuple(figures)), brief=False)


def facts_alone(items: Iterable[Fact], *blocks: Block) -> Document:
    """A report for a terminal only."""
    return Document("", "", "", "", tuple(section("", one) for one in (facts(items), *blocks)))


@dataclass(frozen=True)
class Prose:
    """A section: its title and its paragraphs."""

    title: str
    paragraphs: tuple[str, ...]


def templates(package: str, folder: str, *, autoescape: bool = False) -> Environment:
    """The templates in a folder of a package. Raises UndefinedError for a value that is missing."""
    # Imported here as few results need Jinja2.
    from jinja2 import Environment, PackageLoader, StrictUndefined

    return Environment(
        loader=PackageLoader(package, folder),
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
        autoescape=autoescape,
    )


def prose(package: str, name: str, **context: Any) -> dict[str, Prose]:
    """The sections of `texts/NAME` in a package, by key."""
    environment = templates(package, "texts")
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
    """Captions of the figures of a kind of result, by name; see the head of data/captions.md."""
    text = (files("rr_opt") / "data" / "captions.md").read_text(encoding="utf-8")
    own = text.partition(f"\n# {kind}\n")[2].partition("\n# ")[0]
    found = {}
    for part in own.split("\n## ")[1:]:
        head, alt, *caption = (" ".join(one.split()) for one in part.strip().split("\n\n"))
        name, _, title = head.partition(": ")
        found[name] = (title, alt, " ".join(caption))
    return found
