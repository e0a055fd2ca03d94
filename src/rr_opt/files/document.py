"""A file as read: its data, and where each value stands in it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from rr_opt.files.issue import Issue, Level, shown

Path = tuple[str | int, ...]
"""The keys and list indices that lead to a value."""

_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_-]{0,59}")


def path_text(path: Path) -> str:
    """A path as messages write it: `physics[0].force1`."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            text += "." * bool(text) + (part if _WORD.fullmatch(part) else shown(part))
    return text


@dataclass(frozen=True)
class Document:
    """A mapping of a file: the whole of it, or the section at `prefix`.

    file   the file as the user named it
    data   the mapping
    lines  line of each key, by its path in the file
    """

    file: str
    data: dict[str, Any]
    lines: Mapping[Path, int]
    prefix: Path = ()

    def section(self, key: str) -> Document:
        """The mapping under a key, which keeps its place in the file."""
        return replace(self, data=self.data[key], prefix=(*self.prefix, key))

    def without(self, *keys: str) -> Document:
        """The same without some keys."""
        return replace(self, data={k: v for k, v in self.data.items() if k not in keys})

    def issue(self, level: Level, path: Path, message: str) -> Issue:
        """An issue at a path below this mapping, with the line of the nearest key written.

        Where no lines are known it has none.
        """
        whole = (*self.prefix, *path)
        steps = (whole[:n] for n in range(len(whole), 0, -1))
        line = next(
            (self.lines[step] for step in steps if step in self.lines), 1 if self.lines else None
        )
        return Issue(level, path_text(whole), message, line, self.file)
