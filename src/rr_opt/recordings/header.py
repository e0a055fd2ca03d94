"""The header row of a table: where it is, what separates its cells, and which columns it names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rr_opt.files.issue import nearest, shown
from rr_opt.recordings.refusal import refuse
from rr_opt.recordings.text import Text

SEPARATORS = ("\t", ";", ",")


@dataclass(frozen=True)
class Header:
    """The names of the columns, in small letters, as the line with index `at` has them."""

    at: int
    separator: str
    names: tuple[str, ...]


def separator_of(line: str) -> str:
    """What separates the cells of a line: a tab, a semicolon, or else a comma."""
    return max(SEPARATORS, key=line.count) if any(one in line for one in SEPARATORS) else ","


def cells_of(line: str, separator: str) -> list[str]:
    """The cells of a line without blanks and quotes about them."""
    return [cell.strip().strip('"').strip() for cell in line.split(separator)]


def find_header(text: Text) -> Header | None:
    """The first line that says something and is no remark; None if the file has none.

    A remark begins with #; a header row may too, if it has a column `t`.
    """
    for at, line in enumerate(text.lines):
        if not line.strip():
            continue
        bare = line.strip().lstrip("#").strip()
        separator = separator_of(bare)
        names = [cell.casefold() for cell in cells_of(bare, separator)]
        if line.lstrip().startswith("#") and "t" not in names:
            continue
        while names and not names[-1]:
            names.pop()
        return Header(at, separator, tuple(names))
    return None


def check_columns(
    header: Header, needed: Sequence[str], known: Sequence[str], file: str
) -> dict[str, int]:
    """Where each known column is. Raises InvalidFileError if one is missing or there twice."""
    line = header.at + 1
    if header.names and all(_is_number(name) for name in header.names):
        refuse(
            file,
            f"Read numbers in the first row. Expected a header row, `{','.join(needed)}`. "
            "Write it above the numbers.",
            line,
        )
    twice = [name for name in known if header.names.count(name) > 1]
    missing = [name for name in needed if name not in header.names]
    wrong = []
    if "t" in missing and "time" in header.names:
        refuse(file, "Read the column `time`. Expected `t`, in s. Rename it.", line)
    if twice:
        wrong.append(f"Read the column `{twice[0]}` twice. Expected it once. Delete one of them.")
    if missing:
        others = [name for name in header.names if name not in known]
        near = {name: nearest(name, missing) for name in others}
        guesses = [f"`{meant}` for {shown(name)}" for name, meant in near.items() if meant]
        advice = f"Did you mean {', '.join(guesses)}?" if guesses else "Add what is missing."
        # A letter alone is like no other: the columns that there are tell more.
        wrong.append(
            f"Read the columns {shown(', '.join(header.names))}. Expected also "
            f"{', '.join(f'`{name}`' for name in missing)}. {advice}"
        )
    if wrong:
        refuse(file, " ".join(wrong), line)
    return {name: header.names.index(name) for name in known if name in header.names}


def _is_number(cell: str) -> bool:
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return False
    return True
