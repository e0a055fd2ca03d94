"""What an effect is: data, and the one port where it enters the mechanism."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum

import casadi as ca

from rr_opt.physics.kinematics import Mechanism


class Port(StrEnum):
    """Where an effect enters; see the package `rr_opt.physics`."""

    ACTUATION = "actuation"
    CONSTRAINT = "constraint"
    FORCE = "force"
    MASS = "mass"
    MEASUREMENT = "measurement"


@dataclass(frozen=True)
class Parameter:
    """A parameter of an effect.

    unit     as pint reads it
    bounds   where it makes sense, in that unit
    typical  its usual size
    neutral  the value at which the effect vanishes
    aliases  other names under which a robot file may give it
    """

    name: str
    unit: str
    bounds: tuple[float, float]
    typical: float
    neutral: float = 0.0
    aliases: tuple[str, ...] = ()


@dataclass(frozen=True)
class Effect:
    """An effect: what it is called, what it says, and how it changes the mechanism.

    `enter(mechanism, values)` returns the mechanism with the effect in it; values maps each
    parameter's name to its symbol.
    """

    name: str
    family: str
    port: Port
    parameters: tuple[Parameter, ...]
    sentence: str
    enter: Callable[[Mechanism, Mapping[str, ca.SX]], Mechanism]
