"""report.html of a calibration: one file that opens anywhere, the outcome first."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape

from rr_opt import __version__
from rr_opt.paper.calibration.calibrate import Calibration
from rr_opt.paper.calibration.intervals import intervals
from rr_opt.paper.calibration.measured import COLUMNS, T_POINT
from rr_opt.paper.calibration.models import MODELS
from rr_opt.paper.calibration.robots import READINGS
from rr_opt.paper.calibration.unknowns import UNKNOWNS
from rr_opt.paper.printed import CITATION
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
from rr_opt.report.html import Badge, Cell, card, figure, table
from rr_opt.report.page_style import CSS
from rr_opt.report.quantities import number

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
        card("95 % intervals, viscous friction", _intervals(found)),
        drawn.get("predictions", ""),
        card("Models", _models(found)),
        card("What follows, and what does not", _sentences(found)),
        drawn.get("coverage", ""),
        card("The boxes, and why they are those", _boxes()),
        card("Other readings of J20/J10", _readings(found)),
        f"<footer>{_sampled(found)} rr-opt {escape(__version__)}</footer>",
    ]
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>Calibration: {escape(title)}</title><style>{CSS}</style></head>\n<body><main>\n"
        + "\n".join(part for part in body if part)
        + "\n</main></body></html>\n"
    )


def _intervals(found: Calibration) -> str:
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


def _models(found: Calibration) -> str:
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


def _readings(found: Calibration) -> str:
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
