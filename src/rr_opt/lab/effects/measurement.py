"""What the capture system gets wrong."""

from __future__ import annotations

from rr_opt.lab.effects.hidden import HiddenEffect, Parameter, Values
from rr_opt.lab.rig import Rig


def _marker(rig: Rig, values: Values) -> None:
    x, y = rig.tracked
    rig.tracked = (x + values.get("dx", 0.0), y + values.get("dy", 0.0))


def _clock(rig: Rig, values: Values) -> None:
    rig.clock += values["offset"]


MEASUREMENT = (
    HiddenEffect(
        "marker_offset",
        "the point that is tracked is not the joint",
        (
            Parameter("dx", "m", 5e-3, most=0.03, signed=True),
            Parameter("dy", "m", 5e-3, most=0.03, signed=True),
        ),
        _marker,
    ),
    HiddenEffect(
        "clock_offset",
        "the recording's clock and the command's are apart",
        (Parameter("offset", "s", 0.02, most=0.2, signed=True),),
        _clock,
    ),
)
