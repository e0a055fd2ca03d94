"""What the floor is like."""

from __future__ import annotations

from rr_opt.lab.effects.hidden import HiddenEffect, Parameter, Values
from rr_opt.lab.laws import Circle, Edge, Patch
from rr_opt.lab.rig import Rig


def _tilt(rig: Rig, values: Values) -> None:
    x, y = rig.tilt
    rig.tilt = (x + values.get("tilt_x", 0.0), y + values.get("tilt_y", 0.0))


def _patch(rig: Rig, values: Values) -> None:
    """The drag of each wheel times `multiplier` within a circle, or beyond an edge."""
    within: Circle | Edge
    if "radius" in values:
        within = Circle(values["x"], values["y"], values["radius"])
    else:
        within = Edge(values["edge_x"], values["edge_y"], values["normal"])
    rig.laws.append(Patch(values["multiplier"], within))


FLOOR = (
    HiddenEffect(
        "floor_tilt",
        "the floor slopes",
        (
            Parameter("tilt_x", "rad", 1e-3, most=0.02, signed=True),
            Parameter("tilt_y", "rad", 1e-3, most=0.02, signed=True),
        ),
        _tilt,
    ),
    HiddenEffect(
        "floor_patch",
        "a part of the floor brakes more than the rest",
        (
            Parameter("multiplier", "1", 2.0, neutral=1.0, most=20.0),
            Parameter("x", "m", 0.0, neutral=None),
            Parameter("y", "m", 0.0, neutral=None),
            Parameter("radius", "m", 0.3, neutral=None),
            Parameter("normal", "rad", 0.0, neutral=None),
            Parameter("edge_x", "m", 0.0, neutral=None),
            Parameter("edge_y", "m", 0.0, neutral=None),
        ),
        _patch,
    ),
)
