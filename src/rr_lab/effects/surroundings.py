"""What the floor is like, where the mass is, and what the capture system gets wrong."""

from __future__ import annotations

import math

from rr_lab.effects.hidden_effect import Setting, Values
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


FUNCTIONS = (_patch, _any_direction, _round_a_path, _across_a_path)
