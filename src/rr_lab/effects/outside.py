"""Effects that the catalogue does not have, so that no diagnosis can name them."""

from __future__ import annotations

from rr_lab.effects.hidden_effect import HiddenEffect, Parameter, Setting, Values, place
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


_STIFFNESS = Parameter("stiffness", "N/m", 0.02, most=2.0)
_POST = (place("slack", typical=0.1), place("x", typical=0.3), place("y", typical=0.3))
_SPEED = place("speed", "m/s", 0.05)
_TIME, _SPRING = place("time", "s", 10.0), place("stiffness", "N/m", 5.0)

OUTSIDE = (
    HiddenEffect("tether", "a cord to a post pulls when it is taut",
                 (_STIFFNESS, *_POST), _tether, named=False, draw=_beside_a_path),
    HiddenEffect("stribeck_friction", "dry friction of the wheels that falls as they turn faster",
                 (Parameter("force", "N", 4e-3, most=0.1), _SPEED), _stribeck, named=False),
    HiddenEffect("drifting_friction", "viscous friction that changes while the robot runs",
                 (Parameter("change", "1", 0.8, most=4.0), _TIME), _drift, named=False),
    HiddenEffect("compliant_platform", "the platforms bend sideways",
                 (Parameter("give", "rad/(N m)", 0.3, most=5.0),), _sprung, named=False),
    HiddenEffect("wheel_fault", "one wheel rubs over a part of each turn",
                 (Parameter("force", "N", 0.02, most=0.3),), _fault, named=False),
    HiddenEffect("loose_pin", "the joint's pin has clearance",
                 (Parameter("clearance", "m", 3e-3, most=0.01),), _pin, named=False),
    HiddenEffect("shifting_load", "a load on platform 1 shifts sideways on a spring",
                 (Parameter("mass", "kg", 0.08, most=0.2), _SPRING), _load, named=False),
    HiddenEffect("dragged_cable", "a cable drags on the floor behind platform 2",
                 (Parameter("force", "N", 8e-3, most=0.3),), _cable, named=False),
)  # fmt: skip
