"""Colours and words that the figures of a diagnosis have in common."""

from __future__ import annotations

from rr_opt.report.figures.style import BACKWARD, FORWARD, GREY

NOMINAL, FINAL, RECORDED = BACKWARD, FORWARD, "#b4bdc6"
"""The model as believed is orange, as found blue, what was recorded grey."""

NOISE = GREY
CHANNELS = {"x": "x", "y": "y", "psi": "ψ", "phi": "φ", "torque": "τ"}
WIDTH = 5.4
"""Of every figure, inches: read without zooming on a phone."""

_WIDE = 8.0
"""A range of so many sigma is where linear axes would hide the noise."""


def stretched(largest: float) -> bool:
    """Whether an axis in sigma needs a scale that is linear only near the noise."""
    return largest > _WIDE
