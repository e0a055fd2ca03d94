"""The model of a document: what a report holds, whatever it is rendered as.

A document has a verdict and sections; a section holds text, facts, tables, checks and figures.
`text` renders it for a terminal and as Markdown, `html` as a page. Where a text holds
`something in backticks`, it is a command, a key or a file name.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

from rr_opt.answers.quantities import number

Tone = Literal["good", "bad", "note", "warn", "quiet"]


@dataclass(frozen=True)
class Badge:
    """A word or two in a coloured frame."""

    text: str
    tone: Tone = "quiet"


@dataclass(frozen=True)
class Link:
    """A text that leads to a file beside the page."""

    text: str
    target: str


Cell = str | float | bool | Badge | Link | None
"""None: there is no such thing. Numbers are SI."""


@dataclass(frozen=True)
class Column:
    """A column of a table, for scripts by name and unit, for people by title and `shown`.

    unit     SI; "1" for plain numbers, empty for text
    shown    the unit for people, and how many of it are one SI unit; the SI unit if None
    digits   significant digits for people
    meaning  a phrase for files that carry one
    """

    name: str
    unit: str = ""
    title: str = ""
    shown: tuple[str, float] | None = None
    digits: int = 4
    meaning: str = ""

    @property
    def heading(self) -> str:
        """The title, with the unit for people."""
        unit = self.shown[0] if self.shown else self.unit
        title = self.title or self.name
        return f"{title}, {unit}" if unit not in ("", "1") else title

    def text(self, cell: Cell) -> str:
        """A cell for people: a number in the unit of the heading, a dash for nothing."""
        if cell is None:
            return "–"
        if isinstance(cell, bool):
            return "yes" if cell else "no"
        if isinstance(cell, int | float):
            return number(cell * (self.shown[1] if self.shown else 1.0), self.digits)
        return cell if isinstance(cell, str) else cell.text


@dataclass(frozen=True)
class Table:
    """Columns and rows, with a note below."""

    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    note: str = ""

    @property
    def records(self) -> list[dict[str, Any]]:
        """A dictionary for each row, by the names of the columns; infinity and NaN are None."""
        names = [column.name for column in self.columns]
        return [dict(zip(names, map(_finite, row), strict=True)) for row in self.rows]

    def csv(self, digits: int = 12) -> str:
        """The table for scripts: names, then rows, with empty cells where there is nothing."""
        return csv_text([column.name for column in self.columns], self.rows, digits)

    def select(self, names: Iterable[str], rows: Iterable[int] | None = None) -> Table:
        """The columns of these names, and the rows of these numbers; all rows if None."""
        all_names = [column.name for column in self.columns]
        places = [all_names.index(name) for name in names]
        chosen = self.rows if rows is None else [self.rows[k] for k in rows]
        return replace(
            self,
            columns=tuple(self.columns[k] for k in places),
            rows=tuple(tuple(row[k] for k in places) for row in chosen),
        )

    def __bool__(self) -> bool:
        return bool(self.rows)


def table(head: Sequence[str], rows: Iterable[Sequence[Cell]], note: str = "") -> Table:
    """A table for people alone, by its headings."""
    return Table(tuple(Column(title) for title in head), tuple(map(tuple, rows)), note)


def csv_text(names: Sequence[str], rows: Iterable[Sequence[Any]], digits: int = 9) -> str:
    """Rows as CSV under a header row: numbers with so many digits, nothing for None and NaN."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(names)
    writer.writerows([_plain(cell, digits) for cell in row] for row in rows)
    return text.getvalue()


_FORMULA = tuple("=+-@\t\r\n＝＋－＠")
"""Spreadsheets take a text that begins with one of these for a formula (OWASP, CSV injection): it
gets an apostrophe."""


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
    """A value with its label, and what else there is to say of it: `(30 deg)`, `to the left`."""

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
class Facts:
    """Facts below one another; as large figures on a page if they are the key ones."""

    items: tuple[Fact, ...]
    key: bool = False

    def __bool__(self) -> bool:
        return bool(self.items)


@dataclass(frozen=True)
class Checks:
    """Sentences, each with its outcome."""

    items: tuple[tuple[Literal["ok", "FAILED", "warning"], str], ...]

    def __bool__(self) -> bool:
        return bool(self.items)


def checks(results: Iterable[tuple[bool, str]]) -> Checks:
    """What was checked: whether it passed, and the finding."""
    return Checks(tuple(("ok" if passed else "FAILED", finding) for passed, finding in results))


def warnings(sentences: Iterable[str]) -> Checks:
    """What may be wrong."""
    return Checks(tuple(("warning", sentence) for sentence in sentences))


@dataclass(frozen=True)
class Step:
    """A step of a chain; state names its look: `fault`, `clear`, or anything else."""

    name: str
    state: str
    mark: str
    detail: str = ""


@dataclass(frozen=True)
class Chain:
    """Steps that follow one another, side by side on a page."""

    items: tuple[Step, ...]

    def __bool__(self) -> bool:
        return bool(self.items)


@dataclass(frozen=True)
class Figure:
    """A drawing.

    name     of its file, without the ending
    alt      what it shows, for those who cannot see it; not the title again
    caption  how to read it
    """

    name: str
    title: str
    svg: str
    alt: str
    caption: str = ""


@dataclass(frozen=True)
class Gallery:
    """Figures that flow in two columns where there is room; one below the other if `wide`."""

    items: tuple[Figure, ...]
    wide: bool = False

    def __bool__(self) -> bool:
        return bool(self.items)


Block = str | Facts | Table | Checks | Chain | Gallery


@dataclass(frozen=True)
class Section:
    """Blocks under a title; `brief`: part of the summary on a terminal too."""

    title: str
    blocks: tuple[Block, ...]
    brief: bool = True


@dataclass(frozen=True)
class Document:
    """A report.

    name    of what was asked: the problem, the experiment
    kind    of report: `fastest gait`, `study`
    title   the outcome in a phrase
    lead    the outcome in a few sentences
    good    False if there is something to worry about
    footer  versions, fingerprints
    """

    name: str
    kind: str
    title: str
    lead: str
    sections: tuple[Section, ...]
    good: bool = True
    footer: tuple[str, ...] = ()

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
