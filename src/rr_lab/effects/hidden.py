"""What a hidden effect is: a name, its parameters, and how it gets into a rig."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from rr_lab.rig import Rig

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
    """

    name: str
    unit: str
    typical: float
    neutral: float | None = 0.0
    most: float = math.inf
    signed: bool = False

    def scaled(self, value: float, factor: float) -> float:
        """The value `factor` times as far from neutral, within what is believable."""
        if self.neutral is None:
            return value
        if self.neutral == math.inf:
            return max(value / factor, self.most)
        away = factor * (value - self.neutral)
        return self.neutral + min(max(away, -self.most), self.most)


@dataclass(frozen=True)
class HiddenEffect:
    """An effect that the laboratory can hide.

    enter    changes a rig by the values of the parameters; those not given are neutral
    named    whether it is in the catalogue, so that a diagnosis can name it
    further  what else a robot file may say of it: it is not drawn by lot
    what     one sentence for the sealed answer
    """

    name: str
    what: str
    parameters: tuple[Parameter, ...]
    enter: Callable[[Rig, Values], None]
    named: bool = True
    further: frozenset[str] = frozenset()

    def parameter(self, name: str) -> Parameter:
        """By name; raises KeyError."""
        return {each.name: each for each in self.parameters}[name]
