"""diagnosis.json's `fit`: how far simulations are from the recordings."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from rr_opt.diagnose.diagnosis import Misfit
from rr_opt.report.diagnosis.diagnosed import Diagnosed, rms


def fit_record(one: Diagnosed) -> dict[str, Any]:
    """Everything in sigma; 1 is the noise.

    Where none is held out, `heldout_rms_before` and `_after` are of the fitted recordings, each
    predicted from the others, and `heldout_rms_parameters` is of the fitted ones as they are.
    `heldout_rms_fitted_too` is null but where the values given fit the held-out ones too.
    """
    found = one.found
    levels = {"before": found.nominal, "parameters": found.refitted, "after": found.final}
    fitted = {name: [m for m in level if not m.held_out] for name, level in levels.items()}
    held = {name: [m for m in level if m.held_out] for name, level in levels.items()}
    return {
        "heldout_rms_before": number_of(found.before),
        "heldout_rms_parameters": number_of(rms(held["parameters"] or fitted["parameters"])),
        "heldout_rms_after": number_of(found.after),
        "heldout_rms_fitted_too": number_of(found.together),
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
