"""The recorded runs of a Roller Racer, simulated: predicted, and differentiated."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property, lru_cache
from typing import Protocol

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.effects import CATALOGUE
from rr_opt.machines.racer.drive import Drives, drive_path, drive_slopes, grain, lateness, steps_of
from rr_opt.machines.racer.parameters import ZERO_OFFSET, ZEROS, values_by, values_of
from rr_opt.mechanics.drive import Drive
from rr_opt.mechanics.kinematics import ROBOT_PARAMETERS
from rr_opt.model.experiment import Run
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot
from rr_opt.motion.floor_motion import FloorMotion, floor_motion
from rr_opt.sysid.model import Asked, Data, Model, Piece, Response
from rr_opt.sysid.sensitivities import DriveSlopes, Recorded, Sought, grams, slopes
from rr_opt.sysid.shooting import DrivePath, Path, System, predict_all


@lru_cache
def driven(effects: tuple[str, ...]) -> tuple[System, FloorMotion]:
    """The motion with these effects, the same for every recording."""
    motion = floor_motion(effects)
    return System(motion.rates, motion.observed, stiff_states(motion), lasts=True), motion


def stiff_states(motion: FloorMotion) -> int:
    """How many states settle at once: the speeds of axles that slip."""
    return len(motion.free) if motion.slips else 0


HELD = 4
"""So many numbers of a start belong to a robot whose axles are held."""


def state_of(effects: tuple[str, ...], path: DrivePath, start: Array, p: Array) -> Array:
    """The state that belongs to a start: to x, y, psi, z = v - g dphi, and both axles' side speeds.

    z is 0 of a robot at rest. Where the axles may slip the state holds v instead, and where they
    may not there are no side speeds.
    """
    if not floor_motion(effects).slips:
        return start[:HELD]
    speeds = floor_motion().speeds
    v = float(speeds(start[:HELD], path.at[:2, 0], p[: len(ROBOT_PARAMETERS)])[0])
    return np.array([*start[: HELD - 1], v, *start[HELD:]])


def v_of_z_by(
    path: DrivePath, start: Array, p: Array, by: Array, drive_by: DriveSlopes | None
) -> Array:
    """How the v that belongs to a start's z changes with what is asked for, (nw,)."""
    v_by = _v_by()
    known = len(ROBOT_PARAMETERS)
    slope = np.asarray(v_by(start[:HELD], path.at[:2, 0], p[:known]))[0]
    own = slope[2:] @ by[:known]
    return own if drive_by is None else own + slope[:2] @ drive_by.at[:2, 0]


_MOMENT = 0.25
"""s, in which a parabola tells the speeds with which a piece begins."""


def side_speeds(robot: Robot, gait: Gait, t: Array, values: Array) -> Array:
    """Side speeds (2,) of both axles, m/s, at the first of the samples (n, channels) of a piece."""
    good = (t - t[0] <= _MOMENT) & np.isfinite(values[:, :3]).all(axis=1)
    if good.sum() < 2 * 3:
        return np.zeros(2)
    powers = np.vander(t[good] - t[0], 3, increasing=True)
    (_, _, psi), (vx, vy, w), _ = np.linalg.lstsq(powers, values[good, :3], rcond=None)[0]
    phi, dphi = float(gait.angle(t[0])), float(gait.rate(t[0]))
    ahead = psi, psi + phi
    to_left = [vy * np.cos(way) - vx * np.sin(way) for way in ahead]
    return np.array(
        [to_left[0] + robot.platform1.c * w, to_left[1] - robot.platform2.c * (w + dphi)]
    )


def by_start_of(by_state: Array, start: Array) -> Array:
    """Derivatives (n, channels, start) from those by the state that belongs to it."""
    held = start.size - by_state.shape[2]
    return np.pad(by_state, ((0, 0), (0, 0), (0, held)))


@lru_cache
def _v_by() -> ca.Function:
    """(state, drive, p) -> the derivatives of v by the drive and by p, (1, 2 + np)."""
    speeds = floor_motion().speeds
    state, drive, p = speeds.sx_in()
    by = ca.densify(ca.jacobian(speeds(state, drive, p)[0], ca.vertcat(drive, p)))
    return ca.Function("v_by", [state, drive, p], [by])


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
