"""What the floor is like, where the mass is, and what the capture system gets wrong."""

from __future__ import annotations

import math

from rr_lab.effects.hidden import HiddenEffect, Parameter, Setting, Values
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


def _any_direction(setting: Setting, _: Values) -> Values:
    slope, way = 1.4e-3, setting.rng.uniform(-math.pi, math.pi)
    return {"tilt_x": slope * math.cos(way), "tilt_y": slope * math.sin(way)}


def _round_a_path(setting: Setting, values: Values) -> Values:
    """A circle round a place that a run passes."""
    x, y = setting.passed()
    radius = float(setting.rng.uniform(0.15, 0.55))
    return {"multiplier": 1 + values["multiplier"] / 2, "x": x, "y": y, "radius": radius}


def _across_a_path(setting: Setting, values: Values) -> Values:
    """An edge through a place that a run passes."""
    x, y = setting.passed()
    normal = float(setting.rng.uniform(-math.pi, math.pi))
    return {"multiplier": 1 + values["multiplier"] / 2, "normal": normal, "edge_x": x, "edge_y": y}


def _place(name: str, unit: str = "m") -> Parameter:
    return Parameter(name, unit, 0.0, neutral=None)


_MULTIPLIER = Parameter("multiplier", "1", 2.0, neutral=1.0, most=20.0)
_DISC = tuple(map(_place, ("x", "y", "radius")))
_EDGE = (_place("normal", "rad"), _place("edge_x"), _place("edge_y"))

FLOOR = (
    HiddenEffect(
        "floor_tilt",
        "the floor slopes",
        (
            Parameter("tilt_x", "rad", 1e-3, most=0.02, signed=True),
            Parameter("tilt_y", "rad", 1e-3, most=0.02, signed=True),
        ),
        _tilt,
        draw=_any_direction,
    ),
    HiddenEffect(
        "floor_patch",
        "a round part of the floor brakes more than the rest",
        (_MULTIPLIER, *_DISC),
        _patch,
        "disc",
        also=_EDGE,
        draw=_round_a_path,
    ),
    HiddenEffect(
        "floor_patch",
        "the floor beyond a straight edge brakes more than the rest",
        (_MULTIPLIER, *_EDGE),
        _patch,
        "edge",
        draw=_across_a_path,
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
