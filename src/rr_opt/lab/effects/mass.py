"""Where the mass is."""

from __future__ import annotations

from rr_opt.lab.effects.hidden import HiddenEffect, Parameter, Values
from rr_opt.lab.rig import Rig


def _left(rig: Rig, values: Values) -> None:
    rig.left = [
        left + values.get(name, 0.0) for left, name in zip(rig.left, ("d1", "d2"), strict=True)
    ]


MASS = (
    HiddenEffect(
        "com_offset",
        "a centre of mass lies beside its platform's axis",
        (
            Parameter("d1", "m", 5e-3, most=0.03, signed=True),
            Parameter("d2", "m", 5e-3, most=0.03, signed=True),
        ),
        _left,
    ),
)
