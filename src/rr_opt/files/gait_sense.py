"""Whether a problem's gaits are ones that can be looked for."""

from __future__ import annotations

from collections.abc import Iterator

from rr_opt.files.document import Document
from rr_opt.files.gait_bounds_model import OWN_SHAPE, GaitModel
from rr_opt.files.issue import Issue

LONGEST_PERIOD = 60.0
"""Longer ones are taken for a slip of the unit, s."""


def gait_findings(gait: GaitModel, document: Document) -> Iterator[Issue]:
    """Gaits that say nothing, or whose steady cycle nobody could compute or wait for."""
    for key, shape in OWN_SHAPE.items():
        if getattr(gait, key) is not None and gait.shape != shape:
            message = (
                f"Read {key} of a gait with the shape `{gait.shape}`. Only a `{shape}` gait "
                f"has {key}. Write `shape: {shape}`, or delete this key."
            )
            yield document.issue("error", ("gait", key), message)
    if gait.amplitude.high <= 0:
        message = (
            "Read an amplitude of at most 0. Expected an upper bound above 0: a gait that "
            "does not move the servo does not move the robot."
        )
        yield document.issue("error", ("gait", "amplitude"), message)
    elif gait.amplitude.low == 0 and gait.shape != "sine":
        message = (
            f"Read an amplitude from 0 of a `{gait.shape}` gait. Expected a lower bound above 0: "
            "it bounds the first harmonic, without which a gait repeats within its period, and "
            "the bounds of the period mean nothing. Write for example `amplitude: "
            f"[{min(0.05, gait.amplitude.high / 10):.2g}, {gait.amplitude.high:.4g}]`."
        )
        yield document.issue("warning", ("gait", "amplitude"), message)
    if gait.period.high > LONGEST_PERIOD:
        message = (
            f"Read a period of up to {gait.period.high:.4g} s. Expected at most "
            f"{LONGEST_PERIOD:.4g} s. Check the unit."
        )
        yield document.issue("error", ("gait", "period"), message)
