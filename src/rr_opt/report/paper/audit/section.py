"""A section of the audit: a finding, the sentences behind it, and a table of their numbers."""

from __future__ import annotations

from dataclasses import dataclass

Value = str | float | None


@dataclass(frozen=True)
class Section:
    """key names it in files; finding is one sentence; head and rows are the table.

    Rows hold plain values in SI, or in the unit that the head gives; None is left empty.
    """

    key: str
    title: str
    finding: str
    sentences: tuple[str, ...]
    head: tuple[str, ...]
    rows: tuple[tuple[Value, ...], ...]
