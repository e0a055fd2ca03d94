"""Everything that can be odd about a recording: one table of code, level, sentence and remedy.

The table is `data/warnings.txt`. A code is a kind, a dot and the problem. Sentences are format
strings; the caller gives the values, with lists and sizes as text.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Any, Literal, cast

import numpy as np
from numpy.typing import NDArray

Level = Literal["note", "warning", "error"]


@dataclass(frozen=True)
class Entry:
    """A row of the table.

    level     note: how it was read; warning: look at it; error: nothing can be fitted like this
    sentence  what was seen, and what was made of it
    remedy    what to do
    """

    level: Level
    sentence: str
    remedy: str = ""


def _read(table: str) -> dict[str, Entry]:
    """Rows of code, level, sentence and, after `=>`, remedy; an indented line continues a row."""
    found: dict[str, Entry] = {}
    for row in table.strip().replace("\n    ", " ").splitlines():
        code, level, text = row.split(None, 2)
        found[code] = Entry(cast(Level, level), *text.split(" => "))
    return found


TABLE = _read((files("rr_opt") / "data" / "warnings.txt").read_text(encoding="utf-8"))


class Notice(str):
    """A warning about a recording: the sentences, and the code of their entry in the table."""

    code: str

    def __new__(cls, text: str, code: str) -> Notice:
        """The sentences with their code."""
        made = super().__new__(cls, text)
        made.code = code
        return made

    def __reduce__(self) -> tuple[type[Notice], tuple[str, str]]:
        return Notice, (str(self), self.code)

    @property
    def kind(self) -> str:
        """The part of the code before its dot."""
        return self.code.partition(".")[0]

    @property
    def level(self) -> Level:
        """Of its entry."""
        return TABLE[self.code].level


def notice(code: str, **values: Any) -> Notice:
    """The notice with this code, its sentences filled with values."""
    entry = TABLE[code]
    return Notice(f"{entry.sentence} {entry.remedy}".format(**values).strip(), code)


_UNITS = {
    "x": (1e3, "mm"),
    "y": (1e3, "mm"),
    "psi": (1e3, "mrad"),
    "phi": (1e3, "mrad"),
    "torque": (1e3, "mN m"),
}


def size_text(channel: str, size: float) -> str:
    """A size of a channel, from SI, to three digits: `1.2 mm`, `1230 mm`."""
    factor, unit = _UNITS.get(channel, (1.0, ""))
    return f"{float(f'{factor * size:.3g}'):g} {unit}".strip()


def when(t: NDArray[np.float64], rows: Sequence[int] | NDArray[np.int_]) -> str:
    """`at t = 3.21 s`, or `between t = 3.21 s and 4.5 s`, of rows in order."""
    first, last = float(t[rows[0]]), float(t[rows[-1]])
    if len(rows) == 1:
        return f"at t = {first:.6g} s"
    return f"between t = {first:.6g} s and {last:.6g} s"
