"""The CSV of Vicon Nexus and Tracker: sections, each with its own rate.

`Trajectories` has the markers. Without them `Objects`, or else `Segments`, have the poses of rigid
bodies: a rotation vector RX, RY, RZ, or with RW a quaternion, and a place TX, TY, TZ. A section has
five lines of header: its title; its rate, Hz; the names, each above the first of its columns;
`Frame,Sub Frame,X,Y,Z,...`; the units. It ends with a blank line.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rr_opt.files.issue import refuse
from rr_opt.messages import shown
from rr_opt.recordings.readers.marker_rows import (
    MarkerData,
    frames_of,
    marker_data,
    matrices,
    rate_in,
)
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
    """rate in Hz; each marker's name and the column of its X; the index of the first row's line.

    turn   how many columns before its X a body's rotation has; 0 of markers
    angle  the rotation's unit, rad
    """

    separator: str
    rate: float
    roles: tuple[str, ...]
    markers: tuple[tuple[str, int], ...]
    unit: str
    first_row: int
    turn: int
    angle: float


def read_head(text: Text, start: int) -> Head:
    """The five lines of header. Raises InvalidFileError, which says what each should hold."""
    if len(text.lines) < start + 6:
        refuse(
            text.file,
            "The file ends within the header of the section. Expected its rate, the names, the "
            "columns, the units and the rows. Export it again.",
            len(text.lines),
        )
    rate_line, name_line, role_line, unit_line = text.lines[start + 1 : start + 5]
    separator = separator_of(role_line)
    roles = [cell.casefold() for cell in cells_of(role_line, separator)]
    if "frame" not in roles:
        refuse(
            text.file,
            f"Read {shown(role_line)}. Expected the row `Frame,Sub Frame,X,Y,Z,...`. Export it "
            "again.",
            start + 4,
        )
    while roles and not roles[-1]:
        roles.pop()
    names, units = cells_of(name_line, separator), cells_of(unit_line, separator)
    turn, places = next(
        (turn, found)
        for turn, columns in _COLUMNS.items()
        if (found := _begins(roles, columns)) or turn == 3
    )
    if not places:
        refuse(
            text.file,
            "Read no columns `X,Y,Z`. Expected three for each marker. Export the trajectories.",
            start + 4,
        )
    units += [""] * (len(roles) - len(units))
    found = {units[at] for at in places}
    if len(found) > 1:
        refuse(
            text.file,
            f"Read the units {shown(', '.join(sorted(found)))}. Expected one for all markers. "
            "Export them in one unit.",
            start + 5,
        )
    names += [""] * (len(roles) - len(names))
    markers = tuple((names[at - turn], at) for at in places)
    angle = math.radians(1) if units[places[0] - 1].startswith("deg") else 1.0
    rate = rate_in(cells_of(rate_line, separator)[0], "in column 1", text.file, start + 2)
    return Head(
        separator, rate, tuple(roles), markers, found.pop(), start + 5, turn, angle if turn else 1.0
    )


def _begins(roles: list[str], columns: str) -> list[int]:
    """Where the positions begin at the end of each run of these columns."""
    wanted = columns.split()
    starts = range(len(roles) - len(wanted) + 1)
    return [at + len(wanted) - 3 for at in starts if roles[at : at + len(wanted)] == wanted]


_COLUMNS = {0: "x y z", 4: "rx ry rz rw tx ty tz", 3: "rx ry rz tx ty tz"}
"""By the columns of a rotation, those of a marker or of a body."""
_TITLES = ("trajectories", "objects", "segments")
_SECTIONS = (*_TITLES, "devices", "model outputs", "joints", "trajectory count", "events")


def sniff(text: Text, _: ReadOptions) -> bool:
    """Whether the file has a line that is the title of a section, and no more than that."""
    return any(_title(line) in _SECTIONS for line in text.lines[:50]) or _start(text) is not None


def read(file: str, text: Text, _: ReadOptions) -> MarkerData:
    """The markers, or the rigid bodies, of a CSV of Vicon. Raises InvalidFileError."""
    start = _start(text)
    if start is None:
        there = [line for line in text.lines[:50] if _title(line) in _SECTIONS]
        refuse(
            text.file,
            f"Read the section {shown(_title(there[0]))} and no `Trajectories`, `Objects` or "
            "`Segments`. Expected markers or rigid bodies. Export the trajectories too.",
        )
    head = read_head(text, start)
    last = _end(text, head.first_row, head.separator)
    owner = {
        at + axis: f" of {one}" for one, at in head.markers if one for axis in range(-head.turn, 3)
    }
    names = [f"{role}{owner.get(at, '')}" for at, role in enumerate(head.roles)]
    table = read_table(text, head.first_row, last, head.separator, names)
    labels = [marker for marker, _ in head.markers]
    frame = frames_of(table, head.roles.index("frame"), file, head.first_row)
    turned = None
    if head.turn:
        turned = np.stack([table.values[:, at - head.turn : at] for _, at in head.markers], axis=1)
        turned = matrices(turned if head.turn == 4 else head.angle * turned, "vector")
        short = [label.rpartition(":")[2] for label in labels]  # `Subject:Segment`
        labels = short if len(set(short)) == len(short) else labels
    return marker_data(
        {"file": file, "format": READER.format, "encoding": text.encoding},
        frame=frame,
        lines=table.lines,
        t=None,
        rate=head.rate,
        labels=labels,
        positions=np.stack([table.values[:, at : at + 3] for _, at in head.markers], axis=1),
        rotations=turned,
        unit=head.unit,
        unit_place=("the row of units", head.first_row),
        doubts=[*table.doubts, *_unread(text, start, last, head)],
    )


def _title(line: str) -> str:
    return line.strip(',;\t "').casefold()


def _start(text: Text) -> int | None:
    """The index of the line that begins the section."""
    found = [
        (_TITLES.index(title), at)
        for at, line in enumerate(text.lines)
        if not line[:1].isdigit() and (title := _title(line)) in _TITLES
    ]
    return min(found)[1] if found else None


def _end(text: Text, first: int, separator: str) -> int:
    """The index after the last row: a blank line ends a section, and so does a title."""
    blank = separator + " \t"
    for at in range(first, len(text.lines)):
        line = text.lines[at]
        # Rows begin with a number, which is cheaper to check than whether the line is blank.
        if not line[:1].isdigit() and (not line.strip(blank) or _title(line) in _SECTIONS):
            return at
    return len(text.lines)


def _unread(text: Text, start: int, last: int, head: Head) -> Iterator[Notice]:
    """What the file holds besides."""
    columns = _COLUMNS[head.turn].split()
    taken = len(columns) * len(head.markers)
    known = ("frame", "sub frame", "", *columns)
    other = [role for role in head.roles if role not in known]
    if len(head.roles) - taken > 2 and other:
        yield notice("file.columns", names=shown(", ".join(dict.fromkeys(other))))
    outside = [*range(start), *range(last, len(text.lines))]
    titles = [_title(text.lines[at]) for at in outside if text.lines[at][:1].isalpha()]
    others = [one for one in titles if one in _SECTIONS]
    if others:
        yield notice("file.sections", names=", ".join(dict.fromkeys(others)))


READER = Reader("Vicon CSV", sniff, read)
