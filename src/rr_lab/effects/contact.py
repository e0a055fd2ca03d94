"""How the wheels meet the floor."""

from __future__ import annotations

import math

from rr_lab.effects.hidden import HiddenEffect, Parameter, Values
from rr_lab.rig import Rig


def _slip(rig: Rig, values: Values) -> None:
    """`mu`: the grip that lets go; `creep_compliance`: side speed per side force."""
    if "mu" in values:
        rig.mu = values["mu"]
    rig.creep += values.get("creep_compliance", 0.0)


def _toe(rig: Rig, values: Values) -> None:
    rig.toe = [
        toe + values.get(name, 0.0) for toe, name in zip(rig.toe, ("toe1", "toe2"), strict=True)
    ]


CONTACT = (
    HiddenEffect(
        "lateral_slip",
        "the wheels slip sideways",
        (
            Parameter("creep_compliance", "m/(N s)", 0.03, most=2.0),
            Parameter("mu", "1", 0.05, neutral=math.inf, most=2e-3),
        ),
        _slip,
    ),
    HiddenEffect(
        "axle_misalignment",
        "an axle is not square to its platform",
        (
            Parameter("toe1", "rad", 0.01, most=0.1, signed=True),
            Parameter("toe2", "rad", 0.01, most=0.1, signed=True),
        ),
        _toe,
    ),
)
