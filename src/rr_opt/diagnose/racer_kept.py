"""What was computed last of each piece of a run, as a fit asks for it again at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from rr_opt.diagnose.gram import Recorded
from rr_opt.diagnose.model import Array, Piece
from rr_opt.diagnose.shoot import DrivePath, Path, System, predict_all
from rr_opt.physics.drive import Drive


class Kept:
    """The last drive and the last prediction of each piece, and what was recorded of it."""

    def __init__(self) -> None:
        self._paths: dict[Piece, tuple[Drive, float, tuple[str, ...], DrivePath]] = {}
        self._made: dict[Piece, tuple[System, DrivePath, Array, Array, Path]] = {}
        self._recorded: dict[Piece, Recorded] = {}

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
        self, system: System, asked: Sequence[tuple[Piece, DrivePath, Array, Array]]
    ) -> Sequence[Path]:
        """The predictions of pieces along their drives, from states, with p; what is asked for
        next are their derivatives."""
        missing = [one for one in asked if not self._has(system, *one)]
        made = predict_all(system, [one[1:] for one in missing])
        for (piece, path, state, p), one in zip(missing, made, strict=True):
            self._made[piece] = system, path, state, p, one
        return [self._made[piece][-1] for piece, *_ in asked]

    def _has(self, system: System, piece: Piece, path: DrivePath, state: Array, p: Array) -> bool:
        kept = self._made.get(piece)
        return (
            kept is not None
            and (kept[0] is system and kept[1] is path)
            and np.array_equal(kept[2], state)
            and np.array_equal(kept[3], p)
        )

    def recorded(self, piece: Piece, make: Callable[[], Recorded]) -> Recorded:
        """What was recorded of a piece."""
        if piece not in self._recorded:
            self._recorded[piece] = make()
        return self._recorded[piece]
