"""The Roller Racer as a model that can be diagnosed.

A term without a name for the corrected robot: rolling resistance as a curve of speed.

Where no effect of the catalogue accounts for what is left, `rolling_force_curve` says what the
wheels do at five speeds. It is fitted as an effect is, by simulation error over whole runs, beside
the parameters; the speed of its last knot is that which the wheels seldom exceed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from rr_opt.array import Array
from rr_opt.effects import CATALOGUE
from rr_opt.effects.effect import OperatingRange
from rr_opt.effects.rolling_force_curve import EFFECT
from rr_opt.machines.racer.observed import observed
from rr_opt.machines.racer.parameters import ZERO_OFFSET, ZEROS, candidate, nominal, uncertain
from rr_opt.machines.racer.proposals import of_patch, of_servo, of_slip
from rr_opt.machines.racer.simulation import HELD, Racer, Simulated, side_speeds
from rr_opt.model.experiment import CHANNELS, Experiment, Run
from rr_opt.model.robot import Robot
from rr_opt.sysid.candidate import joined
from rr_opt.sysid.least_squares import Fit, Problem, solve
from rr_opt.sysid.model import Asked, Candidate, Data, Piece, Proposal, Quantity, Response

_FAST = 0.98
"""Quantile of the wheels' speeds at which the curve ends."""


def with_force_curve(model: Racer, robot: Robot, whole: Fit, windows: Fit) -> Fit:
    """The parameters with the curve beside them, over whole runs.

    whole    the parameters alone, over whole runs, say how fast the wheels are
    windows  where it begins, as the parameters are not yet bent there
    """
    name = EFFECT.name
    seen = [observed(model, p, whole.values, whole.effects, s) for p, s in whole.starts.items()]
    speed = float(np.quantile(np.abs(np.concatenate([one.u.ravel() for one in seen])), _FAST))
    size = (robot.k1 + robot.k2) / 2 * speed
    curve = tuple(
        # The speed is where the curve ends, and stays.
        Quantity(f"{name}.{q.name}", q.unit, speed, speed, False, speed, speed, speed)
        if q.name == "speed"
        else Quantity(f"{name}.{q.name}", q.unit, 0.0, size, False, *q.bounds, q.neutral)
        for q in EFFECT.parameters
    )
    quantities = (*model.parameters, *curve)
    problem = Problem(model, tuple(windows.starts), (name,), quantities)
    values = {q.name: q.value for q in quantities}
    return joined(model, solve(problem, values, windows.starts))


SETTLING = 0.05
"""After a start from rest the motor saturates for some 20 ms; that much, s, is left out."""


INEXACT = 5e-4
"""Of the way travelled, by which even a fine simulation of wheels that press on a floor is off."""


class RollerRacer:
    """An experiment with a Roller Racer; answers `diagnose.model.Model`."""

    channels = CHANNELS
    window = 5.0

    def __init__(self, experiment: Experiment, setting: OperatingRange | None = None) -> None:
        """setting: what was asked of the robot; left out, it is told from the runs."""
        self.experiment = experiment
        self._given = setting
        self.nominal = nominal(experiment)
        self._mapped: tuple[Fit, tuple[Sequence[Proposal], Sequence[Proposal]]] | None = None

    @property
    def runs(self) -> Sequence[Data]:
        """The recorded runs."""
        return self._runs

    @cached_property
    def _runs(self) -> Sequence[Data]:
        return [_data(run) for run in self.experiment.runs]

    @cached_property
    def _inexact(self) -> float:
        """Of the way travelled, the square of the channels' misfit averaged over all runs."""
        squares = [
            np.nanmean((INEXACT * _travelled(run)[:, None] / run.sigma[:, :2]) ** 2)
            for run in self.runs
        ]
        # In x and y together as much as along the way, in psi and phi nothing.
        return float(np.sqrt(np.mean(squares) / len(CHANNELS)))

    @property
    def inexact(self) -> float:
        """Misfit, RMS in sigma, by which robots of this kind differ from any model of them."""
        return self._inexact

    @property
    def parameters(self) -> tuple[Quantity, ...]:
        """The robot's parameters that are not known exactly."""
        return self._parameters

    @cached_property
    def _parameters(self) -> tuple[Quantity, ...]:
        return uncertain(self.experiment, self.setting)

    @property
    def catalogue(self) -> Mapping[str, Candidate]:
        """The effects of physics beyond the paper's model."""
        return self._catalogue

    @cached_property
    def _catalogue(self) -> Mapping[str, Candidate]:
        return {
            name: candidate(effect, self.setting)
            for name, effect in CATALOGUE.items()
            if name not in self.simulated.built_in and effect.candidate
        }

    @property
    def setting(self) -> OperatingRange:
        """What was asked of the robot, for the usual sizes of the effects."""
        return self._given or self._told

    @cached_property
    def _told(self) -> OperatingRange:
        gaits = [run.gait for run in self.experiment.runs]
        distances = [
            np.nanmedian(np.hypot(*(np.diff(d.values[:: len(d.t) // 20, k]) for k in (0, 1))))
            / np.median(np.diff(d.t[:: len(d.t) // 20]))
            for d in self.runs
        ]
        fastest = max(gait.peak_rate for gait in gaits)
        places = np.vstack([d.values[:, :2] for d in self.runs])
        room = float(np.max(np.nanmax(places, axis=0) - np.nanmin(places, axis=0)))
        speed = max(float(np.median(distances)), 1e-3)
        return OperatingRange(self.experiment.robot, fastest, speed, room)

    @property
    def jumping(self) -> frozenset[str]:
        """The effects that have no derivative where they vanish."""
        return frozenset(name for name, effect in CATALOGUE.items() if not effect.differentiable)

    @property
    def dear(self) -> frozenset[str]:
        """Those of them that are not the servo's."""
        return frozenset(name for name in self.jumping if CATALOGUE[name].actuate is None)

    @property
    def placed(self) -> frozenset[str]:
        """Those that are on a part of the floor."""
        return frozenset(name for name in self.jumping if CATALOGUE[name].family == "floor")

    @property
    def rough(self) -> frozenset[str]:
        """The quantities of effects of which there are as many models as machines."""
        every = ((effect, q) for effect in CATALOGUE.values() for q in effect.parameters)
        return frozenset(f"{effect.name}.{q.name}" for effect, q in every if q.model_form_error)

    @property
    def vague(self) -> Mapping[str, float]:
        """How far such models differ in a quantity."""
        every = ((effect, q) for effect in CATALOGUE.values() for q in effect.parameters)
        return {
            f"{effect.name}.{q.name}": q.model_form_sigma
            for effect, q in every
            if q.model_form_sigma
        }

    def propose(self, name: str, form: int, fit: Fit) -> Sequence[Proposal]:
        """From where to look for an effect that jumps; see `racer_proposals`."""
        if CATALOGUE[name].family == "floor":
            if not self._mapped or self._mapped[0] is not fit:
                self._mapped = fit, of_patch(self, fit)
            return self._mapped[1][form]
        if CATALOGUE[name].stiff:
            return of_slip(self, name, form, fit)
        return of_servo(self, name, self.catalogue[name].forms[form], fit)

    def twin(self, values: Mapping[str, float]) -> Mapping[str, float] | None:
        """The other way to see two halves of a floor: which is the usual, and which the patch.

        Or the same way, with an edge's direction in half a turn either way.
        """
        if "floor_patch.normal" not in values:
            return None
        normal = math.remainder(values["floor_patch.normal"], math.tau)
        factor = values["floor_patch.multiplier"]
        own = [name for name in ("kappa1", "kappa2") if name in values]
        away = sum(math.log(values[name] / self.nominal[name]) for name in own)
        if factor <= 0 or abs(away + len(own) * math.log(factor)) >= abs(away):
            plain = {**values, "floor_patch.normal": normal}
            return None if plain == values else plain
        turned = math.remainder(normal + math.pi, math.tau)
        other = {"floor_patch.multiplier": 1 / factor, "floor_patch.normal": turned}
        return {**values, **other, **{name: factor * values[name] for name in own}}

    def nameless(self, whole: Fit, windows: Fit) -> Fit:
        """With rolling resistance as a curve of speed."""
        return with_force_curve(self, self.experiment.robot, whole, windows)

    def start(self, piece: Piece) -> Array:
        """x, y, psi as first recorded; for z, which swings less than v, the mean of v; side speeds
        as they look in the first moments."""
        data = self.runs[piece.run]
        t, values = data.t[piece.span], data.values[piece.span]
        first = [column[np.isfinite(column)][0] for column in values.T[:3]]
        # The mean speed along the axis over the first period is near enough to begin with.
        run = self.experiment.runs[piece.run]
        period = t - t[0] <= run.gait.period
        seen = values[period & np.isfinite(values[:, :3]).all(axis=1)]
        dx, dy = seen[-1, :2] - seen[0, :2]
        heading = seen[:, 2].mean()
        v = (dx * np.cos(heading) + dy * np.sin(heading)) / max(t[period][-1] - t[0], 1e-9)
        return np.array([*first, v, *side_speeds(self.experiment.robot, run.gait, t, values)])

    @property
    def start_within(self) -> Array:
        """Side speeds of up to the robot's own."""
        return np.array([*[np.inf] * HELD, *[self.setting.speed] * 2])

    def respond(
        self,
        piece: Piece,
        values: Mapping[str, float],
        effects: tuple[str, ...],
        start: Array,
        wanted: tuple[str, ...] | None = None,
    ) -> Response:
        """Predict a piece of a run; see `diagnose.model.Model`."""
        return self.simulated.respond(piece, values, effects, start, wanted)

    def off(self, asked: Sequence[Asked], effects: tuple[str, ...]) -> Sequence[Array]:
        """(predicted - recorded)/sigma; see `diagnose.model.Model`."""
        return self.simulated.off(asked, effects)

    def grams(
        self,
        asked: Sequence[Asked],
        effects: tuple[str, ...],
        wanted: tuple[str, ...],
        *,
        stray: bool = False,
    ) -> Sequence[Array]:
        """J'J of each piece; see `diagnose.model.Model`."""
        return self.simulated.grams(asked, effects, wanted, self._stray if stray else None)

    def _stray(self, predicted: Array) -> Array:
        """The way from the start, too long or too short by as much as no model has exactly."""
        out = np.zeros_like(predicted)
        out[:, :2] = INEXACT * (predicted[:, :2] - predicted[0, :2])
        return out

    @property
    def simulated(self) -> Simulated:
        """Its runs, simulated."""
        return self._simulated

    @cached_property
    def _simulated(self) -> Simulated:
        given = frozenset(use.name for use in self.experiment.robot.physics)
        if any(name in self.experiment.uncertainty for name in ZEROS.values()):
            given |= {ZERO_OFFSET}
        return Simulated(self.experiment.runs, self.runs, self.nominal, given)


def _travelled(data: Data) -> Array:
    """The way so far, m (n,), from places half a second apart, so that noise does not count."""
    seen = np.isfinite(data.values[:, :2]).all(axis=1)
    at = np.arange(data.t[0], data.t[-1], 0.5)
    x, y = (np.interp(at, data.t[seen], data.values[seen, k]) for k in (0, 1))
    way = np.append(0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y))))
    return np.interp(data.t, at, way)


def _data(run: Run) -> Data:
    recording = run.recording
    values = np.column_stack([recording.data(name) for name in CHANNELS])
    if run.start == "rest":
        values[(recording.t >= 0) & (recording.t < SETTLING)] = np.nan
    sigma = np.column_stack([recording.sigma[name] for name in CHANNELS])
    return Data(run.name, recording.t, values, sigma, run.use == "holdout")


def zeroed(racer: RollerRacer, fit: Fit) -> RollerRacer:
    """The racer with exact zeros, and recordings of psi and phi less those of the fit."""
    uncertainty = racer.experiment.uncertainty
    off = {name: fit.values.get(name, 0.0) for name in ZEROS.values() if name in uncertainty}
    if not off:
        return racer
    runs = []
    for run in racer.experiment.runs:
        values = dict(run.recording.values)
        for name, zero in off.items():
            channel = name.removesuffix("_zero")
            values[channel] = values[channel] - zero
        runs.append(replace(run, recording=replace(run.recording, values=values)))
    exact = {name: known for name, known in uncertainty.items() if name not in off}
    return RollerRacer(replace(racer.experiment, runs=tuple(runs), uncertainty=exact))
