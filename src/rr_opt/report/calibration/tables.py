"""The tables of a calibration as CSV texts, SI units."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence

import numpy as np

from rr_opt.paper.calibration.calibrate import Calibration
from rr_opt.paper.calibration.intervals import intervals
from rr_opt.paper.calibration.measured import LABELS, ROWS, measured
from rr_opt.paper.calibration.models import MODELS
from rr_opt.paper.calibration.unknowns import UNKNOWNS, values
from rr_opt.report.calibration.words import charges, predicted

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
