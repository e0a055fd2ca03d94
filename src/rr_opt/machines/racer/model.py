"""The Roller Racer as a model that can be identified; implements `sysid.model.Model`."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Self

import numpy as np

from rr_opt.array import Array
from rr_opt.effects import CATALOGUE
from rr_opt.effects.effect import OperatingRange
from rr_opt.machines.racer.parameters import ZERO_OFFSET, ZEROS, effect_info, nominal, uncertain
from rr_opt.machines.racer.simulation import Simulator, side_speeds, slips
from rr_opt.model.experiment import CHANNELS, Experiment, Run
from rr_opt.recordings.time_axis import jumping, time_step
from rr_opt.sysid.model import (
    ChannelNoise,
    Data,
    EffectInfo,
    Linearisation,
    Quantity,
    Request,
    Segment,
    Simulation,
)
from rr_opt.sysid.settings import SETTINGS


class RacerModel:
    """An experiment with a Roller Racer: its recordings, and their simulation."""

    channels = CHANNELS
    segment_length = 5.0
    horizon = math.inf

    def __init__(
        self,
        experiment: Experiment,
        setting: OperatingRange | None = None,
        noise: Sequence[ChannelNoise] = (ChannelNoise(),) * len(CHANNELS),
    ) -> None:
        """The model of an experiment.

        setting  operating range of the robot; taken from the runs if omitted
        noise    of each channel, relative to what the experiment states
        """
        self.experiment = experiment
        self._given, self._noise = setting, noise
        self.nominal = nominal(experiment)

    def with_noise(self, noise: Sequence[ChannelNoise]) -> Self:
        """The same with other noise, its levels relative to the present ones."""
        of_stated = [
            replace(new, level=new.level * old.level)
            for new, old in zip(noise, self._noise, strict=True)
        ]
        return type(self)(self.experiment, self._given, of_stated)

    def beside(self, experiment: Experiment) -> Self:
        """The model of another experiment with the same robot and usual sizes of effects."""
        return type(self)(experiment, self.setting, self._noise)

    @property
    def bandwidth(self) -> float:
        """Hz."""
        return SETTINGS.slow

    @property
    def correlation_time(self) -> float:
        """In s."""
        return SETTINGS.correlation_time

    @property
    def runs(self) -> Sequence[Data]:
        """The recorded runs."""
        return self._runs

    @cached_property
    def _runs(self) -> Sequence[Data]:
        return [_data(run, self._noise) for run in self.experiment.runs]

    @property
    def form_error(self) -> float:
        """RMS in sigma over all channels by which robots of this kind deviate from any model."""
        return self._form_error

    @cached_property
    def _form_error(self) -> float:
        squares = [
            np.nanmean((SETTINGS.form_error * _travelled(run)[:, None] / run.sigma[:, :2]) ** 2)
            for run in self.runs
        ]
        # x and y together have the error along the path, psi and phi none.
        return float(np.sqrt(np.mean(squares) / len(CHANNELS)))

    @property
    def parameters(self) -> tuple[Quantity, ...]:
        """The robot's parameters that are not known exactly."""
        return self._parameters

    @cached_property
    def _parameters(self) -> tuple[Quantity, ...]:
        return uncertain(self.experiment, self.setting)

    @property
    def catalogue(self) -> Mapping[str, EffectInfo]:
        """The effects of physics beyond the paper's model."""
        return self._catalogue

    @cached_property
    def _catalogue(self) -> Mapping[str, EffectInfo]:
        effects = CATALOGUE.values()
        beside = {name for effect in effects for name in (*effect.lookalikes, effect.tangent)}
        return {
            name: effect_info(effect, self.setting)
            for name, effect in CATALOGUE.items()
            if name not in self.simulator.built_in and (effect.candidate or name in beside)
        }

    @property
    def setting(self) -> OperatingRange:
        """The robot's operating range, for the usual sizes of the effects."""
        return self._given or self._told

    @cached_property
    def _told(self) -> OperatingRange:
        gaits = [run.gait for run in self.experiment.runs]
        speeds = [_usual_speed(d) for d in self.runs]
        fastest = max(gait.peak_rate for gait in gaits)
        places = np.vstack([d.values[:, :2] for d in self.runs])
        room = float(np.max(np.nanmax(places, axis=0) - np.nanmin(places, axis=0)))
        speed = max(float(np.median(speeds)), 1e-3)
        return OperatingRange(self.experiment.robot, fastest, speed, room)

    def initial_state(
        self, segment: Segment, effects: tuple[str, ...], values: Mapping[str, float]
    ) -> Array:
        """x, y, psi as first recorded, or nearest to a segment without data; for z, which swings
        less than v, the mean of v; side speeds estimated from the first samples."""
        data, run = self.runs[segment.run], self.experiment.runs[segment.run]
        t, recorded = data.t[segment.span], data.values[segment.span]
        first = [_first(column, segment) for column in data.values.T[:3]]
        # The mean speed along the axis over the first period is near enough to begin with.
        seen = recorded[(t - t[0] <= run.gait.period) & np.isfinite(recorded[:, :3]).all(axis=1)]
        took = max(min(run.gait.period, t[-1] - t[0]), 1e-9)
        dx, dy = seen[-1, :2] - seen[0, :2] if len(seen) else (0.0, 0.0)
        heading = seen[:, 2].mean() if len(seen) else 0.0
        v = (dx * np.cos(heading) + dy * np.sin(heading)) / took
        plain = Request(segment, values, np.array([*first, v]))
        state = self.simulator.converted(plain, effects)
        if state.size > plain.state.size:
            state[-2:] = side_speeds(self.experiment.robot, run.gait, t, recorded)
        return state

    def converted(self, request: Request, effects: tuple[str, ...]) -> Array:
        """The state with other effects."""
        return self.simulator.converted(request, effects)

    def state_scale(self, effects: tuple[str, ...]) -> Array:
        """The slow part of the noise; for speeds, what adds up to as much in a second. Side speeds
        are no less certain than v: wheels that hold pass on theirs to it."""
        place, heading = self._stated
        sides = [place] * 2 if slips(self.simulator.every(effects)) else []
        return np.array([place, place, heading, place, *sides])

    @cached_property
    def _stated(self) -> tuple[float, float]:
        """The noise of the place, m, and of the heading, rad."""
        sigma = self.runs[0].weighted_sigma
        place, heading = (float(np.nanmedian(sigma[:, k])) for k in (0, 2))
        return place, heading

    def least_process_noise(self, run: int, effects: tuple[str, ...]) -> Array:
        """For the speed, the form error's share of its mean."""
        least = np.zeros(self.state_scale(effects).size)
        least[3] = SETTINGS.form_error * self._mean_speeds[run]
        return least

    @cached_property
    def _mean_speeds(self) -> Array:
        return np.array([_travelled(run)[-1] / run.duration for run in self.runs])

    def state_prior(self, effects: tuple[str, ...]) -> Array:
        """Side speeds are about 0: until they have decayed they move a wheel by the noise."""
        sides = self.state_scale(effects)[4:] / SETTINGS.creeping
        return np.array([*[np.inf] * 4, *sides])

    def prepare(self, every: Iterable[tuple[str, ...]]) -> None:
        """Compile ahead."""
        self.simulator.prepare(every)

    def simulate(
        self, requests: Sequence[Request], effects: tuple[str, ...]
    ) -> Sequence[Simulation]:
        """Simulate segments."""
        return self.simulator.simulate(requests, effects)

    def linearise(
        self, requests: Sequence[Request], effects: tuple[str, ...], wanted: tuple[str, ...]
    ) -> Sequence[Linearisation]:
        """Linearise segments."""
        return self.simulator.linearise(requests, effects, wanted)

    def predicted(self, request: Request, effects: tuple[str, ...]) -> Array:
        """The predicted recording of a segment."""
        ((_, made, _, _),) = self.simulator.paths([request], effects)
        return made.seen

    @cached_property
    def simulator(self) -> Simulator:
        """The simulator of its runs."""
        given = frozenset(use.name for use in self.experiment.robot.physics)
        if any(name in self.experiment.uncertainty for name in ZEROS.values()):
            given |= {ZERO_OFFSET}
        return Simulator(self.experiment.runs, self.runs, self.nominal, given)


def _first(y: Array, segment: Segment) -> float:
    """The first of a run's values (n,) in a segment; without any, the one nearest to its begin."""
    known = np.flatnonzero(np.isfinite(y))
    inside = known[(known >= segment.first) & (known <= segment.last)]
    if inside.size:
        return float(y[inside[0]])
    return float(y[known[np.argmin(np.abs(known - segment.first))]])


def _usual_speed(data: Data) -> float:
    """From about twenty places along a run, m/s."""
    seen = np.flatnonzero(np.isfinite(data.values[:, :2]).all(axis=1))
    some = seen[:: max(seen.size // 20, 1)]
    way = np.hypot(*np.diff(data.values[some, :2], axis=0).T)
    return float(np.median(way) / np.median(np.diff(data.t[some])))


def _travelled(data: Data) -> Array:
    """Distance travelled, m (n,), from places half a second apart, to suppress noise."""
    seen = np.isfinite(data.values[:, :2]).all(axis=1)
    at = np.append(np.arange(data.t[0], data.t[-1], 0.5), data.t[-1])
    x, y = (np.interp(at, data.t[seen], data.values[seen, k]) for k in (0, 1))
    way = np.append(0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y))))
    return np.interp(data.t, at, way)


def _data(run: Run, noise: Sequence[ChannelNoise]) -> Data:
    """Its recording, with empty rows for those missing from its file: a step between samples is no
    longer than usual."""
    recording = run.recording
    steps = np.diff(recording.t) / time_step(recording.t)
    rows = np.where(jumping(steps), np.rint(steps), 1).astype(int)
    of = np.repeat(np.arange(rows.size + 1), np.append(rows, 1))
    at = np.append(0, np.cumsum(rows))
    t = np.interp(np.arange(of.size), at, recording.t)
    values = np.full((of.size, len(CHANNELS)), np.nan)
    values[at] = np.column_stack([recording.data(name) for name in CHANNELS])
    if run.start == "rest":
        bounces = SETTINGS.bouncing * run.gait.period
        values[(t >= 0) & (t < SETTINGS.starting)] = np.nan
        values[(t >= 0) & (t < bounces), CHANNELS.index("phi")] = np.nan
    sigma = np.column_stack([recording.sigma[name] for name in CHANNELS])[of]
    sigma = sigma * [one.level for one in noise]
    correlation = np.array([one.correlation for one in noise])
    held_out = run.use == "holdout"
    return Data(run.name, t, values, sigma, held_out, correlation=correlation)
