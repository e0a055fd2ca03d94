"""The Roller Racer as a model that can be diagnosed."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import cast

import casadi as ca
import numpy as np

from rr_opt.diagnose.fit import Fit, Problem, doubt, scaled
from rr_opt.diagnose.floor_map import cells_of, likely, with_cells
from rr_opt.diagnose.model import Array, Candidate, Data, Form, Model, Piece, Quantity, Response
from rr_opt.diagnose.shoot import DrivePath, DriveSlopes, System, predict, slopes
from rr_opt.experiment.experiment import Experiment, Run, Uncertainty
from rr_opt.experiment.recording import CHANNELS
from rr_opt.physics.drive import Drive, FreeJoint, told
from rr_opt.physics.effects import CATALOGUE, Effect, Parameter, Setting
from rr_opt.physics.floor_motion import floor_motion
from rr_opt.physics.free_joint import free_joint
from rr_opt.physics.kinematics import ROBOT_PARAMETERS
from rr_opt.robot.parameters import EffectUse

SETTLING = 0.05
"""After a start from rest the motor saturates for some 20 ms; that much, s, is left out."""

_FINE = 4
"""Steps between two samples where the drive is not smooth, or the wheels slip."""

_CHANNELS = {
    "actuation": "actuation",
    "rolling": "rolling",
    "contact": "constraint_axle1",
    "floor": "floor",
    "mass": "mass",
    "measurement": "measurement",
}
"""The channel in which a family of effects shows."""

_PARTS = {"m": "kg", "I": "kg m^2", "c": "m", "a": "m", "b": "m", "kappa": "N m s"}
_EVERYTHING = (*(f"{part}{i}" for i in (1, 2) for part in _PARTS), "h")


class RollerRacer:
    """An experiment with a Roller Racer; answers `diagnose.model.Model`."""

    channels = CHANNELS
    window = 5.0

    def __init__(self, experiment: Experiment) -> None:
        self.experiment = experiment
        self.nominal = _nominal(experiment)
        self._given = frozenset(use.name for use in experiment.robot.physics)

    @property
    def runs(self) -> Sequence[Data]:
        """The recorded runs."""
        return self._runs

    @cached_property
    def _runs(self) -> Sequence[Data]:
        return [_data(run) for run in self.experiment.runs]

    @property
    def parameters(self) -> tuple[Quantity, ...]:
        """The robot's parameters that are not known exactly."""
        return self._parameters

    @cached_property
    def _parameters(self) -> tuple[Quantity, ...]:
        known = self.experiment.uncertainty
        free = dict(known)
        if all(known.get(f"kappa{i}", Uncertainty()).factor for i in (1, 2)):
            free.pop("h", None)  # the wheel's radius counts through kappa/h^2 alone
        own = [
            _parameter(name, self.nominal[name], free[name]) for name in _EVERYTHING if name in free
        ]
        return (*own, *(q for use in self.experiment.robot.physics for q in self._present(use)))

    def _present(self, use: EffectUse) -> Iterator[Quantity]:
        """The values of an effect that the nominal robot has: how strong it is, is not known."""
        for q in CATALOGUE[use.name].parameters:
            value = use.values[q.name]
            if value != q.neutral and not q.placed:
                size = max(abs(value), 0.1 * q.size(self.setting))
                yield Quantity(
                    f"{use.name}.{q.name}", q.unit, value, size, True, *q.bounds, value, free=True
                )

    @property
    def catalogue(self) -> Mapping[str, Candidate]:
        """The effects of physics beyond the paper's model."""
        return self._catalogue

    @cached_property
    def _catalogue(self) -> Mapping[str, Candidate]:
        return {
            name: _candidate(effect, self.setting)
            for name, effect in CATALOGUE.items()
            if name not in self._given and not effect.nameless
        }

    @cached_property
    def setting(self) -> Setting:
        """What was asked of the robot, for the usual sizes of the effects."""
        gaits = [run.gait for run in self.experiment.runs]
        distances = [
            np.nanmedian(np.hypot(*(np.diff(d.values[:: len(d.t) // 20, k]) for k in (0, 1))))
            / np.median(np.diff(d.t[:: len(d.t) // 20]))
            for d in self.runs
        ]
        fastest = max(gait.peak_rate for gait in gaits)
        return Setting(self.experiment.robot, fastest, max(float(np.median(distances)), 1e-3))

    def propose(self, name: str, form: int, fit: Fit) -> Sequence[Mapping[str, float]]:
        """Places for a patch on the floor, the one effect that has to be looked for in space."""
        found = self._patches(fit)[form]
        return [{f"{name}.{key}": value for key, value in one.items()} for one in found]

    def _patches(self, fit: Fit) -> tuple[list[Mapping], list[Mapping]]:
        """Circles and edges that would gain most; see `floor_map`."""
        cells = cells_of([self.runs[piece.run].values[piece.span, :2] for piece in fit.starts])
        motion = with_cells(self._all(fit.effects), cells)
        stiff = len(motion.free) if motion.slips else 0
        mapped = System(motion.rates, motion.seen, stiff), motion.parameters
        quantities = (*fit.quantities, *(_share(name) for name in cells.names))
        problem = Problem(
            cast("Model", _Mapped(self, mapped)), tuple(fit.starts), fit.effects, quantities
        )
        values = dict(fit.values) | dict.fromkeys(cells.names, 0.0)
        parts = [problem.normal(piece, values, start) for piece, start in fit.starts.items()]
        n = len(fit.quantities)
        prior = np.diag(problem.prior * doubt(fit.cost, fit.count))
        u = scaled(quantities, values)
        H, g = sum((one.H for one in parts), prior), sum((one.g for one in parts), prior @ u)
        onto = np.linalg.pinv(H[:n, :n], hermitian=True) @ H[:n, n:] if n else H[:0, n:]
        return likely(cells, g[n:] - onto.T @ g[:n], H[n:, n:] - onto.T @ H[:n, n:])

    @property
    def jumping(self) -> frozenset[str]:
        """The effects that have no derivative where they vanish."""
        return frozenset(name for name, effect in CATALOGUE.items() if not effect.smooth)

    def start(self, piece: Piece) -> Array:
        """x, y, psi as first recorded, and for z, which swings less than v, the mean of v."""
        data = self.runs[piece.run]
        t, values = data.t[piece.span], data.values[piece.span]
        first = [column[np.isfinite(column)][0] for column in values.T[:3]]
        # The mean speed along the axis over the first period is near enough to begin with.
        period = t - t[0] <= self.experiment.runs[piece.run].gait.period
        seen = values[period & np.isfinite(values[:, :3]).all(axis=1)]
        dx, dy = seen[-1, :2] - seen[0, :2]
        heading = seen[:, 2].mean()
        v = (dx * np.cos(heading) + dy * np.sin(heading)) / max(t[period][-1] - t[0], 1e-9)
        return np.array([*first, v])

    def respond(
        self,
        piece: Piece,
        values: Mapping[str, float],
        effects: tuple[str, ...],
        start: Array,
        wanted: tuple[str, ...] | None = None,
        derived: tuple[System, tuple[str, ...]] | None = None,
    ) -> Response:
        """Predict a piece of a run; see `diagnose.model.Model`.

        derived  the motion and its parameters, where they are not those of the catalogue alone
        """
        mechanical = self._all(effects)
        system, parameters = derived or _system(mechanical)
        given = {**self.nominal, **values}
        p = _p(given, parameters)
        t = self.runs[piece.run].t[piece.span]
        path = self._drive_path(piece.run, given, mechanical, t)
        made = predict(system, path, _state(mechanical, path, start, p), p)
        if wanted is None:
            return Response(made.seen)
        by = np.zeros((p.size, len(wanted)))
        for k, name in enumerate(wanted):
            by[:, k] = _p_by(given, parameters, name)
        drive_by = self._drive_by(piece.run, given, mechanical, t, wanted)
        out = slopes(system, path, made, p, by, drive_by)
        by_value = out.by_parameter
        if floor_motion(mechanical).slips:
            # The start is given in z and the state holds v, which moves with what is asked.
            by_value = by_value + out.by_start[:, :, 3:4] * _v_of_z_by(path, start, p, by, drive_by)
        return Response(made.seen, by_value, out.by_start[:, :, : start.size])

    def _all(self, effects: tuple[str, ...]) -> tuple[str, ...]:
        """The effects with those that the nominal robot has already, in the catalogue's order."""
        return tuple(name for name in CATALOGUE if name in effects or name in self._given)

    @cached_property
    def _joint(self) -> FreeJoint:
        """The joint while the servo does not hold it, of the nominal robot."""
        return free_joint(self.experiment.robot)

    def _drive(self, run: int, given: Mapping[str, float], effects: tuple[str, ...]) -> Drive:
        here = self.experiment.runs[run]
        drive = told(here.gait, here.start == "rest")
        for name in effects:
            effect = CATALOGUE[name]
            if effect.actuate:
                own = {q.name: given[f"{name}.{q.name}"] for q in effect.parameters}
                drive = effect.actuate(drive, own, self._joint)
        return drive

    def _drive_path(
        self,
        run: int,
        given: Mapping[str, float],
        effects: tuple[str, ...],
        t: Array,
        smooth: bool | None = None,
    ) -> DrivePath:
        """The drive over the steps between the samples; `smooth` as it is, or as it is said."""
        drive, late = self._drive(run, given, effects), _delay(given, effects)
        smooth = drive.smooth if smooth is None else smooth
        stiff = any(CATALOGUE[name].stiff for name in effects)
        each = _FINE if stiff or not smooth else 1
        inner = np.arange(each) / each
        edges = np.append((t[:-1, None] + np.diff(t)[:, None] * inner).ravel(), t[-1])
        h = np.diff(edges)
        at_edges = drive.at(edges + late)[:2]
        middle = drive.at(edges[:-1] + h / 2 + late)[:2]
        nodes = np.stack([at_edges[:, :-1], middle, at_edges[:, 1:]], axis=1)
        if not smooth:
            # Where dphi jumps within a step, the step keeps its end points.
            nodes[1] = (np.diff(at_edges[0]) / h)[None]
            nodes[0, 1] = (nodes[0, 0] + nodes[0, 2]) / 2
        at = at_edges[:, ::each]
        if stiff:
            mean = np.diff(at_edges[1]) / h
            nodes = np.concatenate([nodes, np.tile(mean, (1, 3, 1))])
            at = np.vstack([at, np.append(mean, mean[-1])[::each]])
        return DrivePath(h, nodes, at, each)

    def _drive_by(
        self,
        run: int,
        given: Mapping[str, float],
        effects: tuple[str, ...],
        t: Array,
        wanted: tuple[str, ...],
    ) -> DriveSlopes | None:
        moving = [
            (k, name)
            for k, name in enumerate(wanted)
            if "." in name and name.split(".")[0] in effects and _of_drive(name)
        ]
        if not moving:
            return None
        smooth = self._drive(run, given, effects).smooth
        path = self._drive_path(run, given, effects, t)
        at = np.zeros((*path.at.shape, len(wanted)))
        middle = np.zeros((*path.nodes[:, 1].shape, len(wanted)))
        for k, name in moving:
            # The very steps that predict are moved, so that a jump of dphi counts where it does.
            step, least = 1e-3 * self._scale(name), _least(name)
            low, high = max(given[name] - step, least), given[name] + step
            ends = [
                self._drive_path(run, {**given, name: value}, effects, t, smooth)
                for value in (low, high)
            ]
            at[:, :, k] = (ends[1].at - ends[0].at) / (high - low)
            middle[:, :, k] = (ends[1].nodes[:, 1] - ends[0].nodes[:, 1]) / (high - low)
        if smooth and self.experiment.runs[run].start == "rest":
            # How dphi sets in may change at once, and more than a step shows: what the first step
            # integrates to is the change of phi.
            rise = (at[0, 1] - at[0, 0]) / path.h[0]
            at[1, 0] = middle[1, 0] = (6 * rise - at[1, 1]) / 5
        return DriveSlopes(at, middle)

    def _scale(self, name: str) -> float:
        effect, parameter = name.split(".")
        return next(q.typical for q in CATALOGUE[effect].parameters if q.name == parameter)


@dataclass(frozen=True)
class _Mapped:
    """A Roller Racer on a floor of cells."""

    racer: RollerRacer
    derived: tuple[System, tuple[str, ...]]

    @property
    def runs(self) -> Sequence[Data]:
        """Those of the robot."""
        return self.racer.runs

    def respond(self, *given) -> Response:
        """As the robot, with drag of its own in every cell."""
        return self.racer.respond(*given, derived=self.derived)


def _share(name: str) -> Quantity:
    return Quantity(name, "", 0.0, 1.0, False, -1.0, 100.0, 0.0)


def _state(effects: tuple[str, ...], path: DrivePath, start: Array, p: Array) -> Array:
    """The state that belongs to x, y, psi and z = v - g dphi, which is 0 of a robot at rest.

    Where the axles may slip it holds v, and they begin without: what they slip at first is over in
    milliseconds.
    """
    if not floor_motion(effects).slips:
        return start
    speeds = floor_motion().speeds
    v = float(speeds(start, path.at[:2, 0], p[: len(ROBOT_PARAMETERS)])[0])
    return np.array([*start[:3], v, 0.0, 0.0])


def _v_of_z_by(
    path: DrivePath, start: Array, p: Array, by: Array, drive_by: DriveSlopes | None
) -> Array:
    """How the v that belongs to a start's z changes with what is asked for, (nw,)."""
    v_by = _v_by()
    known = len(ROBOT_PARAMETERS)
    slope = np.asarray(v_by(start, path.at[:2, 0], p[:known]))[0]
    own = slope[2:] @ by[:known]
    return own if drive_by is None else own + slope[:2] @ drive_by.at[:2, 0]


@lru_cache
def _v_by() -> ca.Function:
    """(state, drive, p) -> the derivatives of v by the drive and by p, (1, 2 + np)."""
    speeds = floor_motion().speeds
    state, drive, p = speeds.sx_in()
    by = ca.densify(ca.jacobian(speeds(state, drive, p)[0], ca.vertcat(drive, p)))
    return ca.Function("v_by", [state, drive, p], [by])


def _of_drive(name: str) -> bool:
    effect, parameter = name.split(".")
    return CATALOGUE[effect].actuate is not None or CATALOGUE[effect].delay == parameter


def _least(name: str) -> float:
    effect, parameter = name.split(".")
    return next(q.bounds[0] for q in CATALOGUE[effect].parameters if q.name == parameter)


def _delay(given: Mapping[str, float], effects: tuple[str, ...]) -> float:
    return sum(given[f"{n}.{CATALOGUE[n].delay}"] for n in effects if CATALOGUE[n].delay)


@lru_cache
def _system(effects: tuple[str, ...]) -> tuple[System, tuple[str, ...]]:
    motion = floor_motion(effects)
    stiff = len(motion.free) if motion.slips else 0
    return System(motion.rates, motion.seen, stiff), motion.parameters


def _nominal(experiment: Experiment) -> dict[str, float]:
    robot = experiment.robot
    platforms = ((1, robot.platform1), (2, robot.platform2))
    out = {f"{part}{i}": getattr(platform, part) for i, platform in platforms for part in _PARTS}
    neutral = {
        f"{effect.name}.{q.name}": q.neutral
        for effect in CATALOGUE.values()
        for q in effect.parameters
    }
    given = {f"{use.name}.{name}": v for use in robot.physics for name, v in use.values.items()}
    return {**out, "h": robot.h, **neutral, **given}


def _p(given: Mapping[str, float], parameters: tuple[str, ...]) -> Array:
    friction = {f"k{i}": given[f"kappa{i}"] / given["h"] ** 2 for i in (1, 2)}
    return np.array([friction.get(name, given.get(name, math.nan)) for name in parameters])


def _p_by(given: Mapping[str, float], parameters: tuple[str, ...], name: str) -> Array:
    """How p changes with a quantity."""
    out = np.array([float(own == name) for own in parameters])
    for i in (1, 2):
        own = parameters.index(f"k{i}")
        if name == f"kappa{i}":
            out[own] = 1 / given["h"] ** 2
        if name == "h":
            out[own] = -2 * given[f"kappa{i}"] / given["h"] ** 3
    return out


def _parameter(name: str, value: float, known: Uncertainty) -> Quantity:
    unit = _PARTS.get(name.rstrip("12"), "m")
    if known.factor:
        # Counted as it is and not in its logarithm: the motion is nearly linear in kappa, and what
        # is seen best is the sum of both.
        low, high = value / known.factor, value * known.factor
        return Quantity(name, unit, value, value, True, low, high, value, free=True)
    low = 0.0 if name.startswith("a") else value / 3
    return Quantity(name, unit, value, known.sigma, True, low, 3 * value, value)


def _candidate(effect: Effect, setting: Setting) -> Candidate:
    forms = effect.forms or (tuple(q.name for q in effect.parameters),)
    own = {q.name: q for q in effect.parameters}
    return Candidate(
        effect.name,
        effect.family,
        _CHANNELS[effect.family],
        effect.sentence,
        tuple(_form(effect.name, [own[name] for name in form], setting) for form in forms),
    )


def _form(effect: str, parameters: Sequence[Parameter], setting: Setting) -> Form:
    sizes = [q.size(setting) for q in parameters]
    quantities = tuple(
        Quantity(f"{effect}.{q.name}", q.unit, q.neutral, size, False, *q.bounds, q.neutral)
        for q, size in zip(parameters, sizes, strict=True)
    )
    choices = [
        [size * trial for trial in q.trials]
        if q.neutral
        else [size * trial for trial in q.trials]
        if q.bounds[0] == 0
        else [0.0]
        for q, size in zip(parameters, sizes, strict=True)
    ]
    starts = (
        ()
        if any(q.placed for q in parameters)
        else tuple(
            {q.name: value for q, value in zip(quantities, chosen, strict=True)}
            for chosen in itertools.product(*choices)
        )
    )
    return Form(quantities, starts)


def _data(run: Run) -> Data:
    recording = run.recording
    values = np.column_stack([recording.data(name) for name in CHANNELS])
    if run.start == "rest":
        values[(recording.t >= 0) & (recording.t < SETTLING)] = np.nan
    sigma = np.column_stack([recording.sigma[name] for name in CHANNELS])
    return Data(run.name, recording.t, values, sigma, run.use == "holdout")
