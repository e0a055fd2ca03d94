"""Effects that the catalogue does not have, so that no diagnosis can name them."""

from __future__ import annotations

from rr_lab.effects.hidden_effect import Setting, Values
from rr_lab.laws import Drift, Falling, Rub
from rr_lab.rig import Rig, Tether


def _tether(rig: Rig, values: Values) -> None:
    rig.tether = Tether(values["x"], values["y"], values["slack"], values["stiffness"])


def _beside_a_path(setting: Setting, values: Values) -> Values:
    """Tied to a place somewhat off a run, and taut for a part of it."""
    x, y = setting.passed()
    dx, dy = setting.rng.uniform(-0.3, 0.3, 2)
    return {**values, "x": float(x + dx), "y": float(y + dy)}


def _stribeck(rig: Rig, values: Values) -> None:
    """Dry friction that falls from `force` to `force/3` as the rim's speed grows past `speed`."""
    h = rig.robot.h
    rig.laws.append(Falling(values["force"] * h, values["speed"] / h))


def _drift(rig: Rig, values: Values) -> None:
    rig.laws.append(Drift(values["change"], values["time"]))


def _sprung(rig: Rig, values: Values) -> None:
    """`give` is 1/stiffness."""
    rig.spring = 1 / values["give"]


def _fault(rig: Rig, values: Values) -> None:
    rig.laws.append(Rub(values["force"] * rig.robot.h))


def _pin(rig: Rig, values: Values) -> None:
    """The platforms can shift against each other by the clearance, up to hard stops."""
    rig.pin = values["clearance"]


def _cable(rig: Rig, values: Values) -> None:
    rig.cable = values["force"]


def _load(rig: Rig, values: Values) -> None:
    rig.load = (values["mass"], values["stiffness"])


FUNCTIONS = (_tether, _beside_a_path, _stribeck, _drift, _sprung, _fault, _pin, _cable, _load)
