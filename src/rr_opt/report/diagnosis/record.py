"""diagnosis.json: what was found, for scripts; SI, strict JSON."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from rr_opt.answers.diagnosis import DiagnosisAnswer, rms
from rr_opt.report.diagnosis.loss import loss_record
from rr_opt.sysid.diagnosis import (
    Curve,
    Estimate,
    Finding,
    Misfit,
    Remainder,
    Residue,
    Stage,
    Tried,
)
from rr_opt.version import __version__


def fit_record(one: DiagnosisAnswer) -> dict[str, Any]:
    """Everything in units of the noise sigma.

    Where none is held out, the `heldout` ones are of the fitted recordings.
    """
    found = one.found
    levels = {"before": found.nominal, "parameters": found.refitted, "after": found.final}
    fitted = {name: [m for m in level if not m.held_out] for name, level in levels.items()}
    held = {name: [m for m in level if m.held_out] for name, level in levels.items()}
    return {
        "heldout_rms_before": number_of(found.before),
        "heldout_rms_parameters": number_of(rms(held["parameters"] or fitted["parameters"])),
        "heldout_rms_after": number_of(found.after),
        "heldout_recordings": [m.recording for m in held["after"]],
        **{f"fitted_rms_{name}": number_of(rms(level)) for name, level in fitted.items()},
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
        **{name: number_of(one.rms) for name, one in levels.items()},
        "channels": {
            channel: {name: number_of(one.channels.get(channel)) for name, one in levels.items()}
            for channel in after.channels
        },
    }


def number_of(value: float | None) -> float | None:
    """The value; None for what is not finite, or not there."""
    return float(value) if value is not None and math.isfinite(value) else None


def record(one: DiagnosisAnswer) -> dict[str, Any]:
    """The whole of `diagnosis.json`; what is not finite is null."""
    found = one.found
    return {
        "name": one.name,
        "verdict": found.verdict,
        "summary": found.summary,
        "mismatch": {
            "rms_beyond_noise": number_of(found.mismatch.rms),
            "p_value": number_of(found.mismatch.p_value),
        },
        "location": {
            "channel": found.channel,
            "where": one.where,
            "evidence": [_evidence(stage) for stage in found.stages],
        },
        "effects": [_finding(each, found.verdict == "parameters") for each in found.findings],
        "candidates": _candidates(found.tried),
        "remainder": _remainder(found.remainder),
        "indistinguishable": [list(group) for group in found.indistinguishable],
        "next_experiment": _next(one),
        "fit": fit_record(one),
        "loss": loss_record(one.loss),
        "residue": [_residue(each) for each in found.residue],
        "parameters": {name: _estimate(each) for name, each in found.parameters.items()},
        "values": {name: number_of(value) for name, value in found.values.items()},
        "left_out": list(one.left_out),
        "doubts": list(one.doubts),
        "seconds": {step: number_of(time) for step, time in found.seconds.items()},
        "version": __version__,
        "input_sha256": one.sha256,
    }


def _evidence(stage: Stage) -> dict[str, Any]:
    return {
        "test": stage.name,
        "channel": stage.channel,
        "statistic": number_of(stage.statistic),
        "p_value": number_of(stage.p_value),
        "size": number_of(stage.size),
        "guilty": stage.guilty,
        "where": stage.where,
        "curves": [_curve(curve) for curve in stage.curves],
    }


def _curve(curve: Curve | Residue) -> dict[str, Any]:
    return {
        "variable": curve.variable,
        "unit": curve.unit,
        "at": _numbers(curve.at),
        "mean": _numbers(curve.mean),
        "error": _numbers(curve.error),
    }


def _finding(finding: Finding, of_robot: bool) -> dict[str, Any]:
    """An effect; a parameter of the robot has its value beside its name too."""
    parameters = {name: _estimate(each) for name, each in finding.parameters.items()}
    return {
        "name": finding.name,
        "confidence": number_of(finding.confidence),
        **(parameters.get(finding.name, {}) if of_robot else {}),
        "parameters": parameters,
        "removes": number_of(finding.removes),
        "minor": finding.minor,
    }


def _remainder(one: Remainder) -> dict[str, Any]:
    return {
        "size": one.size,
        "rms": number_of(one.rms),
        "share": number_of(one.share),
        "depends_on": one.depends_on,
        "matters": one.matters,
    }


def _estimate(one: Estimate) -> dict[str, Any]:
    ends = [number_of(one.low), number_of(one.high)]
    return {"value": number_of(one.value), "ci95": ends, "unit": one.unit}


def _candidates(tried: Sequence[Tried]) -> list[dict[str, Any]]:
    best = min((one.score for one in tried), default=0.0)
    return [
        {
            "effects": list(one.effects),
            "score": number_of(one.score),
            "score_above_best": number_of(one.score - best),
            "rms_beyond_noise": number_of(one.fit),
            "values": {name: number_of(value) for name, value in one.values.items()},
            "accepted": one.accepted,
        }
        for one in sorted(tried, key=lambda one: one.score)
    ]


def _next(one: DiagnosisAnswer) -> dict[str, Any] | None:
    asked = one.found.next_experiment
    if asked is None:
        return None
    return {
        "gait": {"amplitude": asked.amplitude, "period": asked.period, "offset": asked.offset},
        "start": asked.start,
        "heading": number_of(asked.heading),
        "seconds": number_of(asked.seconds),
        "between": list(asked.between),
        "separation": number_of(asked.separation),
        "sentence": asked.sentence,
    }


def _residue(one: Residue) -> dict[str, Any]:
    return {
        "kind": one.kind,
        **_curve(one),
        "share": number_of(one.share),
        "sentence": one.sentence,
    }


def _numbers(values: Any) -> list[float | None]:
    return [number_of(value) for value in values]
