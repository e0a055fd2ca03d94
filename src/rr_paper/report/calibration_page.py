"""The calibration as tables, a page and a folder."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from pathlib import Path

import numpy as np

from rr_opt.answers.quantities import number
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.html import CSS, Badge, Cell, card, figure, table
from rr_opt.version import __version__
from rr_paper.calibration.calibrate import Calibration
from rr_paper.calibration.intervals import intervals
from rr_paper.calibration.models import (
    COLUMNS,
    LABELS,
    MODELS,
    READINGS,
    ROWS,
    T_POINT,
    UNKNOWNS,
    measured,
    values,
)
from rr_paper.publication import CITATION
from rr_paper.report.calibration_text import (
    IF_MEASURED,
    aicc_text,
    box,
    charges,
    conclusions,
    predicted,
    profile_span,
    record,
    shipped_text,
    span,
    valley,
    verdict,
)

_DRAWS = 1000
"""Draws of each posterior that are written."""


def tables(found: Calibration) -> dict[str, str]:
    """File name -> text."""
    return {
        "intervals.csv": _intervals(found),
        "models.csv": _models(found),
        "predictions.csv": _predictions(found),
        "profiles.csv": _profiles(found),
        "posterior.csv": _posterior(found),
        "readings.csv": _readings(found),
        "coverage.csv": _coverage(found),
    }


def _csv(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows([f"{x:.6g}" if isinstance(x, float) else x for x in row] for row in rows)
    return text.getvalue()


def _intervals(found: Calibration) -> str:
    head = ("unknown", "unit", "column", "box_low", "box_high", "posterior_low",
            "posterior_median", "posterior_high", "profile_low", "profile_high",
            "profile_normal_low", "profile_normal_high", "share_of_box", "verdict")  # fmt: skip
    return _csv(
        head,
        (
            (one.unknown.name, one.unknown.unit, one.column, one.unknown.low, one.unknown.high,
             one.posterior[0], one.median, one.posterior[1], *one.of(one.profile),
             *one.of(one.normal), one.left, one.word)
            for one in intervals(found)
        ),
    )  # fmt: skip


def _models(found: Calibration) -> str:
    head = ("model", "column", "unknowns", "deviance", "chi_square", "degrees_of_freedom",
            "aicc", "aicc_normal", "table3_deviance", "table3_aicc", "left_out_deviance",
            "sets_made", "sets_as_bad", "sets_gaining_as_much",
            *(f"best_{name}" for name in UNKNOWNS))  # fmt: skip
    rows = []
    for (name, column), held in found.held.items():
        of, made = charges(held), held.likelier
        at = values(held.model.unknowns, held.student.point[None])
        rows.append(
            (name, column, len(held.model.unknowns), held.student.deviance, held.normal.deviance,
             of["student"].freedom, *(_or_empty(of[law].aicc) for law in ("student", "normal")),
             held.table3.deviance, _or_empty(of["table3"].aicc), predicted(held),
             *((made.sets, made.worse, _or_empty(made.gained)) if made else ("", "", "")),
             *(float(at[unknown][0]) if unknown in at else "" for unknown in UNKNOWNS))
        )  # fmt: skip
    return _csv(head, rows)


def _or_empty(value: float | None) -> float | str:
    return "" if value is None else value


def _predictions(found: Calibration) -> str:
    head = ("model", "column", "row", "ratio", "period", "amplitude", "measured", "half_width",
            "standard_error", "predicted", "z", "z_left_out")  # fmt: skip
    rows = []
    for (name, column), held in found.held.items():
        data = measured(column)
        z = held.student.z(data)
        for i, row in enumerate(ROWS):
            rows.append(
                (name, column, LABELS[i], row.ratio, row.period, _or_empty(row.amplitude),
                 float(data.speed[i]), row.half_width, float(data.error[i]),
                 float(held.student.speeds[i]), float(z[i]), float(held.left_out[i]))
            )  # fmt: skip
    return _csv(head, rows)


def _profiles(found: Calibration) -> str:
    rows = []
    for (name, column), held in found.held.items():
        laws = [("student", held.profiles)]
        if name == "viscous":
            laws.append(("normal", found.normal_profiles[column]))
        for law, profiles in laws:
            for unknown, profile in zip(held.model.told, profiles, strict=True):
                at = UNKNOWNS[unknown].value(profile.grid)
                rows += [
                    (name, column, law, unknown, float(x), float(rise))
                    for x, rise in zip(at, profile.rise, strict=True)
                ]
    return _csv(("model", "column", "law", "unknown", "value", "rise"), rows)


def _posterior(found: Calibration) -> str:
    names, rows = MODELS["viscous"].unknowns, []
    for column, sample in found.posterior.items():
        chosen = np.linspace(0, len(sample.points) - 1, _DRAWS).astype(int)
        at = values(names, sample.points[chosen])
        for i, place in enumerate(chosen):
            rows.append((column, *(float(at[name][i]) for name in names),
                         float(sample.deviance[place])))  # fmt: skip
    return _csv(("column", *names, "deviance"), rows)


def _readings(found: Calibration) -> str:
    rows = [
        (one.reading.about, one.reading.by, one.reading.spread if one.reading.by == "loads" else "",
         one.model.name, one.column, one.student.deviance)
        for one in found.alternatives
    ]  # fmt: skip
    return _csv(("about", "by", "spread", "model", "column", "deviance"), rows)


def _coverage(found: Calibration) -> str:
    kept = found.coverage
    names = MODELS["viscous"].unknowns
    rows = [
        (name, kept.sets, float(kept.posterior[i]), float(kept.profile["student"][i]),
         float(kept.profile["normal"][i]), float(kept.needed[i]))
        for i, name in enumerate(names)
    ]  # fmt: skip
    head = ("unknown", "sets", "posterior", "profile_student", "profile_normal", "rise_needed")
    return _csv(head, rows)


_KINDS = {"pinned down": "yes", "narrowed": "fitted", "not identifiable": "assumed"}

_CAPTIONS = {
    "unknowns": (
        "What the nine averages say of each unknown",
        "Above: what is left of the box (grey) by the posterior. Below: by how much the deviance "
        "rises if the unknown is held and the others make up for it; below the broken line is "
        "inside 95 %. Black triangle: the shipped robot's value.",
    ),
    "predictions": (
        "Each model's best fit beside the nine rows",
        "Table 2 left of the dotted line, Table 3 right of it. Triangles at the edge: further off, "
        "by the number of half widths written there.",
    ),
    "coverage": (
        "Do the intervals keep their word?",
        "Nine rows were made by robots that are known, with the scatter of the paper's runs. A "
        "95 % interval should hold the truth in 95 of 100; the band is what chance does to that.",
    ),
}


def page(found: Calibration, figures: Mapping[str, str]) -> str:
    """The whole page; figures are SVG texts by name."""
    title = verdict(found)
    lead = (
        f"Estimated from the nine measured averages of {CITATION}. Each interval there comes from "
        f"three runs: half its width is {T_POINT:.2f} standard errors, and a row is Student's with "
        "2 degrees of freedom, not normal."
    )
    drawn = {name: figure(text, *_CAPTIONS[name]) for name, text in figures.items()}
    body = [
        f'<header><p class="kind">Roller Racer · the paper\'s prototype · calibration</p>'
        f'<h1>{escape(title)}</h1><p class="lead">{escape(lead)}</p></header>',
        drawn.get("unknowns", ""),
        card("95 % intervals, viscous friction", _page_intervals(found)),
        drawn.get("predictions", ""),
        card("Models", _page_models(found)),
        card("What follows, and what does not", _sentences(found)),
        drawn.get("coverage", ""),
        card("The boxes, and why they are those", _boxes()),
        card("Other readings of J20/J10", _page_readings(found)),
        f"<footer>{_sampled(found)} rr-opt {escape(__version__)}</footer>",
    ]
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>Calibration: {escape(title)}</title><style>{CSS}</style></head>\n<body><main>\n"
        + "\n".join(part for part in body if part)
        + "\n</main></body></html>\n"
    )


def _page_intervals(found: Calibration) -> str:
    head = ["Unknown", "Measured", "Box", "Posterior", "Profile, Student", "Profile, normal", ""]
    rows: list[list[Cell]] = [
        [
            f"{one.unknown.symbol}: {one.unknown.words}",
            "first column" if one.column == "mean" else "v_exp",
            box(one.unknown),
            span(one.unknown, one.posterior),
            profile_span(one, one.profile),
            profile_span(one, one.normal),
            Badge(one.word, _KINDS[one.word]),
        ]
        for one in intervals(found)
    ]
    told = "".join(
        f"<p>{escape(IF_MEASURED[column].capitalize())}: {escape(valley(found, column))}</p>"
        for column in COLUMNS
    )
    return table(head, rows) + told


def _page_models(found: Calibration) -> str:
    head = ["Model", "Measured", "Unknowns", "Deviance", "χ², normal", "Degrees of freedom",
            "AICc", "Rows left out", "Table 3 alone: AICc"]  # fmt: skip
    rows: list[list[Cell]] = [
        [
            held.model.words,
            "first column" if column == "mean" else "v_exp",
            str(len(held.model.unknowns)),
            f"{held.student.deviance:.1f}",
            f"{held.normal.deviance:.1f}",
            str(charges(held)["student"].freedom),
            aicc_text(charges(held)["student"]),
            f"{predicted(held):.0f}",
            aicc_text(charges(held)["table3"]),
        ]
        for (_, column), held in found.held.items()
    ]
    return table(head, rows)


def _sentences(found: Calibration) -> str:
    told = [*conclusions(found), *(shipped_text(found, column) for column in COLUMNS)]
    return "".join(f"<p>{escape(sentence)}</p>" for sentence in told)


def _boxes() -> str:
    rows: list[list[Cell]] = [
        [f"{one.symbol}: {one.words}", box(one) + (", flat in its logarithm" if one.log else ""),
         one.why]
        for one in UNKNOWNS.values()
    ]  # fmt: skip
    return table(["Unknown", "Box", "Why"], rows)


def _page_readings(found: Calibration) -> str:
    rows: list[list[Cell]] = []
    for name in ("viscous", "viscous+dry"):
        first = {c: found.held[name, c].student.deviance for c in COLUMNS}
        rows.append([READINGS[0].words, MODELS[name].words, *(f"{first[c]:.1f}" for c in COLUMNS)])
        for reading in READINGS[1:]:
            here = {
                one.column: one.student.deviance
                for one in found.alternatives
                if one.reading == reading and one.model.name == name
            }
            rows.append([reading.words, MODELS[name].words, *(f"{here[c]:.1f}" for c in COLUMNS)])
    return table(["J20/J10", "Model", "Deviance, first column", "Deviance, v_exp"], rows)


def _sampled(found: Calibration) -> str:
    told = ", ".join(
        f"{len(one.points)} draws with split R-hat {one.rhat:.2f} "
        f"({'first column' if column == 'mean' else 'v_exp'})"
        for column, one in found.posterior.items()
    )
    needed = ", ".join(number(float(rise), 2) for rise in found.coverage.needed)
    return (
        f"Posteriors: {escape(told)}. Rises of the deviance that 95 % of the truths of "
        f"{found.coverage.sets} made data sets stay below, in the order of the unknowns: {needed}."
    )


RECORD, PAGE = "calibration.json", "report.html"


def write_calibration(found: Calibration, folder: Path) -> list[Path]:
    """Write everything; returns the files in the order to name them."""
    texts, drawn = tables(found), draw(found)
    remove(folder, (RECORD, PAGE, *texts, *(f"{name}.svg" for name in drawn)))
    written = [write_json(folder / RECORD, record(found))]
    written += [write_text(folder / name, text) for name, text in texts.items()]
    written += [write_text(folder / f"{name}.svg", text) for name, text in drawn.items()]
    return [write_text(folder / PAGE, page(found, drawn)), *written]


def draw(found: Calibration) -> dict[str, str]:
    """The figures as SVG texts by name."""
    from rr_opt.report.figures.style import figure, styled, svg
    from rr_paper.report.calibration_figures import coverage, predictions, unknowns

    with styled():
        held = figure(6.6, 3.8)
        coverage(held.subplots(), found.coverage)
        return {
            "unknowns": svg(unknowns(found)),
            "predictions": svg(predictions(found)),
            "coverage": svg(held),
        }
