"""An effect by lot: which of its parameters it has, their signs and places."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rr_opt.lab.case import Case, motion_of
from rr_opt.lab.effects import effect_named
from rr_opt.lab.visibility import COARSE
from rr_opt.robot.parameters import EffectUse


def draw_effect(rng: np.random.Generator, name: str, case: Case) -> EffectUse:
    """An effect of about its typical size for a case that does not have it yet.

    Its strength is made right later, by `at_visibility`.
    """
    effect = effect_named(name)
    values = {}
    for parameter in effect.parameters:
        size = parameter.typical * math.exp(rng.uniform(-0.7, 0.7))
        sign = rng.choice([-1, 1]) if parameter.signed else 1
        values[parameter.name] = float(sign * size)
    draw = _OWN_WAY.get(name)
    return EffectUse(name, draw(_Lot(rng, values, case)) if draw else values)


@dataclass(frozen=True)
class _Lot:
    """What an effect is drawn from: chance, typical values, and the runs that will be made."""

    rng: np.random.Generator
    values: dict[str, float]
    case: Case

    def place_passed(self) -> tuple[float, float]:
        """Where a run is at some time in its middle."""
        plan = self.case.plans[int(self.rng.integers(len(self.case.plans)))]
        path = motion_of(self.case, plan, COARSE).one
        at = int(self.rng.uniform(0.3, 0.7) * len(path))
        return float(path[at, 0]), float(path[at, 1])


def _slip(lot: _Lot) -> dict[str, float]:
    """Creep, or a grip that lets go; not both, as either hides the other."""
    name = "mu" if lot.rng.random() < 0.5 else "creep_compliance"
    return {name: lot.values[name]}


def _tilt(lot: _Lot) -> dict[str, float]:
    """One slope, in any direction."""
    slope, way = 1.4e-3, lot.rng.uniform(-math.pi, math.pi)
    return {"tilt_x": slope * math.cos(way), "tilt_y": slope * math.sin(way)}


def _patch(lot: _Lot) -> dict[str, float]:
    """A circle round a place where a run passes, or an edge through it."""
    x, y = lot.place_passed()
    drag = {"multiplier": 1 + lot.values["multiplier"] / 2}
    if lot.rng.random() < 0.5:
        return {**drag, "x": x, "y": y, "radius": float(lot.rng.uniform(0.15, 0.4))}
    normal = float(lot.rng.uniform(-math.pi, math.pi))
    return {**drag, "normal": normal, "edge_x": x, "edge_y": y}


def _tether(lot: _Lot) -> dict[str, float]:
    """Tied to a place somewhat off a run, and taut for a part of it."""
    x, y = lot.place_passed()
    dx, dy = lot.rng.uniform(-0.3, 0.3, 2)
    return {**lot.values, "x": float(x + dx), "y": float(y + dy)}


def _limit(lot: _Lot) -> dict[str, float]:
    """Just below the fastest rate that is asked for."""
    fastest = max(plan.gait.peak_rate for plan in lot.case.plans)
    return {"rate_limit": float(fastest * lot.rng.uniform(0.8, 0.95))}


_OWN_WAY = {
    "lateral_slip": _slip,
    "floor_tilt": _tilt,
    "floor_patch": _patch,
    "tether": _tether,
    "servo_rate_limit": _limit,
}
