"""Docstrings as the site shows them: lines of a name, two spaces and its meaning become a list."""

from __future__ import annotations

import re
from typing import Any

from griffe import Extension, Object  # pyright: ignore[reportMissingImports]

FIELD = re.compile(r"(\S.*?) {2,}(\S.*)")


def listed(text: str) -> str:
    """The text of a docstring, as Markdown; a line that is indented goes on with a meaning."""
    return "\n\n".join(_paragraph(one) for one in re.split(r"\n{2,}", text))


def _paragraph(text: str) -> str:
    first, *others = text.splitlines() or [""]
    if not FIELD.fullmatch(first):
        return text
    fields = [FIELD.fullmatch(line) for line in (first, *others)]
    lines = zip((first, *others), fields, strict=True)
    return "\n".join(
        f"- `{found[1]}`: {found[2]}" if found and not line.startswith(" ") else line
        for line, found in lines
    )


class Fields(Extension):
    """Rewrites every docstring."""

    def on_object(self, *, obj: Object, **_: Any) -> None:
        """Called for each object once it is loaded."""
        if obj.docstring:
            obj.docstring.value = listed(obj.docstring.value)
