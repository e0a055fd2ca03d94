"""What a hidden effect is: a name, its parameters, how they are drawn, and how it enters a rig.

An effect of the catalogue may have several realisations: different physics that a user would call
by the same name. Each is a `HiddenEffect` of its own.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from rr_lab.rig import Rig
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Robot

Values = Mapping[str, float]


@dataclass(frozen=True)
class Parameter:
    """A parameter of an effect.

    typical  a size that is clearly seen in a recording of half a minute
    neutral  the value at which it does nothing; inf for a limit. None: its size is no measure of
             strength (a place, a direction), and it stays as it was drawn
    most     the largest deviation from neutral that is still believable, or for a limit the least
             value
    signed   whether it may have either sign
    plant    whether it is the laboratory's own: no parameter of the catalogue, so never scored
    """

    name: str
    unit: str
    typical: float
    neutral: float | None = 0.0
    most: float = math.inf
    signed: bool = False
    plant: bool = False

    def scaled(self, value: float, factor: float) -> float:
        """The value `factor` times as far from neutral, within what is believable."""
        if self.neutral is None:
            return value
        if self.neutral == math.inf:
            return max(value / factor, self.most)
        away = factor * (value - self.neutral)
        return self.neutral + min(max(away, -self.most), self.most)


@dataclass(frozen=True)
class Setting:
    """What drawn values may depend on.

    gaits   of the runs that will be recorded
    passed  a place (m) that one of the runs passes in its middle, drawn anew at each call
    """

    rng: np.random.Generator
    robot: Robot
    gaits: tuple[SineGait, ...]
    passed: Callable[[], tuple[float, float]]


Enter = Callable[[Rig, Values], None]


def adds(attribute: str, *names: str) -> Enter:
    """Adds parameters to an attribute of the rig: one to a number, several to a list in order. One
    that is not given adds nothing."""

    def enter(rig: Rig, values: Values) -> None:
        more = [values.get(name, 0.0) for name in names]
        before = getattr(rig, attribute)
        if isinstance(before, list):
            setattr(rig, attribute, [one + by for one, by in zip(before, more, strict=True)])
        else:
            setattr(rig, attribute, before + values[names[0]])

    return enter


@dataclass(frozen=True)
class HiddenEffect:
    """An effect that the laboratory can hide.

    what         one sentence for the sealed answer
    enter        changes a rig by the values of the parameters; those not given are neutral
    realisation  which physics of that name; empty where there is only one
    named        whether it is in the catalogue, so that a diagnosis can name it
    also         parameters that may be given, and are never drawn
    draw         (setting, each parameter of about its typical size, either sign where it may) ->
                 values that belong together; None: as they are
    derived      (nominal robot, values) -> parameters of the catalogue that follow from them
    sizes        the range of effect sizes, sigma, in which it is what it is called; None: any
    same_as      other names of the catalogue for the same motion
    """

    name: str
    what: str
    parameters: tuple[Parameter, ...]
    enter: Enter
    realisation: str = ""
    named: bool = True
    also: tuple[Parameter, ...] = ()
    draw: Callable[[Setting, Values], Values] | None = None
    derived: Callable[[Robot, Values], Mapping[str, float]] | None = None
    sizes: tuple[float, float] | None = None
    same_as: tuple[str, ...] = ()

    @property
    def key(self) -> str:
        """Of this realisation: `servo_backlash/frictional`, or the name where there is one only."""
        return f"{self.name}/{self.realisation}" if self.realisation else self.name

    @property
    def accepted(self) -> dict[str, Parameter]:
        """By name: every parameter that may be given."""
        return {each.name: each for each in (*self.parameters, *self.also)}

    def drawn(self, setting: Setting) -> Values:
        """Random values of about their typical size."""
        rng, values = setting.rng, {}
        for each in self.parameters:
            size = each.typical * math.exp(rng.uniform(-0.7, 0.7))
            sign = rng.choice([-1, 1]) if each.signed else 1
            values[each.name] = float(sign * size)
        return self.draw(setting, values) if self.draw else values
