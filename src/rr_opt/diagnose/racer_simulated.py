"""The recorded runs of a Roller Racer, simulated: predicted, and differentiated."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property

import numpy as np

from rr_opt.diagnose.gram import Recorded, Sought, grams
from rr_opt.diagnose.linear import DriveSlopes, slopes
from rr_opt.diagnose.model import Array, Asked, Data, Piece, Response
from rr_opt.diagnose.racer_drive import Drives, drive_slopes, grain, lateness
from rr_opt.diagnose.racer_kept import Kept
from rr_opt.diagnose.racer_quantities import ZERO_OFFSET, ZEROS, values_by, values_of
from rr_opt.diagnose.racer_state import by_start_of, state_of, v_of_z_by
from rr_opt.diagnose.racer_steps import drive_path, steps_of
from rr_opt.diagnose.racer_system import driven
from rr_opt.diagnose.shoot import DrivePath, Path
from rr_opt.experiment.experiment import Run
from rr_opt.physics.effects import CATALOGUE

_V = 3
"""Which number of a start is z, and of a state, where the axles may slip, v."""


class Simulated:
    """Simulates pieces of the runs with any effects of the catalogue.

    nominal  every value of the robot as it is believed to be and of all effects, SI
    built_in  the effects that it has already
    """

    def __init__(
        self,
        runs: Sequence[Run],
        data: Sequence[Data],
        nominal: Mapping[str, float],
        built_in: frozenset[str],
    ) -> None:
        self._runs, self._data, self._nominal, self.built_in = runs, data, nominal, built_in
        self._kept = Kept()

    def every(self, effects: tuple[str, ...]) -> tuple[str, ...]:
        """The effects with those that the nominal robot has already, in the catalogue's order."""
        return tuple(name for name in CATALOGUE if name in effects or name in self.built_in)

    @cached_property
    def _drives(self) -> Drives:
        """What the servo makes of the gaits."""
        return Drives(self._runs)

    def angle(self, run: int, given: Mapping[str, float], effects: tuple[str, ...]) -> Array:
        """phi (n,) of a run as the servo makes it and it is told, rad, at the samples."""
        mechanical = self.every(effects)
        drive = self._drives.of(run, given, mechanical)
        phi = drive.at(self._data[run].t + lateness(given, mechanical))[0]
        return phi + given[ZEROS[f"{ZERO_OFFSET}.phi"]]

    def drive_path(
        self, piece: Piece, given: Mapping[str, float], effects: tuple[str, ...]
    ) -> DrivePath:
        """The drive over the steps between the samples of a piece: most fits leave it as it is."""
        drive, late = self._drives.of(piece.run, given, effects), lateness(given, effects)
        t = self._data[piece.run].t[piece.span]
        return self._kept.path(
            *(piece, drive, late, effects),
            lambda: drive_path(drive, steps_of(drive, t, late, **grain(effects)), late),
        )

    def drive_slopes(
        self,
        piece: Piece,
        given: Mapping[str, float],
        effects: tuple[str, ...],
        wanted: tuple[str, ...],
    ) -> DriveSlopes | None:
        """How the drive changes with what is wanted; None if it does not."""
        t = self._data[piece.run].t[piece.span]
        return self._kept.slopes(
            *(piece, self.drive_path(piece, given, effects), wanted),
            lambda: drive_slopes(self._drives, piece.run, t, given, effects, wanted),
        )

    def respond(
        self,
        piece: Piece,
        values: Mapping[str, float],
        effects: tuple[str, ...],
        start: Array,
        wanted: tuple[str, ...] | None = None,
    ) -> Response:
        """Predict a piece of a run; see `diagnose.model.Model`."""
        mechanical = self.every(effects)
        system, motion = driven(mechanical)
        ((path, made, p, given),) = self._predicted([Asked(piece, values, start)], mechanical)
        if wanted is None:
            return Response(made.seen)
        by = values_by(given, motion.parameters, wanted)
        drive_by = self.drive_slopes(piece, given, mechanical, wanted)
        out = slopes(system, path, made, p, by, drive_by)
        by_value = out.by_parameter
        if motion.slips:
            # The start is given in z and the state holds v, which moves with what is asked.
            v_by = v_of_z_by(path, start, p, by, drive_by)
            by_value = by_value + out.by_start[:, :, _V : _V + 1] * v_by
        return Response(made.seen, by_value, by_start_of(out.by_start, start))

    def predicted(self, asked: Sequence[Asked], effects: tuple[str, ...]) -> list[Array]:
        """What is seen of each piece (n, channels)."""
        return [made.seen for _, made, _, _ in self._predicted(asked, self.every(effects))]

    def off(self, asked: Sequence[Asked], effects: tuple[str, ...]) -> Sequence[Array]:
        """(predicted - recorded)/sigma; see `diagnose.model.Model`."""
        made = self._predicted(asked, self.every(effects))
        return [
            self._recorded(a.piece).off(m.seen) for a, (_, m, _, _) in zip(asked, made, strict=True)
        ]

    def grams(
        self,
        asked: Sequence[Asked],
        effects: tuple[str, ...],
        wanted: tuple[str, ...],
        stray: Callable[[Array], Array] | None = None,
    ) -> Sequence[Array]:
        """J'J of each piece; see `diagnose.model.Model`; stray: of what is predicted."""
        mechanical = self.every(effects)
        system, motion = driven(mechanical)
        sought, turns = [], []
        for one, (path, made, p, given) in zip(
            asked, self._predicted(asked, mechanical), strict=True
        ):
            by = values_by(given, motion.parameters, wanted)
            drive_by = self.drive_slopes(one.piece, given, mechanical, wanted)
            more = stray(made.seen)[:, :, None] if stray else None
            sought.append(Sought(path, made, p, by, drive_by, self._recorded(one.piece), more))
            v_by = v_of_z_by(path, one.start, p, by, drive_by) if motion.slips else None
            turns.append(_turn(motion.size, one.start.size, len(wanted), v_by, stray is not None))
        return [
            turn.T @ gram @ turn for turn, gram in zip(turns, grams(system, sought), strict=True)
        ]

    def _predicted(
        self, asked: Sequence[Asked], mechanical: tuple[str, ...]
    ) -> list[tuple[DrivePath, Path, Array, dict[str, float]]]:
        """Each piece's drive and prediction, and the values of all it is predicted with."""
        system, motion = driven(mechanical)

        # Most pieces that are asked for at once are so with the same values.
        known = {}
        for values in {id(one.values): one.values for one in asked}.values():
            given = {**self._nominal, **values}
            known[id(values)] = given, values_of(given, motion.parameters)
        ready = []
        for one in asked:
            given, p = known[id(one.values)]
            path = self.drive_path(one.piece, given, mechanical)
            ready.append((path, state_of(mechanical, path, one.start, p), p, given))
        made = self._kept.predicted(
            system, [(one.piece, *r[:3]) for one, r in zip(asked, ready, strict=True)]
        )
        return [(path, one, p, given) for (path, _, p, given), one in zip(ready, made, strict=True)]

    def _recorded(self, piece: Piece) -> Recorded:
        data = self._data[piece.run]
        return self._kept.recorded(
            piece, lambda: Recorded.of(data.values[piece.span], data.sigma[piece.span])
        )


def _turn(size: int, start: int, wanted: int, v_by: Array | None, stray: bool) -> Array:
    """Columns [state | wanted | stray | off] made into [start | stray | wanted | off].

    Of a start's numbers the state may not have all; v_by (wanted,) is how the v that belongs to
    its z changes with what is wanted.
    """
    columns = start + stray + wanted + 1
    turn = np.zeros((size + wanted + stray + 1, columns))
    held = min(size, start)
    turn[range(held), range(held)] = 1.0
    own = start + stray + np.arange(wanted)
    turn[size + np.arange(wanted), own] = 1.0
    if v_by is not None:
        turn[_V, own] = v_by
    if stray:
        turn[size + wanted, start] = 1.0
    turn[-1, -1] = 1.0
    return turn
