"""What the floor is like, where the mass is, and what the capture system gets wrong."""

from __future__ import annotations

import math

from rr_lab.effects.hidden_effect import HiddenEffect, Parameter, Setting, Values, adds, place
from rr_lab.laws import Circle, Edge, Patch
from rr_lab.rig import Rig


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


def _pair(unit: str, typical: float, most: float, *names: str) -> tuple[Parameter, ...]:
    return tuple(Parameter(name, unit, typical, most=most, signed=True) for name in names)


_MULTIPLIER = Parameter("multiplier", "1", 2.0, neutral=1.0, most=20.0)
_DISC = tuple(map(place, ("x", "y", "radius")))
_EDGE = (place("normal", "rad"), place("edge_x"), place("edge_y"))

FLOOR = (
    HiddenEffect("floor_tilt", "the floor slopes", _pair("rad", 1e-3, 0.02, "tilt_x", "tilt_y"),
                 adds("tilt", "tilt_x", "tilt_y"), draw=_any_direction),
    HiddenEffect("floor_patch", "a round part of the floor brakes more than the rest",
                 (_MULTIPLIER, *_DISC), _patch, "disc", also=_EDGE, draw=_round_a_path),
    HiddenEffect("floor_patch", "the floor beyond a straight edge brakes more than the rest",
                 (_MULTIPLIER, *_EDGE), _patch, "edge", draw=_across_a_path),
)  # fmt: skip

MASS = (
    HiddenEffect("com_offset", "a centre of mass lies off its platform's axis",
                 _pair("m", 5e-3, 0.03, "d1", "d2"), adds("left", "d1", "d2")),
)  # fmt: skip

MEASUREMENT = (
    HiddenEffect("marker_offset", "the point that is tracked is not the joint",
                 _pair("m", 5e-3, 0.03, "dx", "dy"), adds("tracked", "dx", "dy")),
    HiddenEffect("clock_offset", "the recording's clock and the command's are apart",
                 _pair("s", 0.02, 0.2, "offset"), adds("clock", "offset")),
)  # fmt: skip
