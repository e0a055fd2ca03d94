"""One case of a blind trial told by itself."""

from __future__ import annotations

from pathlib import Path

from rr_opt.proof.score.case import Case
from rr_opt.report.proof.words import hidden_text, said_text, visible_text
from rr_opt.report.text import columns


def told(case: Case, folder: Path) -> str:
    """What was hidden, what was said, and where everything is."""
    rows = [
        ("case", case.id),
        ("kind", case.truth.kind),
        ("engine", case.truth.engine),
        ("hidden", hidden_text(case)),
        ("visible", visible_text(case)),
        ("said", said_text(case)),
        ("outcome", case.outcome if case.scored else f"{case.outcome} (invisible, not counted)"),
        ("time", f"{case.wall:.0f} s, {case.cpu:.0f} s of CPU"),
        ("files", str(folder)),
    ]
    return "\n".join(columns([row for row in rows if row[1]])) + "\n"
