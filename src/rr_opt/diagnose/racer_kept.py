"""What was computed last of each piece of a run, as a fit asks for it again at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from rr_opt.diagnose.gram import Recorded
from rr_opt.diagnose.linear import DriveSlopes
from rr_opt.diagnose.model import Array, Piece
from rr_opt.diagnose.shoot import DrivePath, Path, System, predict_all
from rr_opt.physics.drive import Drive


class Kept:
    """The last drive of each piece, how it changes, and the last prediction; and what was recorded
    of it."""

    def __init__(self) -> None:
        self._paths: dict[Piece, tuple[Drive, float, tuple[str, ...], DrivePath]] = {}
        self._slopes: dict[Piece, tuple[DrivePath, tuple[str, ...], DriveSlopes | None]] = {}
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

    def slopes(
        self,
        piece: Piece,
        path: DrivePath,
        wanted: tuple[str, ...],
        make: Callable[[], DriveSlopes | None],
    ) -> DriveSlopes | None:
        """How the drive over a piece changes with what is wanted, anew if either is another."""
        kept = self._slopes.get(piece)
        if kept is None or kept[0] is not path or kept[1] != wanted:
            kept = self._slopes[piece] = path, wanted, make()
        return kept[2]

    def predicted(
        self, system: System, asked: Sequence[tuple[Piece, DrivePath, Array, Array]]
    ) -> Sequence[Path]:
        """The predictions of pieces along their drives, from states, with p; what is asked for
        next are their derivatives."""
        found = [self._made_before(system, *one) for one in asked]
        missing = [k for k, one in enumerate(found) if one is None]
        made = dict(zip(missing, predict_all(system, [asked[k][1:] for k in missing]), strict=True))
        for k, one in made.items():
            self._made[asked[k][0]] = system, *asked[k][1:], one
        return [made[k] if one is None else one for k, one in enumerate(found)]

    def _made_before(
        self, system: System, piece: Piece, path: DrivePath, state: Array, p: Array
    ) -> Path | None:
        kept = self._made.get(piece)
        if kept is None or kept[0] is not system or kept[1] is not path:
            return None
        alike = np.array_equal(kept[2], state) and np.array_equal(kept[3], p)
        return kept[-1] if alike else None

    def recorded(self, piece: Piece, make: Callable[[], Recorded]) -> Recorded:
        """What was recorded of a piece."""
        if piece not in self._recorded:
            self._recorded[piece] = make()
        return self._recorded[piece]
