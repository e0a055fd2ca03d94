"""Tables as CSV text."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence


def csv_text(
    head: Sequence[str], rows: Iterable[Sequence[str | float | None]], digits: int = 9
) -> str:
    """Numbers with so many significant digits; a cell that is None is left empty."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(
        ["" if x is None else x if isinstance(x, str) else f"{x:.{digits}g}" for x in row]
        for row in rows
    )
    return text.getvalue()
