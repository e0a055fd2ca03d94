"""The calibration as text for a terminal."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from textwrap import wrap

from rr_opt.paper.calibration.calibrate import Calibration
from rr_opt.paper.calibration.intervals import intervals
from rr_opt.paper.calibration.measured import COLUMNS
from rr_opt.report.calibration.span import span
from rr_opt.report.calibration.told import box, profile_span, shipped_text, valley
from rr_opt.report.calibration.words import (
    IF_MEASURED,
    aicc_text,
    charges,
    conclusions,
    predicted,
    verdict,
)
from rr_opt.report.text import columns

_WIDTH = 98


def summary(found: Calibration, files: Iterable[Path]) -> str:
    """The unknowns, the models, what follows, and the files."""
    blocks = [[verdict(found) + "."]]
    for column in COLUMNS:
        blocks.append([f"unknowns, viscous friction, {IF_MEASURED[column]}"])
        rows: list[tuple[str, ...]] = [("", "box", "95 % posterior", "95 % profile", "")]
        for one in intervals(found):
            if one.column == column:
                profile = profile_span(one, one.profile)
                rows.append(
                    (f"  {one.unknown.symbol}", box(one.unknown),
                     span(one.unknown, one.posterior), profile, one.word)
                )  # fmt: skip
        blocks[-1] += columns(rows)
        blocks[-1] += wrap(valley(found, column), _WIDTH)
    blocks.append(_models(found))
    for sentence in (*conclusions(found), *(shipped_text(found, column) for column in COLUMNS)):
        blocks.append(wrap(sentence, _WIDTH))
    blocks.append(columns([("files" if not i else "", str(file)) for i, file in enumerate(files)]))
    return "\n\n".join("\n".join(block) for block in blocks) + "\n"


def _models(found: Calibration) -> list[str]:
    rows: list[tuple[str, ...]] = [
        ("models", "measured", "unknowns", "deviance", "chi-square", "AICc", "rows left out")
    ]
    for (name, column), held in found.held.items():
        rows.append(
            (
                f"  {name}",
                "first" if column == "mean" else "v_exp",
                str(len(held.model.unknowns)),
                f"{held.student.deviance:.1f}",
                f"{held.normal.deviance:.1f}",
                aicc_text(charges(held)["student"]),
                f"{predicted(held):.0f}",
            )
        )
    return columns(rows)
