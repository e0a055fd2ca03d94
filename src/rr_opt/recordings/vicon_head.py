"""The five lines of header that a section of a Vicon Nexus CSV begins with."""

from __future__ import annotations

import math
from dataclasses import dataclass

from rr_opt.files.issue import shown
from rr_opt.recordings.header import cells_of, separator_of
from rr_opt.recordings.refusal import refuse
from rr_opt.recordings.text import Text


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
    rate = _rate(text, rate_line, separator, start + 2)
    return Head(separator, rate, tuple(roles), markers, found.pop(), start + 5)


def _rate(text: Text, line: str, separator: str, number: int) -> float:
    cell = cells_of(line, separator)[0]
    try:
        rate = float(cell.replace(",", "."))
    except ValueError:
        rate = math.nan
    if not 0 < rate < math.inf:
        refuse(
            text.file,
            f"Read {shown(cell)} in column 1. Expected the rate of the section, in Hz. "
            "Export it once more.",
            number,
        )
    return rate
