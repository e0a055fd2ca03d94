"""calibration.json: everything that was found, SI units."""

from __future__ import annotations

from typing import Any

from rr_opt import __version__
from rr_opt.paper.calibration.calibrate import Calibration
from rr_opt.paper.calibration.intervals import ends_of, intervals
from rr_opt.paper.calibration.measured import COLUMNS, T_POINT
from rr_opt.paper.calibration.models import MODELS
from rr_opt.paper.calibration.robots import READINGS
from rr_opt.paper.calibration.unknowns import UNKNOWNS, values
from rr_opt.report.calibration.words import charges, conclusions, predicted, verdict


def record(found: Calibration) -> dict[str, Any]:
    """The content of the file."""
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
             "median": one.median, "profile_student": list(one.of(one.profile)),
             "profile_normal": list(one.of(one.normal)), "share_of_box": one.left,
             "verdict": one.word}
            for one in intervals(found)
        ],
        "models": [_model(found, name, column) for name in MODELS for column in COLUMNS],
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
            "sets": found.coverage.sets,
            "unknowns": list(MODELS["viscous"].unknowns),
            "posterior": found.coverage.posterior.tolist(),
            "profile_student": found.coverage.profile["student"].tolist(),
            "profile_normal": found.coverage.profile["normal"].tolist(),
            "rise_needed": found.coverage.needed.tolist(),
        },
        "readings": [
            {"reading": one.reading.words, "model": one.model.name, "column": one.column,
             "deviance": one.student.deviance,
             "shipped_rise": one.shipped.rise if one.shipped else None}
            for one in found.alternatives
        ],
        "version": __version__,
    }  # fmt: skip


def _model(found: Calibration, name: str, column: Any) -> dict[str, Any]:
    held = found.held[name, column]
    of, made = charges(held), held.likelier
    best = values(held.model.unknowns, held.student.point[None])
    return {
        "model": name,
        "column": column,
        "words": held.model.words,
        "best": {unknown: float(value[0]) for unknown, value in best.items()},
        "deviance": held.student.deviance,
        "chi_square": held.normal.deviance,
        "degrees_of_freedom": of["student"].freedom,
        "aicc": of["student"].aicc,
        "aicc_normal": of["normal"].aicc,
        "table3_deviance": held.table3.deviance,
        "table3_aicc": of["table3"].aicc,
        "left_out_deviance": predicted(held),
        "profiles": {
            unknown: list(ends_of(UNKNOWNS[unknown], profile))
            for unknown, profile in zip(held.model.told, held.profiles, strict=True)
        },
        "made": {"sets": made.sets, "as_bad": made.worse, "gaining_as_much": made.gained}
        if made
        else None,
    }
