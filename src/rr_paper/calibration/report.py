"""calibration.json and its CSV files."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rr_opt.documents import document as doc
from rr_opt.documents.document import prose
from rr_opt.files.record import plain
from rr_opt.formatting import number
from rr_opt.results.result import Result
from rr_opt.version import __version__
from rr_paper.calibration.comparison import Assessment
from rr_paper.calibration.fit import measured
from rr_paper.calibration.intervals import JOINT_LEVEL
from rr_paper.calibration.models import DRY, MODELS, READINGS, UNKNOWNS, VISCOUS, values
from rr_paper.calibration.result import Findings
from rr_paper.publication import CITATION, COLUMNS, ROWS, T_POINT, Column, Row, captions

_DRAWS = 1000
"""Draws of each posterior that are written."""


def record(found: Findings) -> dict[str, Any]:
    """The content of calibration.json."""
    covered = found.coverage
    record = {
        "verdict": verdict(found),
        "conclusions": conclusions(found)["conclusions"],
        "t_of_the_intervals": T_POINT,
        "reading": READINGS[0].words,
        "unknowns": [
            {"name": one.name, "unit": one.unit, "box": one.box,
             "flat_in": "logarithm" if one.log else "value", "why": one.why}
            for one in UNKNOWNS.values()
        ],
        "intervals": [
            {"unknown": one.unknown.name, "column": one.column, "posterior": one.posterior,
             "median": one.median, "profile_student": one.profile.ends(one.unknown),
             "profile_normal": one.normal.ends(one.unknown), "share_of_box": one.share,
             "verdict": one.verdict}
            for one in found.intervals()
        ],
        "models": [
            {"model": name, "column": column, "words": one.model.words, "best": _best(one),
             **_scores(one),
             "profiles": {
                 unknown: profile.ends(UNKNOWNS[unknown])
                 for unknown, profile in zip(one.model.profiled, one.profiles, strict=True)
             },
             "made": {"sets": one.bootstrap.sets, "as_bad": one.bootstrap.as_bad,
                      "gaining_as_much": one.bootstrap.gaining} if one.bootstrap else None}
            for (name, column), one in found.assessments.items()
        ],
        "posterior": {
            column: {"draws": len(one.points), "split_rhat": one.rhat,
                     "library_effective_points": one.library_weight}
            for column, one in found.posterior.items()
        },
        "shipped": {
            column: {"values": one.values, "rise": one.rise, "amplitude": one.amplitude}
            for column, one in found.shipped.items()
        },
        "coverage": {
            "sets": covered.sets,
            "unknowns": MODELS[VISCOUS].unknowns,
            "posterior": covered.posterior,
            "profile_student": covered.profile["student"],
            "profile_normal": covered.profile["normal"],
            "rise_needed": covered.needed,
        },
        "readings": [
            {"reading": one.reading.words, "model": one.model.name, "column": one.column,
             "deviance": one.student.deviance,
             "shipped_rise": one.shipped.rise if one.shipped else None}
            for one in found.alternatives
        ],
        "version": __version__,
    }  # fmt: skip
    return plain(record)


def _best(one: Assessment) -> dict[str, float]:
    """The unknowns of the best fit, SI."""
    best = values(one.model.unknowns, one.student.point[None])
    return {name: float(value[0]) for name, value in best.items()}


def _scores(one: Assessment) -> dict[str, float | None]:
    return {
        "deviance": one.student.deviance,
        "chi_square": one.normal.deviance,
        "degrees_of_freedom": one.aicc.freedom,
        "aicc": one.aicc.value,
        "aicc_normal": one.aicc_normal.value,
        "table3_deviance": one.table3.deviance,
        "table3_aicc": one.aicc_table3.value,
        "left_out_deviance": one.left_out_deviance,
    }


_Rows = list[dict[str, Any]]


def tables(found: Findings) -> dict[str, str]:
    """File name -> CSV text."""
    rows: dict[str, _Rows] = {
        "intervals.csv": _interval_rows(found),
        "models.csv": _model_rows(found),
        "predictions.csv": _prediction_rows(found),
        "profiles.csv": _profile_rows(found),
        "posterior.csv": _posterior_rows(found),
        "readings.csv": [
            {"about": one.reading.about, "by": one.reading.by,
             "spread": one.reading.spread if one.reading.by == "loads" else None,
             "model": one.model.name, "column": one.column, "deviance": one.student.deviance}
            for one in found.alternatives
        ],
        "coverage.csv": [
            {"unknown": name, "sets": found.coverage.sets,
             "posterior": found.coverage.posterior[i],
             "profile_student": found.coverage.profile["student"][i],
             "profile_normal": found.coverage.profile["normal"][i],
             "rise_needed": found.coverage.needed[i]}
            for i, name in enumerate(MODELS[VISCOUS].unknowns)
        ],
    }  # fmt: skip
    return {
        name: doc.csv_text(list(here[0]), (list(row.values()) for row in here), digits=6)
        for name, here in rows.items()
    }


def _interval_rows(found: Findings) -> _Rows:
    return [
        {"unknown": one.unknown.name, "unit": one.unknown.unit, "column": one.column,
         **_ends("box", one.unknown.box),
         "posterior_low": one.posterior[0], "posterior_median": one.median,
         "posterior_high": one.posterior[1],
         **_ends("profile", one.profile.ends(one.unknown)),
         **_ends("profile_normal", one.normal.ends(one.unknown)),
         "share_of_box": one.share, "verdict": one.verdict}
        for one in found.intervals()
    ]  # fmt: skip


def _ends(name: str, interval: tuple[float, float]) -> dict[str, float]:
    return {f"{name}_low": interval[0], f"{name}_high": interval[1]}


def _model_rows(found: Findings) -> _Rows:
    rows = []
    for (name, column), one in found.assessments.items():
        boot, best = one.bootstrap, _best(one)
        rows.append(
            {"model": name, "column": column, "unknowns": len(one.model.unknowns), **_scores(one),
             "sets_made": boot.sets if boot else None,
             "sets_as_bad": boot.as_bad if boot else None,
             "sets_gaining_as_much": boot.gaining if boot else None,
             **{f"best_{unknown}": best.get(unknown) for unknown in UNKNOWNS}}
        )  # fmt: skip
    return rows


def _prediction_rows(found: Findings) -> _Rows:
    rows = []
    for (name, column), one in found.assessments.items():
        data = measured(column)
        z = one.student.z(data)
        for i, row in enumerate(ROWS):
            rows.append(
                {"model": name, "column": column, "row": _label(row), "ratio": row.ratio,
                 "period": row.period, "amplitude": row.amplitude, "measured": data.speed[i],
                 "half_width": row.half_width, "standard_error": data.error[i],
                 "predicted": one.student.speeds[i], "z": z[i], "z_left_out": one.left_out[i]}
            )  # fmt: skip
    return rows


def _label(row: Row) -> str:
    if row.amplitude is None:
        return f"Table 2, ratio {row.ratio:g}"
    return f"Table 3, T = {row.period:g} s, α = {row.amplitude:g}"


def _profile_rows(found: Findings) -> _Rows:
    rows = []
    for (name, column), one in found.assessments.items():
        profiles = {"student": one.profiles}
        if name == VISCOUS:
            profiles["normal"] = found.normal_profiles[column]
        for law, of in profiles.items():
            for unknown, profile in zip(one.model.profiled, of, strict=True):
                at = UNKNOWNS[unknown].value(profile.grid)
                rows += [
                    {"model": name, "column": column, "law": law, "unknown": unknown, "value": x,
                     "rise": rise}
                    for x, rise in zip(at, profile.rise, strict=True)
                ]  # fmt: skip
    return rows


def _posterior_rows(found: Findings) -> _Rows:
    rows = []
    for column, sample in found.posterior.items():
        chosen = np.linspace(0, len(sample.points) - 1, _DRAWS).astype(int)
        at = values(MODELS[VISCOUS].unknowns, sample.points[chosen])
        at["deviance"] = sample.deviance[chosen]
        rows += [
            {"column": column, **{name: of[i] for name, of in at.items()}} for i in range(_DRAWS)
        ]
    return rows


_SHORT: dict[Column, str] = {"mean": "first column", "other": "v_exp"}
_TONES: dict[str, doc.Tone] = {
    "pinned down": "good",
    "narrowed": "note",
    "not identifiable": "warn",
}


def verdict(found: Findings) -> str:
    """The comparison of the models in a headline."""
    left_out = {key: one.left_out_deviance for key, one in found.assessments.items()}
    if all(left_out[DRY, column] < left_out[VISCOUS, column] for column in COLUMNS):
        return "Viscous friction alone fits badly, dry friction helps; nine averages prove neither"
    return "The nine averages cannot distinguish the models"


def conclusions(found: Findings) -> dict[str, tuple[str, ...]]:
    """Conclusions (`conclusions`), the combinations that the rows determine instead of single
    values (`valleys`), and whether the shipped robot's values are inside (`shipped`)."""
    texts = prose(
        "rr_paper",
        "calibration.md",
        found=found,
        unknowns=UNKNOWNS,
        readings=READINGS,
        joint_level=JOINT_LEVEL,
    )
    return {key: one.paragraphs for key, one in texts.items()}


def document(found: Findings, figures: Sequence[doc.Figure]) -> doc.Document:
    """The page and the text for a terminal."""
    drawn = {figure.name: figure for figure in figures}
    said = conclusions(found)

    def gallery(name: str) -> doc.Section:
        return doc.Section("", (doc.Gallery((drawn[name],) if drawn else (), wide=True),))

    return doc.Document(
        "",
        "calibration of the paper's prototype",
        verdict(found),
        f"Estimated from the nine measured averages of {CITATION}. Each interval there comes from "
        f"three runs: half its width is {T_POINT:.2f} standard errors, and a row follows Student's "
        "t with 2 degrees of freedom, not the normal distribution.",
        (
            gallery("unknowns"),
            doc.Section(
                "95 % intervals, viscous friction", (_interval_table(found), *said["valleys"])
            ),
            gallery("predictions"),
            doc.Section("Models", (_model_table(found),)),
            doc.Section(
                "What follows, and what does not", (*said["conclusions"], *said["shipped"])
            ),
            gallery("coverage"),
            doc.Section("The boxes, and the reasons for them", (_box_table(),), brief=False),
            doc.Section("Other readings of J20/J10", (_reading_table(found),), brief=False),
        ),
        footer=(*_sampling(found), f"rr-opt {__version__}"),
    )


def _interval_table(found: Findings) -> doc.Table:
    head = ("Unknown", "Measured", "Box", "Posterior", "Profile, Student", "Profile, normal",
            "Verdict")  # fmt: skip
    return doc.table(
        head,
        [
            (one.unknown.symbol, _SHORT[one.column], one.unknown.box_text,
             one.unknown.span(one.posterior), one.profile_text(one.profile),
             one.profile_text(one.normal), doc.Badge(one.verdict, _TONES[one.verdict]))
            for one in found.intervals()
        ],
    )  # fmt: skip


def _model_table(found: Findings) -> doc.Table:
    head = ("Model", "Measured", "Unknowns", "Deviance", "χ², normal", "Degrees of freedom", "AICc",
            "Rows left out", "Table 3 alone: AICc")  # fmt: skip
    return doc.table(
        head,
        [
            (one.model.words, _SHORT[column], len(one.model.unknowns),
             f"{one.student.deviance:.1f}", f"{one.normal.deviance:.1f}", one.aicc.freedom,
             str(one.aicc), f"{one.left_out_deviance:.0f}", str(one.aicc_table3))
            for (_, column), one in found.assessments.items()
        ],
    )  # fmt: skip


def _box_table() -> doc.Table:
    return doc.table(
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


def _reading_table(found: Findings) -> doc.Table:
    deviance = {
        (READINGS[0], name, column): one.student.deviance
        for (name, column), one in found.assessments.items()
    }
    deviance |= {
        (one.reading, one.model.name, one.column): one.student.deviance
        for one in found.alternatives
    }
    return doc.table(
        ("J20/J10", "Model", "Deviance, first column", "Deviance, v_exp"),
        [
            (reading.words, MODELS[name].words,
             *(f"{deviance[reading, name, column]:.1f}" for column in COLUMNS))
            for name in (VISCOUS, DRY)
            for reading in READINGS
        ],
    )  # fmt: skip


def _sampling(found: Findings) -> tuple[str, str]:
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


@dataclass(frozen=True, repr=False)
class Calibration(Findings, Result):
    """The results of the nine rows, as a report."""

    FILE = "calibration.json"
    OTHERS = (
        *("intervals.csv", "models.csv", "predictions.csv", "profiles.csv", "posterior.csv"),
        *("readings.csv", "coverage.csv"),
    )
    DRAW = "rr_paper.calibration.figures.draw"
    CAPTIONS = captions("calibration")

    def _record(self) -> dict[str, Any]:
        return record(self)

    def _tables(self) -> dict[str, str]:
        return tables(self)

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The page and the text for a terminal."""
        return document(self, figures)
