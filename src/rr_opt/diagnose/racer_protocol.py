"""What those who look closer at a Roller Racer need of its model, beyond `model.Model`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from rr_opt.diagnose.model import Array, Model, Piece
from rr_opt.diagnose.shoot import DrivePath, DriveSlopes


class Racer(Model, Protocol):
    """A model whose motion is driven by a joint's angle."""

    @property
    def nominal(self) -> dict[str, float]:
        """Every value of the robot as it is believed to be and of all effects, SI."""
        ...

    def every(self, effects: tuple[str, ...]) -> tuple[str, ...]:
        """The effects with those that the nominal robot has already."""
        ...

    def angle(self, run: int, given: Mapping[str, float], effects: tuple[str, ...]) -> Array:
        """phi (n,) of a run, rad, at the samples."""
        ...

    def drive_path(
        self, piece: Piece, given: Mapping[str, float], effects: tuple[str, ...]
    ) -> DrivePath:
        """The drive over the steps between the samples of a piece."""
        ...

    def drive_slopes(
        self,
        piece: Piece,
        given: Mapping[str, float],
        effects: tuple[str, ...],
        wanted: tuple[str, ...],
    ) -> DriveSlopes | None:
        """How the drive changes with what is wanted; None if it does not."""
        ...
