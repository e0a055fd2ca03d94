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


_CREEP = Parameter("creep_compliance", "m/(N s)", 0.03, most=2.0)
_MU = Parameter("mu", "1", 0.05, neutral=math.inf, most=2e-3)

CONTACT = (
    HiddenEffect(
        "lateral_slip",
        "the wheels creep sideways in proportion to their side force",
        (_CREEP,),
        _slip,
        "creep",
        also=(_MU,),
    ),
    HiddenEffect("lateral_slip", "the wheels slide sideways", (_MU,), _slip, "sliding"),
    HiddenEffect(
        "lateral_slip",
        "the wheels slide sideways at the peaks of a cycle alone",
        (_MU,),
        _slip,
        "grazing",
        visible=(1.0, 4.0),
    ),
    HiddenEffect(
        "lateral_slip",
        "the wheels slide sideways through most of a cycle",
        (_MU,),
        _slip,
        "sliding_strongly",
        visible=(30.0, 120.0),
    ),
    HiddenEffect(
        "lateral_slip",
        "the wheels creep sideways, up to a limit above which they slide",
        (_CREEP, _MU),
        _slip,
        "saturating_creep",
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
