"""What was computed last of each piece of a run, as a fit asks for it again at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from rr_opt.diagnose.model import Array, Piece
from rr_opt.diagnose.shoot import DrivePath, Path, System, predict
from rr_opt.physics.drive import Drive


class Kept:
    """The last drive and the last prediction of each piece."""

    def __init__(self) -> None:
        self._paths: dict[Piece, tuple[Drive, float, tuple[str, ...], DrivePath]] = {}
        self._made: dict[Piece, tuple[System, DrivePath, Array, Array, Path]] = {}

    def __reduce__(self) -> tuple:
        """For another process: what is kept stays here."""
        return Kept, ()

    def path(
        self,
        piece: Piece,
        drive: Drive,
        late: float,
        effects: tuple[str, ...],
        make: Callable[[], DrivePath],
    ) -> DrivePath:
        """The drive over a piece, made anew if drive, lateness or effects are others."""
        kept = self._paths.get(piece)
        if kept is None or kept[0] is not drive or kept[1:3] != (late, effects):
            kept = self._paths[piece] = drive, late, effects, make()
        return kept[3]

    def predicted(
        self, piece: Piece, system: System, path: DrivePath, state: Array, p: Array
    ) -> Path:
        """The prediction of a piece; its derivatives are what is asked for next."""
        kept = self._made.get(piece)
        if (
            kept is not None
            and (kept[0] is system and kept[1] is path)
            and np.array_equal(kept[2], state)
            and np.array_equal(kept[3], p)
        ):
            return kept[4]
        made = predict(system, path, state, p)
        self._made[piece] = system, path, state, p, made
        return made
