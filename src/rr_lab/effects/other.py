"""What the floor is like, where the mass is, and what the capture system gets wrong."""

from __future__ import annotations

from rr_lab.effects.hidden import HiddenEffect, Parameter, Values
from rr_lab.rig import Circle, Edge, Patch, Rig


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
