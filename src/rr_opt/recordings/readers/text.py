"""Shared by readers: the bytes of a file, its lines in any encoding, and its columns."""

import codecs
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.files.issue import MOST_COUNTED, MOST_LISTED, refuse, refuse_all
from rr_opt.messages import shown
from rr_opt.model.experiment import Column, CountScale, Noise
from rr_opt.recordings.warnings import Notice, notice


@dataclass(frozen=True)
class ReadOptions:
    """What the files of recordings do not state themselves.

    noise    standard deviations of motion that states none; None: they are NaN
    counts   what the counts of a servo's log mean
    columns  by channel, the column that it is in, where a text file names it otherwise
    log      read the file as the servo's log, if it holds one besides other data
    """

    noise: Noise | None = None
    counts: CountScale = field(default_factory=CountScale)
    columns: Mapping[str, Column] = field(default_factory=dict)
    log: bool = False


@dataclass(frozen=True)
class Reader:
    """A format.

    sniff   whether content has this format: bytes if it is binary, else Text and the options
    read    the data of a file, from its name, its content and the options. Raises InvalidFileError
    binary  whether it is no text
    """

    format: str
    sniff: Callable[..., bool]
    read: Callable[[str, Any, ReadOptions], Any]
    binary: bool = False


_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
"""Byte order marks; that of UTF-32 begins with that of UTF-16, so it is looked for first."""

_BLOCK = 4096


@dataclass(frozen=True)
class Text:
    """A text file.

    file   as the user named it
    lines  without their ends; the first has the number 1 in messages
    ended  whether the last line that holds something has a line end
    """

    file: str
    encoding: str
    lines: list[str]
    ended: bool


def decode(content: bytes, file: str) -> Text:
    """The text of a file: UTF-8 or UTF-16 with or without a mark, or Latin-1.

    Raises InvalidFileError for what is no text.
    """
    encoding = _encoding(content)
    try:
        text = content.decode(encoding)
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        refuse(file, f"The text is not {encoding.upper()}. Save the file as UTF-8.", line)
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        refuse(
            file,
            "Read a zero byte, which no text contains. Expected CSV, C3D, TRC or netCDF. The file "
            "may be damaged, or in another format: export it again.",
            line,
        )
    if "\r" in text:
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    return Text(file, encoding.removesuffix("-sig"), text.split("\n"), text.endswith("\n"))


def _encoding(content: bytes) -> str:
    for mark, encoding in _MARKS:
        if content.startswith(mark):
            return encoding
    head = content[:_BLOCK]
    # In UTF-16 every second byte of plain English and of numbers is 0.
    for start, encoding in ((1, "utf-16-le"), (0, "utf-16-be")):
        half = head[start::2]
        if len(half) > 4 and half.count(0) > 0.9 * len(half):
            return encoding
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8"


SEPARATORS = ("\t", ";", ",")


@dataclass(frozen=True)
class Header:
    """The names of the columns, in small letters, as the line with index `at` has them.

    cells: the same as written.
    """

    at: int
    separator: str
    names: tuple[str, ...]
    cells: tuple[str, ...]


def separator_of(line: str) -> str:
    """What separates the cells of a line: a tab, a semicolon, or else a comma."""
    return max(SEPARATORS, key=line.count) if any(one in line for one in SEPARATORS) else ","


def cells_of(line: str, separator: str) -> list[str]:
    """The cells of a line without blanks and quotes about them."""
    return [cell.strip().strip('"').strip() for cell in line.split(separator)]


_TIME = re.compile(r"t(\s*[\[(].*[\])])?")
"""The column `t`, with or without its unit: `t [ms]`."""


def find_header(text: Text) -> Header | None:
    """The first line that says something and is no remark; None if the file has none.

    A remark begins with #; a header row may too, if it has a column `t`.
    """
    for at, line in enumerate(text.lines):
        if not line.strip():
            continue
        bare = line.strip().lstrip("#").strip()
        separator = separator_of(bare)
        cells = cells_of(bare, separator)
        names = [cell.casefold() for cell in cells]
        if line.lstrip().startswith("#") and not any(map(_TIME.fullmatch, names)):
            continue
        while names and not names[-1]:
            names.pop()
        return Header(at, separator, tuple(names), tuple(cells[: len(names)]))
    return None


@dataclass(frozen=True)
class NumberTable:
    """values (n, columns), NaN where a cell is empty; lines (n,), the rows' numbers in the file."""

    values: Array
    lines: NDArray[np.int64]
    doubts: tuple[Notice, ...]


def read_table(
    text: Text, first: int, last: int, separator: str, names: Sequence[str | None]
) -> NumberTable:
    """The rows in text.lines[first:last], whose columns have these names; None: not a number.

    Cells are empty (missing), or numbers with a decimal point; with another separator than the
    comma, a decimal comma will do. Rows that hold nothing are passed over. Cells missing at a
    row's end are empty; what stands beyond the last column has to be. Raises InvalidFileError with
    line and column of every cell that is not a number.
    """
    blank, width = separator + " \t", len(names)
    rows = [at for at in range(first, last) if text.lines[at].strip(blank)]
    cut = bool(rows) and not text.ended and rows[-1] == len(text.lines) - 1
    cut = cut and text.lines[rows[-1]].count(separator) < width - 1
    doubts = [notice("file.cut", line=rows.pop() + 1)] if cut else []
    values = np.full((len(rows), width), np.nan)
    numbers = _numbers_alone([text.lines[at] for at in rows], separator) if rows else values
    told = numbers.shape == values.shape
    if told:
        values = numbers
    wrong: list[tuple[int, str]] = []
    mistakes = 0
    short: list[int] = []
    for row, at in enumerate([] if told else rows):
        line = text.lines[at]
        cells = (line if separator == "," else line.replace(",", ".")).split(separator)
        messages: list[str] = []
        if len(cells) < width:
            short.append(at + 1)
            cells += [""] * (width - len(cells))
        elif any(map(str.strip, cells[width:])):
            messages.append(
                f"Read {len(cells)} cells. Expected {width}, as the header has. Check them."
            )
        try:
            if "_" in line or not line.isascii():
                raise ValueError
            values[row] = [float(cell) if cell else np.nan for cell in cells[:width]]
        except ValueError:
            values[row], others = _one_by_one(cells, names)
            messages += others
        mistakes += len(messages)
        wrong += [(at + 1, message) for message in messages[: MOST_LISTED - len(wrong)]]
        # A file of another kind may have millions.
        if mistakes >= MOST_COUNTED:
            break
    if mistakes:
        refuse_all(text.file, wrong, mistakes)
    if short:
        doubts.append(notice("file.short", rows=_rows_text(short)))
    lines = np.array(rows, np.int64) + 1
    endless = np.isinf(values)
    if endless.any():
        doubts.append(notice("file.infinite", rows=_rows_text(lines[endless.any(axis=1)].tolist())))
        values[endless] = np.nan
    return NumberTable(values, lines, tuple(doubts))


def _numbers_alone(lines: Sequence[str], separator: str) -> Array:
    """The numbers (n, columns) of rows that hold nothing else; empty if some hold more, or less."""
    try:
        return np.loadtxt(lines, delimiter=separator, comments=None, ndmin=2)
    except ValueError:
        return np.empty((0, 0))


def _rows_text(lines: Sequence[int]) -> str:
    if len(lines) == 1:
        return f"Line {lines[0]} has"
    return f"{len(lines)} lines, the first of them {lines[0]}, have"


def _one_by_one(cells: Sequence[str], names: Sequence[str | None]) -> tuple[list[float], list[str]]:
    """The numbers of a row that holds quotes or blanks, and a message for each cell without one."""
    numbers, messages = [], []
    for column, (cell, name) in enumerate(zip(cells, names, strict=False), 1):
        number = cell.strip().strip('"').strip()
        numbers.append(np.nan)
        if not number or name is None:
            continue
        try:
            if "_" in number or not number.isascii():
                raise ValueError
            numbers[-1] = float(number)
        except ValueError:
            called = f"column {column}" + (f" ({name})" if name else "")
            messages.append(
                f"Read {shown(number)} in {called}. Expected a number, or nothing where none "
                "was measured. Correct it, or empty the cell."
            )
    return numbers, messages
