"""Rows of numbers from the lines of a text: fast where all is well, exact where it is not."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rr_opt.files.issue import shown
from rr_opt.recordings.refusal import refuse_all
from rr_opt.recordings.text import Text

Array = NDArray[np.float64]

_BLOCK = 20_000
"""Rows converted at once: no more than a few of their copies are in memory together."""


@dataclass(frozen=True)
class Table:
    """values (n, columns), NaN where a cell is empty; lines (n,), the rows' numbers in the file."""

    values: Array
    lines: NDArray[np.int64]
    doubts: tuple[str, ...]


@dataclass
class _Reading:
    """A table being read: what its rows looked like, and what is wrong with them."""

    separator: str
    names: Sequence[str]
    wrong: list[tuple[int, str]] = field(default_factory=list)
    short: list[int] = field(default_factory=list)


def read_table(text: Text, first: int, last: int, separator: str, names: Sequence[str]) -> Table:
    """The rows in text.lines[first:last], whose columns have these names.

    Cells are empty (missing), or numbers with a decimal point; with another separator than the
    comma, a decimal comma will do. Rows that hold nothing are passed over. Cells missing at a
    row's end are empty; what stands beyond the last column has to be. Raises InvalidFileError with
    line and column of every cell that is not a number.
    """
    reading = _Reading(separator, names)
    blank = separator + " \t"
    rows = [at for at in range(first, last) if text.lines[at].strip(blank)]
    cut = bool(rows) and not text.ended and rows[-1] == len(text.lines) - 1
    cut = cut and text.lines[rows[-1]].count(separator) < len(names) - 1
    doubts = []
    if cut:
        doubts.append(f"The file ends within line {rows.pop() + 1}, which was left out.")
    blocks = [
        _block(reading, [text.lines[at] for at in rows[start : start + _BLOCK]], rows[start:])
        for start in range(0, len(rows), _BLOCK)
    ]
    if reading.wrong:
        refuse_all(text.file, reading.wrong)
    values = np.concatenate(blocks) if blocks else np.empty((0, len(names)))
    lines = np.array(rows, np.int64) + 1
    if reading.short:
        doubts.append(
            f"{_rows_text(reading.short)} fewer cells than the header. What they lack was taken "
            "as missing."
        )
    endless = np.isinf(values)
    if endless.any():
        where = lines[endless.any(axis=1)].tolist()
        doubts.append(f"{_rows_text(where)} an infinite number, which was taken as missing.")
        values[endless] = np.nan
    return Table(values, lines, tuple(doubts))


def _rows_text(lines: Sequence[int]) -> str:
    if len(lines) == 1:
        return f"Line {lines[0]} has"
    return f"{len(lines)} lines, the first of them {lines[0]}, have"


def _block(reading: _Reading, lines: list[str], rows: list[int]) -> Array:
    """The numbers of some lines, whose indices in the file `rows` begins with."""
    separator, width = reading.separator, len(reading.names)
    if separator != ",":
        lines = [line.replace(",", ".") for line in lines]
    counts = [line.count(separator) for line in lines]
    for at, count in enumerate(counts):
        if count < width - 1:
            reading.short.append(rows[at] + 1)
            lines[at] += separator * (width - 1 - count)
        elif count > width - 1:
            beyond = lines[at].split(separator)[width:]
            if any(cell.strip() for cell in beyond):
                message = (
                    f"Read {count + 1} cells. Expected {width}, as the header has. Check them."
                )
                reading.wrong.append((rows[at] + 1, message))
            lines[at] = separator.join(lines[at].split(separator)[:width])
    whole = "\n".join(lines)
    for empty, filled in (
        (f"{separator}{separator}", f"{separator}nan{separator}"),
        (f"{separator}{separator}", f"{separator}nan{separator}"),
        (f"\n{separator}", f"\nnan{separator}"),
        (f"{separator}\n", f"{separator}nan\n"),
    ):
        whole = whole.replace(empty, filled)
    whole = f"{'nan' * whole.startswith(separator)}{whole}{'nan' * whole.endswith(separator)}"
    try:
        return np.loadtxt(io.StringIO(whole), delimiter=separator, comments=None, ndmin=2)
    except ValueError:
        return _one_by_one(reading, lines, rows)


def _one_by_one(reading: _Reading, lines: list[str], rows: list[int]) -> Array:
    """The same cell by cell, noting each that is not a number."""
    values = np.full((len(lines), len(reading.names)), np.nan)
    for at, line in enumerate(lines):
        for column, cell in enumerate(line.split(reading.separator)):
            number = cell.strip().strip('"').strip()
            if not number:
                continue
            try:
                if "_" in number or not number.isascii():
                    raise ValueError
                values[at, column] = float(number)
            except ValueError:
                name = reading.names[column]
                called = f"column {column + 1}" + (f" ({name})" if name else "")
                message = (
                    f"Read {shown(number)} in {called}. Expected a number, or nothing where none "
                    "was measured. Correct it, or empty the cell."
                )
                reading.wrong.append((rows[at] + 1, message))
    return values
