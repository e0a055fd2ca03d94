"""diagnosis.json: what was found, for scripts; SI, strict JSON."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from rr_opt.sysid.diagnosis import (
    Curve,
    Diagnosis,
    Estimate,
    Finding,
    Misfit,
    NextExperiment,
    Residue,
    Stage,
    Tried,
)


def diagnosis_record(found: Diagnosis, where: str) -> dict[str, Any]:
    """The content of `diagnosis.json` that is of the diagnosis alone."""
    return {
        "verdict": found.verdict,
        "summary": found.summary,
        "mismatch": {"rms_beyond_noise": found.mismatch.rms, "p_value": found.mismatch.p_value},
        "location": {
            "channel": found.channel,
            "where": where,
            "evidence": [_evidence(stage) for stage in found.stages],
        },
        "effects": [_finding(each, found.verdict == "parameters") for each in found.findings],
        "candidates": _candidates(found.tried),
        "remainder": found.remainder,
        "indistinguishable": found.indistinguishable,
        "next_experiment": found.next_experiment and _next(found.next_experiment),
        "fit": _fit(found),
        "loss": None,
        "residue": [
            {"kind": r.kind, **_curve(r), "share": r.share, "sentence": r.sentence}
            for r in found.residue
        ],
        "parameters": {name: _estimate(each) for name, each in found.parameters.items()},
        "values": found.values,
        "left_out": (),
        "doubts": (),
        "seconds": found.seconds,
    }


def _fit(found: Diagnosis) -> dict[str, Any]:
    """Everything in units of the noise sigma.

    Where none is held out, the `heldout` ones are of the fitted recordings.
    """
    levels = {"before": found.nominal, "parameters": found.refitted, "after": found.final}
    fitted = {name: [m for m in level if not m.held_out] for name, level in levels.items()}
    held = {name: [m for m in level if m.held_out] for name, level in levels.items()}
    return {
        "heldout_rms_before": found.before,
        "heldout_rms_parameters": _rms(held["parameters"] or fitted["parameters"]),
        "heldout_rms_after": found.after,
        "heldout_recordings": [m.recording for m in held["after"]],
        **{f"fitted_rms_{name}": _rms(level) for name, level in fitted.items()},
        "recordings": [
            _recording(dict(zip(levels, each, strict=True)))
            for each in zip(*levels.values(), strict=True)
        ],
    }


def _recording(levels: Mapping[str, Misfit]) -> dict[str, Any]:
    after = levels["after"]
    return {
        "file": after.recording,
        "use": "holdout" if after.held_out else "fit",
        **{name: one.rms for name, one in levels.items()},
        "channels": {
            channel: {name: one.channels.get(channel) for name, one in levels.items()}
            for channel in after.channels
        },
    }


def _rms(misfits: Iterable[Misfit]) -> float:
    """Root mean square over all their values, in sigma; NaN of none."""
    squares = [one.residuals.ravel() ** 2 for one in misfits]
    return float(np.sqrt(np.nanmean(np.concatenate(squares)))) if squares else float("nan")


def _evidence(stage: Stage) -> dict[str, Any]:
    names = ("channel", "statistic", "p_value", "size", "guilty", "where")
    return {
        "test": stage.name,
        **{name: getattr(stage, name) for name in names},
        "curves": [_curve(curve) for curve in stage.curves],
    }


def _curve(curve: Curve | Residue) -> dict[str, Any]:
    return {name: getattr(curve, name) for name in ("variable", "unit", "at", "mean", "error")}


def _finding(finding: Finding, of_robot: bool) -> dict[str, Any]:
    """An effect; a parameter of the robot also has its value next to its name."""
    parameters = {name: _estimate(each) for name, each in finding.parameters.items()}
    return {
        "name": finding.name,
        "confidence": finding.confidence,
        **(parameters.get(finding.name, {}) if of_robot else {}),
        "parameters": parameters,
        "removes": finding.removes,
        "minor": finding.minor,
    }


def _estimate(one: Estimate) -> dict[str, Any]:
    return {"value": one.value, "ci95": [one.low, one.high], "unit": one.unit}


def _candidates(tried: Sequence[Tried]) -> list[dict[str, Any]]:
    ranked = sorted(tried, key=lambda one: one.score)
    return [
        {
            "effects": one.effects,
            "score": one.score,
            "score_above_best": one.score - ranked[0].score,
            "rms_beyond_noise": one.fit,
            "values": one.values,
            "accepted": one.accepted,
        }
        for one in ranked
    ]


def _next(asked: NextExperiment) -> dict[str, Any]:
    gait = {name: getattr(asked, name) for name in ("amplitude", "period", "offset")}
    names = ("start", "heading", "seconds", "between", "separation", "sentence")
    return {"gait": gait, **{name: getattr(asked, name) for name in names}}
