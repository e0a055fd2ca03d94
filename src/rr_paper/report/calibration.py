"""The calibration as a page, a record, CSV files and text for a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from html import escape
from pathlib import Path
from textwrap import wrap
from typing import Any

import numpy as np

from rr_opt.answers.quantities import number
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.html import Badge, Cell, card, document, figure, table
from rr_opt.report.text import columns
from rr_opt.version import __version__
from rr_paper.calibration.calibration import Calibration
from rr_paper.calibration.comparison import Assessment
from rr_paper.calibration.likelihood import measured
from rr_paper.calibration.models import DRY, MODELS, READINGS, VISCOUS
from rr_paper.calibration.unknowns import UNKNOWNS, values
from rr_paper.publication import CITATION, COLUMNS, ROWS, T_POINT, Row
from rr_paper.report.conclusions import (
    IF_MEASURED,
    SHORT,
    aicc_text,
    box,
    conclusions,
    profile_span,
    shipped_text,
    span,
    valley,
    verdict,
)
from rr_paper.report.csv_text import csv_text

RECORD, PAGE = "calibration.json", "report.html"
_DRAWS = 1000
"""Draws of each posterior that are written."""
_WIDTH = 98
"""Of the text for a terminal."""


def record(found: Calibration) -> dict[str, Any]:
    """The content of calibration.json."""
    covered = found.coverage
    return {
        "verdict": verdict(found),
        "conclusions": conclusions(found),
        "t_of_the_intervals": T_POINT,
        "reading": READINGS[0].words,
        "unknowns": [
            {"name": one.name, "unit": one.unit, "box": [one.low, one.high],
             "flat_in": "logarithm" if one.log else "value", "why": one.why}
            for one in UNKNOWNS.values()
        ],
        "intervals": [
            {"unknown": one.unknown.name, "column": one.column, "posterior": list(one.posterior),
             "median": one.median, "profile_student": list(one.profile.ends(one.unknown)),
             "profile_normal": list(one.normal.ends(one.unknown)), "share_of_box": one.share,
             "verdict": one.verdict}
            for one in found.intervals()
        ],
        "models": [
            {"model": name, "column": column, "words": one.model.words, "best": _best(one),
             **_scores(one),
             "profiles": {
                 unknown: list(profile.ends(UNKNOWNS[unknown]))
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
            "unknowns": list(MODELS[VISCOUS].unknowns),
            "posterior": covered.posterior.tolist(),
            "profile_student": covered.profile["student"].tolist(),
            "profile_normal": covered.profile["normal"].tolist(),
            "rise_needed": covered.needed.tolist(),
        },
        "readings": [
            {"reading": one.reading.words, "model": one.model.name, "column": one.column,
             "deviance": one.student.deviance,
             "shipped_rise": one.shipped.rise if one.shipped else None}
            for one in found.alternatives
        ],
        "version": __version__,
    }  # fmt: skip


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


def tables(found: Calibration) -> dict[str, str]:
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
        name: csv_text(tuple(here[0]), (tuple(row.values()) for row in here), digits=6)
        for name, here in rows.items()
    }


def _interval_rows(found: Calibration) -> _Rows:
    rows = []
    for one in found.intervals():
        unknown, ends = one.unknown, {}
        for name, (low, high) in (
            ("box", (unknown.low, unknown.high)),
            ("posterior", one.posterior),
            ("profile", one.profile.ends(unknown)),
            ("profile_normal", one.normal.ends(unknown)),
        ):
            ends[f"{name}_low"] = low
            if name == "posterior":
                ends["posterior_median"] = one.median
            ends[f"{name}_high"] = high
        rows.append(
            {"unknown": unknown.name, "unit": unknown.unit, "column": one.column, **ends,
             "share_of_box": one.share, "verdict": one.verdict}
        )  # fmt: skip
    return rows


def _model_rows(found: Calibration) -> _Rows:
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


def _prediction_rows(found: Calibration) -> _Rows:
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


def _profile_rows(found: Calibration) -> _Rows:
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


def _posterior_rows(found: Calibration) -> _Rows:
    rows = []
    for column, sample in found.posterior.items():
        chosen = np.linspace(0, len(sample.points) - 1, _DRAWS).astype(int)
        at = values(MODELS[VISCOUS].unknowns, sample.points[chosen])
        at["deviance"] = sample.deviance[chosen]
        rows += [
            {"column": column, **{name: of[i] for name, of in at.items()}} for i in range(_DRAWS)
        ]
    return rows


def summary(found: Calibration, files: Iterable[Path]) -> str:
    """The unknowns, the models, what follows, and the files."""
    blocks = [[verdict(found) + "."]]
    for column in COLUMNS:
        rows: list[tuple[str, ...]] = [("", "box", "95 % posterior", "95 % profile", "")]
        rows += [
            (f"  {one.unknown.symbol}", box(one.unknown), span(one.unknown, one.posterior),
             profile_span(one, one.profile), one.verdict)
            for one in found.intervals()
            if one.column == column
        ]  # fmt: skip
        head = f"unknowns, viscous friction, {IF_MEASURED[column]}"
        blocks.append([head, *columns(rows), *wrap(valley(found, column), _WIDTH)])
    rows = [("models", "measured", "unknowns", "deviance", "chi-square", "AICc", "rows left out")]
    rows += [
        (f"  {name}", "first" if column == "mean" else "v_exp", str(len(one.model.unknowns)),
         f"{one.student.deviance:.1f}", f"{one.normal.deviance:.1f}", aicc_text(one.aicc),
         f"{one.left_out_deviance:.0f}")
        for (name, column), one in found.assessments.items()
    ]  # fmt: skip
    blocks.append(columns(rows))
    blocks += [wrap(sentence, _WIDTH) for sentence in _sentences(found)]
    blocks.append(columns([("files" if not i else "", str(file)) for i, file in enumerate(files)]))
    return "\n\n".join("\n".join(block) for block in blocks) + "\n"


def _sentences(found: Calibration) -> list[str]:
    return [*conclusions(found), *(shipped_text(found, column) for column in COLUMNS)]


_BADGES = {"pinned down": "yes", "narrowed": "fitted", "not identifiable": "assumed"}

_CAPTIONS = {
    "unknowns": (
        "What the nine averages say about each unknown",
        "Above: what the posterior leaves of the box (grey). Below: the rise of the deviance with "
        "the unknown fixed and the others compensating; below the dashed line is inside 95 %. "
        "Black triangle: the shipped robot's value.",
    ),
    "predictions": (
        "Each model's best fit beside the nine rows",
        "Table 2 left of the dotted line, Table 3 right of it. Triangles at the edge: further off, "
        "by the number of half widths written there.",
    ),
    "coverage": (
        "Do the intervals keep their level?",
        "Nine rows were generated by known robots, with the scatter of the paper's runs. A 95 % "
        "interval should contain the truth in 95 of 100; the band is sampling error.",
    ),
}


def page(found: Calibration, figures: Mapping[str, str]) -> str:
    """The whole page; figures are SVG texts by name."""
    title = verdict(found)
    lead = (
        f"Estimated from the nine measured averages of {CITATION}. Each interval there comes from "
        f"three runs: half its width is {T_POINT:.2f} standard errors, and a row follows Student's "
        "t with 2 degrees of freedom, not the normal distribution."
    )
    drawn = {name: figure(text, *_CAPTIONS[name]) for name, text in figures.items()}
    body = [
        f'<header><p class="kind">Roller Racer · the paper\'s prototype · calibration</p>'
        f'<h1>{escape(title)}</h1><p class="lead">{escape(lead)}</p></header>',
        drawn["unknowns"],
        card("95 % intervals, viscous friction", _interval_table(found)),
        drawn["predictions"],
        card("Models", _model_table(found)),
        card(
            "What follows, and what does not",
            "".join(f"<p>{escape(sentence)}</p>" for sentence in _sentences(found)),
        ),
        drawn["coverage"],
        card("The boxes, and the reasons for them", _box_table()),
        card("Other readings of J20/J10", _reading_table(found)),
        f"<footer>{_sampling(found)} rr-opt {escape(__version__)}</footer>",
    ]
    return document(f"Calibration: {title}", body)


def _interval_table(found: Calibration) -> str:
    head = ["Unknown", "Measured", "Box", "Posterior", "Profile, Student", "Profile, normal", ""]
    rows: list[list[Cell]] = [
        [f"{one.unknown.symbol}: {one.unknown.words}", SHORT[one.column], box(one.unknown),
         span(one.unknown, one.posterior), profile_span(one, one.profile),
         profile_span(one, one.normal), Badge(one.verdict, _BADGES[one.verdict])]
        for one in found.intervals()
    ]  # fmt: skip
    return table(head, rows) + "".join(
        f"<p>{escape(IF_MEASURED[column].capitalize())}: {escape(valley(found, column))}</p>"
        for column in COLUMNS
    )


def _model_table(found: Calibration) -> str:
    head = ["Model", "Measured", "Unknowns", "Deviance", "χ², normal", "Degrees of freedom",
            "AICc", "Rows left out", "Table 3 alone: AICc"]  # fmt: skip
    rows: list[list[Cell]] = [
        [one.model.words, SHORT[column], str(len(one.model.unknowns)),
         f"{one.student.deviance:.1f}", f"{one.normal.deviance:.1f}", str(one.aicc.freedom),
         aicc_text(one.aicc), f"{one.left_out_deviance:.0f}", aicc_text(one.aicc_table3)]
        for (_, column), one in found.assessments.items()
    ]  # fmt: skip
    return table(head, rows)


def _box_table() -> str:
    rows: list[list[Cell]] = [
        [f"{one.symbol}: {one.words}", box(one) + (", flat in its logarithm" if one.log else ""),
         one.why]
        for one in UNKNOWNS.values()
    ]  # fmt: skip
    return table(["Unknown", "Box", "Why"], rows)


def _reading_table(found: Calibration) -> str:
    rows: list[list[Cell]] = []
    for name in (VISCOUS, DRY):
        deviance = {
            (READINGS[0], column): found.assessments[name, column].student.deviance
            for column in COLUMNS
        }
        deviance |= {
            (one.reading, one.column): one.student.deviance
            for one in found.alternatives
            if one.model.name == name
        }
        for reading in READINGS:
            cells = (f"{deviance[reading, column]:.1f}" for column in COLUMNS)
            rows.append([reading.words, MODELS[name].words, *cells])
    return table(["J20/J10", "Model", "Deviance, first column", "Deviance, v_exp"], rows)


def _sampling(found: Calibration) -> str:
    samples = ", ".join(
        f"{len(one.points)} draws with split R-hat {one.rhat:.2f} ({SHORT[column]})"
        for column, one in found.posterior.items()
    )
    needed = ", ".join(number(float(rise), 2) for rise in found.coverage.needed)
    return (
        f"Posteriors: {escape(samples)}. Rises of the deviance that 95 % of the truths of "
        f"{found.coverage.sets} simulated data sets stay below, in the order of the unknowns: "
        f"{needed}."
    )


def write_calibration(found: Calibration, folder: Path) -> list[Path]:
    """Write everything, after removing the files of an earlier run; returns the files."""
    from rr_paper.report.calibration_figures import draw

    texts, drawn = tables(found), draw(found)
    texts |= {f"{name}.svg": text for name, text in drawn.items()}
    remove(folder, (RECORD, PAGE, *texts))
    written = [write_json(folder / RECORD, record(found))]
    written += [write_text(folder / name, text) for name, text in texts.items()]
    return [write_text(folder / PAGE, page(found, drawn)), *written]
