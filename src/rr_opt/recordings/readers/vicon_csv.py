"""The CSV of Vicon Nexus: sections, each with its own rate; `Trajectories` has the markers.

A section has five lines of header: its title; its rate, Hz; the names, each above the first of its
columns; `Frame,Sub Frame,X,Y,Z,...`; the units. It ends with a blank line.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rr_opt.files.issue import refuse
from rr_opt.messages import shown
from rr_opt.recordings.readers.marker_rows import MarkerData, frames_of, marker_data, rate_in
from rr_opt.recordings.readers.text import (
    Reader,
    ReadOptions,
    Text,
    cells_of,
    read_table,
    separator_of,
)
from rr_opt.recordings.warnings import Notice, notice


@dataclass(frozen=True)
class Head:
    """rate in Hz; each marker's name and the column of its X; the index of the first row's line."""

    separator: str
    rate: float
    roles: tuple[str, ...]
    markers: tuple[tuple[str, int], ...]
    unit: str
    first_row: int


def read_head(text: Text, start: int) -> Head:
    """The five lines of header. Raises InvalidFileError, which says what each should hold."""
    if len(text.lines) < start + 6:
        refuse(
            text.file,
            "The file ends within the header of `Trajectories`. Expected its rate, the names, the "
            "columns, the units and the rows. Export it once more.",
            len(text.lines),
        )
    rate_line, name_line, role_line, unit_line = text.lines[start + 1 : start + 5]
    separator = separator_of(role_line)
    roles = [cell.casefold() for cell in cells_of(role_line, separator)]
    if "frame" not in roles:
        refuse(
            text.file,
            f"Read {shown(role_line)}. Expected the row `Frame,Sub Frame,X,Y,Z,...`. "
            "Export it once more.",
            start + 4,
        )
    while roles and not roles[-1]:
        roles.pop()
    names, units = cells_of(name_line, separator), cells_of(unit_line, separator)
    places = [at for at in range(len(roles) - 2) if roles[at : at + 3] == ["x", "y", "z"]]
    if not places:
        refuse(
            text.file,
            "Read no columns `X,Y,Z`. Expected three for each marker. Export the trajectories.",
            start + 4,
        )
    found = {units[at] if at < len(units) else "" for at in places}
    if len(found) > 1:
        refuse(
            text.file,
            f"Read the units {shown(', '.join(sorted(found)))}. Expected one for all markers. "
            "Export them in one unit.",
            start + 5,
        )
    markers = tuple((names[at] if at < len(names) else "", at) for at in places)
    rate = rate_in(cells_of(rate_line, separator)[0], "in column 1", text.file, start + 2)
    return Head(separator, rate, tuple(roles), markers, found.pop(), start + 5)


_TITLE = "trajectories"
_SECTIONS = (_TITLE, "devices", "model outputs", "joints", "segments", "trajectory count", "events")


def sniff(text: Text, _: ReadOptions) -> bool:
    """Whether the file has a line that is the title of a section, and no more than that."""
    return any(_title(line) in _SECTIONS for line in text.lines[:50]) or _start(text) is not None


def read(file: str, text: Text, _: ReadOptions) -> MarkerData:
    """The markers of the section `Trajectories`. Raises InvalidFileError."""
    start = _start(text)
    if start is None:
        there = [line for line in text.lines[:50] if _title(line) in _SECTIONS]
        refuse(
            text.file,
            f"Read the section {shown(_title(there[0]))} and no `Trajectories`. Expected markers. "
            "Export the trajectories too.",
        )
    head = read_head(text, start)
    last = _end(text, head.first_row, head.separator)
    names = [f"{role} of {marker}" if marker else role for role, marker in _owners(head)]
    table = read_table(text, head.first_row, last, head.separator, names)
    return marker_data(
        {"file": file, "format": READER.format, "encoding": text.encoding},
        frame=frames_of(table, head.roles.index("frame"), file, head.first_row),
        lines=table.lines,
        t=None,
        rate=head.rate,
        labels=[marker for marker, _ in head.markers],
        positions=np.stack([table.values[:, at : at + 3] for _, at in head.markers], axis=1),
        unit=head.unit,
        unit_place=("the row of units", head.first_row),
        doubts=[*table.doubts, *_unread(text, start, last, head)],
    )


def _title(line: str) -> str:
    return line.strip(',;\t "').casefold()


def _start(text: Text) -> int | None:
    """The index of the line that begins the section."""
    return next((at for at, line in enumerate(text.lines) if _title(line) == _TITLE), None)


def _end(text: Text, first: int, separator: str) -> int:
    """The index after the last row: a blank line ends a section, and so does a title."""
    blank = separator + " \t"
    for at in range(first, len(text.lines)):
        line = text.lines[at]
        # Rows begin with a number, which is cheaper to see than that nothing follows.
        if not line[:1].isdigit() and (not line.strip(blank) or _title(line) in _SECTIONS):
            return at
    return len(text.lines)


def _owners(head: Head) -> list[tuple[str, str]]:
    """Each column's role and the marker it belongs to, for messages."""
    owner = {at + axis: marker for marker, at in head.markers for axis in range(3)}
    return [(role, owner.get(at, "")) for at, role in enumerate(head.roles)]


def _unread(text: Text, start: int, last: int, head: Head) -> Iterator[Notice]:
    """What the file holds besides."""
    taken = 3 * len(head.markers)
    other = [role for role in head.roles if role not in ("frame", "sub frame", "x", "y", "z", "")]
    if len(head.roles) - taken > 2 and other:
        yield notice("file.columns", names=shown(", ".join(dict.fromkeys(other))))
    outside = [*range(start), *range(last, len(text.lines))]
    titles = [_title(text.lines[at]) for at in outside if text.lines[at][:1].isalpha()]
    others = [one for one in titles if one in _SECTIONS]
    if others:
        yield notice("file.sections", names=", ".join(dict.fromkeys(others)))


READER = Reader("Vicon Nexus CSV", sniff, read)
