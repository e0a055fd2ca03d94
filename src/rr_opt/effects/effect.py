"""What an effect is: data, and the one port where it enters the mechanism."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

import casadi as ca

from rr_opt.mechanics.drive import Drive, FreeJoint
from rr_opt.mechanics.kinematics import Mechanism, Seen
from rr_opt.model.robot import Robot


class Port(StrEnum):
    """Where an effect enters; see `rr_opt.effects`."""

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
    natural  what would be usual for a given robot and what was asked of it, where that depends on
             them: a value as large as `typical` would be for the paper's prototype
    trials   from where to look for it, in natural sizes from neutral (absolute ones, if neutral is
             not zero): more than one where the way from the first may lead nowhere
    placed   where to look for it is told by the recordings alone
    rough    there are as many models of it as machines
    vague    and by such a share of its value, one sigma, do they differ in it
    least    a fit goes no lower, as the effect turns into another there
    most     nor higher than this, for a given robot and what was asked of it
    """

    name: str
    unit: str
    bounds: tuple[float, float]
    typical: float
    neutral: float = 0.0
    aliases: tuple[str, ...] = ()
    natural: Callable[[Setting], float] | None = None
    trials: tuple[float, ...] = (0.05,)
    placed: bool = False
    rough: bool = False
    vague: float = 0.0
    least: float = -math.inf
    most: Callable[[Setting], float] | None = None

    def size(self, setting: Setting) -> float:
        """Its usual size for a robot and what was asked of it."""
        return self.natural(setting) if self.natural else self.typical


@dataclass(frozen=True)
class Setting:
    """A robot, and the largest speeds asked of it.

    rate   of the servo, rad/s
    speed  of the wheels, m/s
    room   across all places where it was, m
    """

    robot: Robot
    rate: float
    speed: float
    room: float = math.inf


class Actuate(Protocol):
    """What a servo makes of the angle that it is told."""

    def __call__(
        self, told: Drive, values: Mapping[str, float], joint: FreeJoint | None = None, /
    ) -> Drive:
        """`joint`: the joint while the servo does not hold it; None if nothing is known of it."""
        ...


@dataclass(frozen=True)
class Effect:
    """An effect: what it is called, what it says, and what it changes, at one port.

    enter    (mechanism, symbols) -> the mechanism with the effect in it: constraint, mass, force
    actuate  (told, values, joint) -> the angle that the servo makes of the one that it is told:
             actuation
    observe  (seen, symbols) -> what is recorded of what there is to see: measurement
    delay    the parameter by which the recording's clock is behind the command's: measurement
    stiff    whether it lets the axles slip, which they stop doing at once
    loose    whether the joint swings by itself, so that the robot's values count for its angle
    sharp    whether its force all but jumps with the speed, so that predictions take short steps
    smooth   whether it has derivatives by its parameters where it vanishes
    nameless no candidate of a diagnosis: a curve that imitates what has no name, or what an
             experiment says of itself
    forms    which parameters are looked for together; one form of them all, if none is given
    imitates effects with no more parameters that a form of this one comes close to

    `symbols` and `values` map each parameter's name to its symbol or its value, SI.
    """

    name: str
    family: str
    port: Port
    parameters: tuple[Parameter, ...]
    sentence: str
    enter: Callable[[Mechanism, Mapping[str, ca.SX]], Mechanism] | None = None
    actuate: Actuate | None = None
    observe: Callable[[Seen, Mapping[str, ca.SX]], Seen] | None = None
    delay: str | None = None
    stiff: bool = False
    loose: bool = False
    sharp: bool = False
    smooth: bool = True
    nameless: bool = False
    forms: tuple[tuple[str, ...], ...] = ()
    imitates: tuple[str, ...] = ()
