"""The experiment file's `uncertainty`: how well each nominal value is known."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Annotated, Any

from pydantic import Field, create_model

from rr_opt.experiment.experiment import Uncertainty
from rr_opt.files.experiment.spread import Spread, Uncertain
from rr_opt.files.robot_model import FileModel
from rr_opt.robot.parameters import Robot

_UNITS = {"m": "kg", "I": "kg m^2", "c": "m", "a": "m", "b": "m", "kappa": "N m s"}
"""Groups: each stands for the value of both platforms, `m` for `m1` and `m2`."""
_MEANINGS = {
    "m": "masses",
    "I": "moments of inertia",
    "c": "distances from axle to joint",
    "a": "distances from axle to centre of mass",
    "b": "half tracks",
    "kappa": "viscous wheel frictions",
    "h": "wheel radius",
}
_DEFAULTS: dict[str, Any] = {
    "m": "1 %",
    "I": "5 %",
    "c": "2 mm",
    "a": "2 mm",
    "b": "2 mm",
    "h": "0.5 mm",
    "kappa": "unknown",
}
_ZEROS = ("psi_zero", "phi_zero")
_EXAMPLES = {"kg": "5 g", "kg m^2": "1e-4", "m": "2 mm", "N m s": "1e-6"}


def _fields() -> Iterator[tuple[str, Any]]:
    def optional(name: str, unit: str, example: str, description: str, absolute: bool) -> Any:
        kind = Annotated[Spread | None, Uncertain(unit, example, absolute)]
        standard = f" Default: {_DEFAULTS[name]}." if name in _DEFAULTS else ""
        return kind, Field(default=None, description=f"One sigma of {description}.{standard}")

    for key, unit in _UNITS.items():
        yield key, optional(key, unit, _EXAMPLES[unit], f"the {_MEANINGS[key]}, {unit}", False)
        for number in "12":
            told = f"platform {number}'s {key}, {unit}"
            yield f"{key}{number}", optional(f"{key}{number}", unit, _EXAMPLES[unit], told, False)
    yield "h", optional("h", "m", "0.5 mm", "the wheel radius, m", False)
    for key in _ZEROS:
        yield key, optional(key, "rad", "5 mrad", f"the zero of {key[:3]}, rad; else exact", True)


UncertaintyModel: Any = create_model(
    "UncertaintyModel",
    __base__=FileModel,
    __doc__="How well nominal values are known: `2 mm`, `5 %`, or `unknown`, free within a factor "
    "of 5. `m` stands for `m1` and `m2`, which go before it; 0 is exact.",
    **dict(_fields()),
)


def uncertainty_of(model: Any, robot: Robot) -> Mapping[str, Uncertainty]:
    """By parameter (m1, I1, ..., kappa2, h, psi_zero, phi_zero): as written, else the default."""
    standard = UncertaintyModel(**_DEFAULTS)
    found: dict[str, Uncertainty] = {}
    for number, platform in (("1", robot.platform1), ("2", robot.platform2)):
        for key in _UNITS:
            options = (
                getattr(model, f"{key}{number}"),
                getattr(model, key),
                getattr(standard, key),
            )
            spread = next(one for one in options if one is not None)
            found[f"{key}{number}"] = spread.of(getattr(platform, key))
    found["h"] = (model.h or standard.h).of(robot.h)
    for key in _ZEROS:
        if getattr(model, key) is not None:
            found[key] = getattr(model, key).of(0.0)
    return MappingProxyType(found)


def shares_of_nothing(model: Any, robot: Robot) -> Iterator[tuple[str, str]]:
    """Key and message of every share, or factor, of a value that is 0: it says nothing."""
    for key in model.model_fields_set:
        spread = getattr(model, key)
        name = key.rstrip("12")
        if name not in _UNITS or spread is None or spread.sigma:
            continue
        numbers = "12" if key == name else key[-1]
        zeros = [
            f"{name}{one}"
            for one in numbers
            if getattr(robot.platform1 if one == "1" else robot.platform2, name) == 0
        ]
        if zeros and (spread.relative or spread.factor):
            yield (
                key,
                f"The nominal {' and '.join(zeros)} is 0, and any share or multiple of it is 0: "
                "it would be taken as exact. Write an absolute value, such as "
                f"`{_EXAMPLES[_UNITS[name]]}`.",
            )
