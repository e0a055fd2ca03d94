"""The calibration as a document."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rr_opt.documents.document import Badge, Document, Figure, Gallery, Section, Table, Tone, table
from rr_opt.documents.prose import prose
from rr_opt.documents.report import Report
from rr_opt.formatting import number
from rr_opt.version import __version__
from rr_paper.calibration.models import DRY, MODELS, READINGS, VISCOUS
from rr_paper.calibration.profiles import JOINT_LEVEL
from rr_paper.calibration.result import Calibration
from rr_paper.calibration.unknowns import UNKNOWNS
from rr_paper.publication import CITATION, COLUMNS, T_POINT, Column
from rr_paper.report.calibration_record import record, tables
from rr_paper.report.captions import captions

_SHORT: dict[Column, str] = {"mean": "first column", "other": "v_exp"}
_TONES: dict[str, Tone] = {"pinned down": "good", "narrowed": "note", "not identifiable": "warn"}


@dataclass(frozen=True)
class Conclusions:
    """The comparison in a headline, what follows from it, what the rows determine instead of single
    values, and whether the shipped robot's values are inside."""

    verdict: str
    follows: tuple[str, ...]
    valleys: tuple[str, ...]
    shipped: tuple[str, ...]


def conclusions(found: Calibration) -> Conclusions:
    """What the numbers say."""
    left_out = {key: one.left_out_deviance for key, one in found.assessments.items()}
    helps = all(left_out[DRY, column] < left_out[VISCOUS, column] for column in COLUMNS)
    verdict = (
        "Viscous friction alone fits badly, dry friction helps; nine averages prove neither"
        if helps
        else "The nine averages cannot distinguish the models"
    )
    texts = prose(
        "rr_paper.report",
        "calibration.md",
        found=found,
        unknowns=UNKNOWNS,
        readings=READINGS,
        joint_level=JOINT_LEVEL,
    )
    parts = (texts[key].paragraphs for key in ("conclusions", "valleys", "shipped"))
    return Conclusions(verdict, *parts)


def document(found: Calibration, figures: Sequence[Figure]) -> Document:
    """The page and the text for a terminal."""
    drawn = {figure.name: figure for figure in figures}
    said = conclusions(found)

    def gallery(name: str) -> Section:
        return Section("", (Gallery((drawn[name],) if drawn else (), wide=True),))

    return Document(
        "",
        "calibration of the paper's prototype",
        said.verdict,
        f"Estimated from the nine measured averages of {CITATION}. Each interval there comes from "
        f"three runs: half its width is {T_POINT:.2f} standard errors, and a row follows Student's "
        "t with 2 degrees of freedom, not the normal distribution.",
        (
            gallery("unknowns"),
            Section("95 % intervals, viscous friction", (_interval_table(found), *said.valleys)),
            gallery("predictions"),
            Section("Models", (_model_table(found),)),
            Section("What follows, and what does not", (*said.follows, *said.shipped)),
            gallery("coverage"),
            Section("The boxes, and the reasons for them", (_box_table(),), brief=False),
            Section("Other readings of J20/J10", (_reading_table(found),), brief=False),
        ),
        footer=(*_sampling(found), f"rr-opt {__version__}"),
    )


def _interval_table(found: Calibration) -> Table:
    head = ("Unknown", "Measured", "Box", "Posterior", "Profile, Student", "Profile, normal",
            "Verdict")  # fmt: skip
    return table(
        head,
        [
            (one.unknown.symbol, _SHORT[one.column], one.unknown.box_text,
             one.unknown.span(one.posterior), one.profile_text(one.profile),
             one.profile_text(one.normal), Badge(one.verdict, _TONES[one.verdict]))
            for one in found.intervals()
        ],
    )  # fmt: skip


def _model_table(found: Calibration) -> Table:
    head = ("Model", "Measured", "Unknowns", "Deviance", "χ², normal", "Degrees of freedom", "AICc",
            "Rows left out", "Table 3 alone: AICc")  # fmt: skip
    return table(
        head,
        [
            (one.model.words, _SHORT[column], len(one.model.unknowns),
             f"{one.student.deviance:.1f}", f"{one.normal.deviance:.1f}", one.aicc.freedom,
             str(one.aicc), f"{one.left_out_deviance:.0f}", str(one.aicc_table3))
            for (_, column), one in found.assessments.items()
        ],
    )  # fmt: skip


def _box_table() -> Table:
    return table(
        ("Unknown", "Box", "Why"),
        [
            (
                f"{one.symbol}: {one.words}",
                one.box_text + (", flat in its logarithm" * one.log),
                one.why,
            )
            for one in UNKNOWNS.values()
        ],
    )


def _reading_table(found: Calibration) -> Table:
    deviance = {
        (READINGS[0], name, column): one.student.deviance
        for (name, column), one in found.assessments.items()
    }
    deviance |= {
        (one.reading, one.model.name, one.column): one.student.deviance
        for one in found.alternatives
    }
    return table(
        ("J20/J10", "Model", "Deviance, first column", "Deviance, v_exp"),
        [
            (reading.words, MODELS[name].words,
             *(f"{deviance[reading, name, column]:.1f}" for column in COLUMNS))
            for name in (VISCOUS, DRY)
            for reading in READINGS
        ],
    )  # fmt: skip


def _sampling(found: Calibration) -> tuple[str, str]:
    samples = ", ".join(
        f"{len(one.points)} draws with split R-hat {one.rhat:.2f} ({_SHORT[column]})"
        for column, one in found.posterior.items()
    )
    needed = ", ".join(number(float(rise), 2) for rise in found.coverage.needed)
    return (
        f"Posteriors: {samples}",
        f"Rises of the deviance that 95 % of the truths of {found.coverage.sets} simulated data "
        f"sets stay below, in the order of the unknowns: {needed}",
    )


def _record(found: Calibration) -> dict[str, Any]:
    said = conclusions(found)
    return record(found, said.verdict, said.follows)


REPORT = Report(
    _record,
    document,
    "calibration.json",
    tables=tables,
    others=(
        *("intervals.csv", "models.csv", "predictions.csv", "profiles.csv", "posterior.csv"),
        *("readings.csv", "coverage.csv"),
    ),
    figures="rr_paper.report.calibration_figures",
    captions=captions("calibration"),
)
