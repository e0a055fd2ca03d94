"""What those who look closer at a Roller Racer need of its model, beyond `model.Model`."""

from __future__ import annotations

from typing import Protocol

from rr_opt.diagnose.model import Model
from rr_opt.diagnose.racer_simulated import Simulated


class Racer(Model, Protocol):
    """A model whose motion is driven by a joint's angle."""

    @property
    def nominal(self) -> dict[str, float]:
        """Every value of the robot as it is believed to be and of all effects, SI."""
        ...

    @property
    def simulated(self) -> Simulated:
        """Its runs, simulated."""
        ...
