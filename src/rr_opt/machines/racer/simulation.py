"""The recorded runs of a Roller Racer, simulated and linearised segment by segment.

The state is x, y, psi and z = v - g dphi, which does not jump with the servo's rate; where the
axles may slip it is x, y, psi, v and both side speeds.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.effects import CATALOGUE
from rr_opt.machines.racer.drive import (
    Drives,
    Grain,
    drive_path,
    drive_slopes,
    grain,
    jumping,
    lateness,
    neighbours,
    steps_of,
)
from rr_opt.machines.racer.parameters import ZERO_OFFSET, ZEROS, values_by, values_of
from rr_opt.mechanics.code_generation import ArrayFunction, over_arrays
from rr_opt.mechanics.drive import Drive
from rr_opt.mechanics.kinematics import ROBOT_PARAMETERS
from rr_opt.model.experiment import Run
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot
from rr_opt.motion.floor_motion import FloorMotion, floor_motion
from rr_opt.sysid.model import Data, Linearisation, Request, Segment, Simulation
from rr_opt.sysid.paths import DrivePath, DriveSlopes, Path, Recorded, Sought
from rr_opt.sysid.sensitivities import grams
from rr_opt.sysid.shooting import System, predict_all, prepare

V = 3
"""Index of z or v in the state."""


@lru_cache
def driven(
    effects: tuple[str, ...], idle: frozenset[str] = frozenset()
) -> tuple[System, FloorMotion]:
    """The motion with these effects, the same for every recording; without the terms of costly
    parameters that are idle: neutral."""
    motion = floor_motion(effects)
    rates = _without(motion, idle) if idle else motion.rates
    stiff, jumps = stiff_states(motion), jumping(effects)
    return System(rates, motion.observed, stiff, jumps=jumps, lasts=True), motion


@lru_cache
def speeds_of(effects: tuple[str, ...]) -> ArrayFunction:
    """The speeds of `FloorMotion`, over arrays."""
    return over_arrays(driven(effects)[1].speeds)


def _without(motion: FloorMotion, idle: frozenset[str]) -> ca.Function:
    """The rates without the terms of some parameters."""
    neutral, (state, drive, p) = _costly(motion.effects), motion.rates.sx_in()
    known = (neutral[one] if one in idle else p[k] for k, one in enumerate(motion.parameters))
    rates = ca.substitute(motion.rates(state, drive, p), p, ca.vertcat(*known))
    return ca.Function("rates", [state, drive, p], [ca.cse(ca.simplify(rates))])


def _costly(effects: tuple[str, ...]) -> dict[str, float]:
    """The costly parameters, and where they are neutral."""
    every = ((name, q) for name in effects for q in CATALOGUE[name].parameters)
    return {f"{name}.{q.name}": q.neutral for name, q in every if q.costly}


def _shortest(
    effects: tuple[str, ...], every: Iterable[Mapping[str, float]], wanted: tuple[str, ...] = ()
) -> tuple[System, FloorMotion]:
    """The motion with few terms that serves all of these values and derivatives."""
    costly = {name: at for name, at in _costly(effects).items() if name not in wanted}
    values = [*every]
    idle = (name for name, at in costly.items() if all(given[name] == at for given in values))
    return driven(effects, frozenset(idle))


def stiff_states(motion: FloorMotion) -> int:
    """Number of stiff states: the speeds of axles that slip."""
    return len(motion.free) if motion.slips else 0


def slips(effects: Sequence[str]) -> bool:
    """Whether the axles may slip."""
    return any(CATALOGUE[name].stiff for name in effects)


_MOMENT = 0.25
"""s, over which a parabola estimates a segment's initial speeds."""


def side_speeds(robot: Robot, gait: Gait, t: Array, values: Array) -> Array:
    """Side speeds (2,) of both axles, m/s, at the first of the samples (n, channels)."""
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


@dataclass(frozen=True)
class Change:
    """Finite changes of a segment's prediction: of what is seen (samples, channels, k), and of the
    last state (size, k)."""

    seen: Array
    end: Array


_Simulated = tuple[DrivePath, Path, Array, dict[str, float]]


@dataclass(frozen=True)
class _DrivenRun:
    """A run's drive with some values, the lag of the recording's clock, and its steps."""

    given: Mapping[str, float]
    drive: Drive
    late: float
    grain: Grain
    effects: tuple[str, ...]
    path: DrivePath


def _same(some: Sequence[Request], others: Sequence[Request]) -> bool:
    """Whether the requests are the same, from the very same states."""
    return len(some) == len(others) and all(
        a.segment == b.segment and a.state is b.state and a.values == b.values
        for a, b in zip(some, others, strict=True)
    )


class Simulator:
    """Simulates segments of the runs with any effects of the catalogue.

    nominal   every value of the nominal robot and of all effects, SI
    built_in  the effects of the nominal robot
    """

    def __init__(
        self,
        runs: Sequence[Run],
        data: Sequence[Data],
        nominal: Mapping[str, float],
        built_in: frozenset[str],
    ) -> None:
        self._runs, self._data, self._nominal, self.built_in = runs, data, nominal, built_in
        self._driven: dict[int, _DrivenRun] = {}
        self._parts: dict[Segment, tuple[DrivePath, DrivePath]] = {}
        self._slopes: dict[int, tuple[DrivePath, tuple[str, ...], tuple, DriveSlopes | None]] = {}
        self._seen: dict[Segment, Recorded] = {}
        self._last: tuple[tuple[str, ...], Sequence[Request], list[_Simulated]] | None = None

    def every(self, effects: tuple[str, ...]) -> tuple[str, ...]:
        """The effects and those of the nominal robot, in the catalogue's order."""
        return tuple(name for name in CATALOGUE if name in effects or name in self.built_in)

    def given(self, values: Mapping[str, float]) -> dict[str, float]:
        """Every value, the nominal one where none is given."""
        return {**self._nominal, **values}

    @cached_property
    def drives(self) -> Drives:
        """The joint angles that the servo makes of the gaits."""
        return Drives(self._runs)

    def angle(self, run: int, values: Mapping[str, float], effects: tuple[str, ...]) -> Array:
        """phi (n,) of a run as made by the servo and recorded, rad, at the samples."""
        mechanical, given = self.every(effects), self.given(values)
        drive = self.drives.of(run, given, mechanical)
        phi = drive.at(self._data[run].t + lateness(given, mechanical))[0]
        return phi + given[ZEROS[f"{ZERO_OFFSET}.phi"]]

    def drive_path(
        self, segment: Segment, given: Mapping[str, float], effects: tuple[str, ...]
    ) -> DrivePath:
        """The drive over the steps between the samples of a segment; most fits leave it as it is.

        effects  all of them
        """
        whole, kept = self._whole(segment.run, given, effects).path, self._parts.get(segment)
        if kept is None or kept[0] is not whole:
            kept = self._parts[segment] = whole, whole.part(segment.first, segment.last)
        return kept[1]

    def _whole(self, run: int, given: Mapping[str, float], effects: tuple[str, ...]) -> _DrivenRun:
        kept = self._driven.get(run)
        if kept and kept.given is given and kept.effects == effects:
            return kept
        drive, late = self.drives.of(run, given, effects), lateness(given, effects)
        fine = grain(given, effects)
        as_before = kept and (kept.late, kept.grain, kept.effects) == (late, fine, effects)
        if kept and as_before and kept.drive is drive:
            path = kept.path
        else:
            steps = steps_of(drive, self._data[run].t, late, **fine)
            path = drive_path(drive, steps, late)
        self._driven[run] = _DrivenRun(given, drive, late, fine, effects, path)
        return self._driven[run]

    def drive_slopes(
        self,
        segment: Segment,
        given: Mapping[str, float],
        effects: tuple[str, ...],
        wanted: tuple[str, ...],
    ) -> DriveSlopes | None:
        """Derivatives of the drive by the wanted quantities; None if none moves it."""
        run, path = segment.run, self._whole(segment.run, given, effects).path
        own = tuple(given[name] for name in wanted if "." in name)
        kept = self._slopes.get(run)
        if kept is None or kept[0] is not path or kept[1:3] != (wanted, own):
            by = drive_slopes(self.drives, run, self._data[run].t, given, effects, wanted)
            kept = self._slopes[run] = path, wanted, own, by
        return kept[3] and kept[3].part(segment.first, segment.last, path.each)

    def recorded(self, segment: Segment) -> Recorded:
        """What was recorded of a segment: its last sample is the next one's first."""
        if segment not in self._seen:
            data = self._data[segment.run]
            values = data.values[segment.span].copy()
            values[segment.until - segment.first :] = np.nan
            self._seen[segment] = Recorded.of(values, data.weighted_sigma[segment.span])
        return self._seen[segment]

    def prepare(self, every: Iterable[tuple[str, ...]]) -> None:
        """Compile the motion with each of these sets of effects ahead."""
        sets = [self.every(one) for one in (*every, ())]
        *ahead, plain = (driven(one, frozenset(_costly(one)))[0] for one in sets)
        prepare(ahead, plain)

    def simulate(
        self, requests: Sequence[Request], effects: tuple[str, ...]
    ) -> Sequence[Simulation]:
        """Simulate segments; see `sysid.model.Model`."""
        return [
            Simulation(self.recorded(one.segment).off(made.seen), made.states[:, -1])
            for one, (_, made, _, _) in zip(requests, self.paths(requests, effects), strict=True)
        ]

    def linearise(
        self,
        requests: Sequence[Request],
        effects: tuple[str, ...],
        wanted: tuple[str, ...],
        changes: Sequence[Change] | None = None,
    ) -> Sequence[Linearisation]:
        """Linearise segments; see `sysid.model.Model`.

        changes  of each segment's prediction, as further columns after the wanted quantities
        """
        mechanical = self.every(effects)
        sought, paths = [], self.paths(requests, effects)
        known = {
            (one.segment.run, id(each[3])): each[3]
            for one, each in zip(requests, paths, strict=True)
        }
        beside = [
            (run, values)
            for (run, _), given in known.items()
            for values in neighbours(given, mechanical, wanted)
        ]
        self.drives.every(beside, mechanical)
        system, motion = _shortest(mechanical, known.values(), wanted)
        by = {id(given): values_by(given, motion.parameters, wanted) for given in known.values()}
        for one, (path, made, p, given) in zip(requests, paths, strict=True):
            drive_by = self.drive_slopes(one.segment, given, mechanical, wanted)
            seen = self.recorded(one.segment)
            sought.append(Sought(path, made, p, by[id(given)], drive_by, seen))
        if changes is None:
            return [Linearisation(gram, end) for gram, end in grams(system, sought)]
        sought = [
            replace(one, more=change.seen) for one, change in zip(sought, changes, strict=True)
        ]
        return [
            Linearisation(gram, np.hstack([end, change.end]))
            for (gram, end), change in zip(grams(system, sought), changes, strict=True)
        ]

    def paths(self, requests: Sequence[Request], effects: tuple[str, ...]) -> list[_Simulated]:
        """Each segment's drive and simulation, the motion's parameters, and all values.

        The last call is cached: accepted points are requested again, to be linearised.
        """
        last = self._last
        if last is None or last[0] != effects or not _same(last[1], requests):
            last = self._last = effects, tuple(requests), self._simulated(requests, effects)
        return last[2]

    def reuse(self, other: Simulator) -> None:
        """Take over the last simulation of the same gaits."""
        self._last = other._last

    def _simulated(self, requests: Sequence[Request], effects: tuple[str, ...]) -> list[_Simulated]:
        mechanical = self.every(effects)
        # Most segments that are requested together have the same values.
        distinct = {id(one.values): self.given(one.values) for one in requests}
        system, motion = _shortest(mechanical, distinct.values())
        known = {
            key: (given, values_of(given, motion.parameters)) for key, given in distinct.items()
        }
        asked = {(one.segment.run, id(one.values)) for one in requests}
        self.drives.every([(run, known[values][0]) for run, values in asked], mechanical)
        ready = []
        for one in requests:
            given, p = known[id(one.values)]
            ready.append((self.drive_path(one.segment, given, mechanical), one.state, p, given))
        made = predict_all(system, [each[:3] for each in ready])
        return [(path, one, p, given) for (path, _, p, given), one in zip(ready, made, strict=True)]

    def converted(self, request: Request, effects: tuple[str, ...]) -> Array:
        """The state with other effects: z or v, and side speeds that are 0 or left out."""
        new, state = self.every(effects), request.state
        if slips(new) == (state.size > V + 1):
            return state
        given = self.given(request.values)
        drive = self.drives.of(request.segment.run, given, new)
        t = self._data[request.segment.run].t[request.segment.first] + lateness(given, new)
        phi, dphi, _ = drive.at(np.array([t]))[:, 0]
        speeds, count = floor_motion().speeds, len(ROBOT_PARAMETERS)
        p = values_of(given, floor_motion().parameters)[:count]
        # v = z + g dphi
        pushed = float(speeds(np.zeros(V + 1), [phi, dphi], p)[0])
        if slips(new):
            return np.array([*state[:V], state[V] + pushed, 0.0, 0.0])
        return np.array([*state[:V], state[V] - pushed])
