"""Any machine of `model.machine`, driven by measured inputs, as a model that can be identified.

Recordings are predicted in windows that are short enough for errors not to grow much (`windows`).
The error that noise of the inputs causes is one that no model can avoid (`form_error`).
"""

from __future__ import annotations

import copy
import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from rr_opt.array import Array
from rr_opt.machines.drive import MeasuredDrives, Piece, beside
from rr_opt.machines.equations import (
    effect_info,
    parameter_quantity,
    scales_of,
    system_of,
    unknown_inputs,
)
from rr_opt.machines.windows import SHORTEST, prediction_window, stirred
from rr_opt.model.machine import MachineEffect, MachineExperiment, Signals
from rr_opt.sysid.diagnosis import Misfit
from rr_opt.sysid.estimation import Fit
from rr_opt.sysid.machine import Term
from rr_opt.sysid.model import (
    ChannelNoise,
    Choice,
    Data,
    EffectInfo,
    Linearisation,
    Request,
    Segment,
    Simulation,
)
from rr_opt.sysid.paths import DrivePath, DriveSlopes, Path, Recorded, Sought
from rr_opt.sysid.sensitivities import grams
from rr_opt.sysid.settings import SETTINGS
from rr_opt.sysid.shooting import System, predict_all, prepare

_EARLY = 0.05
"""s, from which the state at the beginning of a segment is estimated."""

Made = tuple[Request, DrivePath, Path]
"""A request, its drive, and its predicted path."""


class OdeModel:
    """Recordings of a machine; implements `sysid.machine.MachineModel`."""

    def __init__(self, experiment: MachineExperiment, *, parted: bool = False) -> None:
        """parted: recordings are to be predicted whole."""
        self.experiment, self.machine = experiment, experiment.machine
        machine = self.machine
        self.channels = tuple(one.name for one in machine.outputs)
        self._noise: Sequence[ChannelNoise] = [ChannelNoise()] * len(self.channels)
        self.nominal = dict(experiment.nominal)
        self._scales = scales_of(machine, experiment.runs, self.nominal)
        self._drives = MeasuredDrives(machine, experiment.runs, self._scales)
        self._given = {name.partition(".")[0] for name in self.nominal if "." in name}
        self.parameters = tuple(
            parameter_quantity(machine, name, self.nominal[name], experiment.uncertainty[name])
            for name in (one.name for one in machine.parameters)
            if name in experiment.uncertainty
        )
        self.catalogue: Mapping[str, EffectInfo] = {
            one.name: effect_info(one, self._scales)
            for one in machine.effects
            if one.name not in self._given
        }
        self.inputs = {channel: words for channel, (_, _, words) in machine.ports.items()}
        self.bandwidth = machine.bandwidth
        self.horizon = self.segment_length = SHORTEST
        self._part([Piece(k, 0, len(run)) for k, run in enumerate(experiment.runs)])
        self.horizon = self.segment_length = prediction_window(self)
        self.correlation_time = self.horizon / SETTINGS.modes
        if not parted:
            # Windows are independent: parts of a recording are predicted from one another.
            length = SETTINGS.windows * self.horizon
            self._part([p for one in self._pieces for p in self._parts(one, length)])

    def _part(self, pieces: Sequence[Piece]) -> None:
        """Make the pieces the runs."""
        self._pieces = pieces
        self.runs: Sequence[Data] = [self._data(one) for one in pieces]
        self._recordeds: dict[Segment, Recorded] = {}

    def _parts(self, whole: Piece, length: float) -> list[Piece]:
        """A recording in equal parts of about a length, s."""
        t = self.experiment.runs[whole.recording].t
        count = max(int((t[-1] - t[0]) / length), 1)
        edges = np.linspace(0, t.size, count + 1).astype(int).tolist()
        return [Piece(whole.recording, a, b) for a, b in itertools.pairwise(edges)]

    def with_noise(self, noise: Sequence[ChannelNoise]) -> OdeModel:
        """The same with other noise."""
        other = copy.copy(self)
        other.__dict__.pop("_form_error", None)
        other._noise = [
            replace(new, level=new.level * old.level)
            for new, old in zip(noise, self._noise, strict=True)
        ]
        other._part(self._pieces)
        return other

    @property
    def form_error(self) -> float:
        """RMS in sigma that noise of the inputs causes in a prediction, its start refitted."""
        return self._form_error

    @cached_property
    def _form_error(self) -> float:
        return stirred(self, self.horizon)

    # ---- the machine

    def upstream(self) -> Sequence[tuple[tuple[Choice, ...], Mapping[str, float]]]:
        """No effects: the drive is taken as it was measured."""
        return [((), {})]

    def proposals(
        self, fit: Fit, complete: Sequence[str]
    ) -> Sequence[tuple[Choice, Mapping[str, float]]]:
        """The guesses that come with the forms of non-smooth effects."""
        return [
            (Choice(name), guess)
            for name, info in self.catalogue.items()
            if not info.smooth and name not in complete
            for guess in info.forms[0].guesses
        ]

    def next_experiment(self, best: Fit, rival: tuple[str, Fit] | None) -> None:
        """None: not planned for these machines."""

    def equivalent(self, values: Mapping[str, float]) -> None:
        """None: no two sets of values predict the same."""

    def worth(self, before: Sequence[Misfit], after: Sequence[Misfit]) -> str:
        """Errors of the outputs, in their own units."""
        pairs = zip(self._off(before), self._off(after), strict=True)
        listed = ", ".join(f"{b[0]} was {b[1]:.3g} {b[2]} off and is now {a[1]:.3g} {a[2]} off"
                           for b, a in pairs)  # fmt: skip
        return f"predicted over {self.horizon:.3g} s, {listed} (RMS); "

    def accuracy(self, misfits: Sequence[Misfit]) -> str:
        """The same, of the corrected model."""
        listed = ", ".join(f"{name} to {off:.3g} {unit}" for name, off, unit in self._off(misfits))
        return f"Over {self.horizon:.3g} s the corrected model predicts {listed} (RMS)."

    def unknown_inputs(self, fit: Fit) -> tuple[Sequence[Term], Mapping[Segment, Linearisation]]:
        """At each port an input that depends on a state or a recorded input."""
        requests = fit.problem.requests(fit.values, fit.states)
        made = self.made(requests, fit.effects)
        terms, slopes = unknown_inputs(self.machine, made)
        out = {}
        for one, more in zip(requests, slopes, strict=True):
            (out[one.segment],) = self._linearised([one], fit.effects, fit.problem.names, more)
        return terms, out

    # ---- states

    def initial_state(
        self, segment: Segment, effects: tuple[str, ...], values: Mapping[str, float]
    ) -> Array:
        """From lines fitted to the first samples of the outputs."""
        piece = self._pieces[segment.run]
        run, first = self.experiment.runs[piece.recording], piece.first + segment.first
        t = run.t[first : piece.until]
        t = t[: max(int(np.searchsorted(t, t[0] + _EARLY)), 4)]
        seen = {name: float(y[first]) for name, y in run.inputs.items()}
        for name in self.channels:
            y = run.outputs[name]
            known = np.isfinite(y)
            # In a gap, however long, the nearest samples on both sides of it say the most.
            filled = np.interp(t, run.t[known], y[known])
            slope, there = np.polyfit(t - t[0], filled, 1)
            seen |= {name: float(there), f"{name}_rate": float(slope)}
        begun = self.machine.start(seen)
        return np.array([begun[name] for name in self.machine.states])

    def converted(self, request: Request, effects: tuple[str, ...]) -> Array:
        """The state unchanged: no effect has a state of its own."""
        return request.state

    def state_scale(self, effects: tuple[str, ...]) -> Array:
        """The noise; for a rate, the change that adds up to as much over a segment."""
        sigma = dict(zip(self.channels, self.runs[0].sigma[0].tolist(), strict=True))
        adds = {
            state: math.sqrt(3) / self.segment_length * sigma[output]
            for state, output in self.machine.rate_of.items()
        }
        return np.array([{**sigma, **adds}[name] for name in self.machine.states])

    def least_process_noise(self, run: int, effects: tuple[str, ...]) -> Array:
        """Zero: none is known."""
        return np.zeros(len(self.machine.states))

    def state_prior(self, effects: tuple[str, ...]) -> Array:
        """Infinite: nothing is known."""
        return np.full(len(self.machine.states), np.inf)

    # ---- prediction

    def prepare(self, every: Iterable[tuple[str, ...]]) -> None:
        """Compile ahead."""
        prepare((self._system(one)[0] for one in every), self._system(())[0])

    def simulate(
        self, requests: Sequence[Request], effects: tuple[str, ...]
    ) -> Sequence[Simulation]:
        """Simulate segments."""
        return [
            Simulation(self.recorded(one.segment).off(made.seen), made.states[:, -1])
            for one, _, made in self.made(requests, effects)
        ]

    def linearise(
        self, requests: Sequence[Request], effects: tuple[str, ...], wanted: tuple[str, ...]
    ) -> Sequence[Linearisation]:
        """Linearise segments."""
        return self._linearised(requests, effects, wanted)

    def predicted(self, request: Request, effects: tuple[str, ...]) -> Array:
        """The predicted recording of a segment (n, channels)."""
        return self.made([request], effects)[0][2].seen

    def made(
        self,
        requests: Sequence[Request],
        effects: tuple[str, ...],
        inputs: Mapping[int, Signals] | None = None,
    ) -> list[Made]:
        """Simulated segments; inputs: replace those recorded in some recordings."""
        system, names = self._system(effects)
        signals = self._signals(effects)
        drives = self._drives.with_inputs(inputs) if inputs else self._drives
        paths = [
            drives.path(self._piece(one.segment), signals, {**self.nominal, **one.values})
            for one in requests
        ]
        asked = [
            (path, one.state, self._values(names, one))
            for one, path in zip(requests, paths, strict=True)
        ]
        return list(zip(requests, paths, predict_all(system, asked), strict=True))

    def _linearised(
        self,
        requests: Sequence[Request],
        effects: tuple[str, ...],
        wanted: tuple[str, ...],
        more: DriveSlopes | None = None,
    ) -> list[Linearisation]:
        system, names = self._system(effects)
        signals = self._signals(effects)
        extra = more.at.shape[2] if more else 0
        by = np.array([[float(own == name) for name in wanted] for own in names])
        by = np.hstack([by.reshape(len(names), len(wanted)), np.zeros((len(names), extra))])
        sought = []
        for one, path, made in self.made(requests, effects):
            values = {**self.nominal, **one.values}
            moved = self._drives.slopes(self._piece(one.segment), signals, values, wanted)
            if more:
                moved = beside(moved, more, len(wanted))
            p = self._values(names, one)
            sought.append(Sought(path, made, p, by, moved, self.recorded(one.segment)))
        return [Linearisation(gram, end) for gram, end in grams(system, sought)]

    def _values(self, names: Sequence[str], request: Request) -> Array:
        own, nominal = request.values, self.nominal
        return np.array([own.get(name, nominal.get(name, 0.0)) for name in names])

    def _piece(self, segment: Segment) -> Piece:
        piece = self._pieces[segment.run]
        return Piece(piece.recording, piece.first + segment.first, piece.first + segment.last + 1)

    def recorded(self, segment: Segment) -> Recorded:
        """The data of a simulated segment, without those of the next one."""
        if segment not in self._recordeds:
            data = self.runs[segment.run]
            values = data.values[segment.span].copy()
            values[segment.until - segment.first :] = np.nan
            self._recordeds[segment] = Recorded.of(values, data.weighted_sigma[segment.span])
        return self._recordeds[segment]

    def _system(self, effects: tuple[str, ...]) -> tuple[System, tuple[str, ...]]:
        own = (one.name for one in self._present(effects) if one.name)
        return system_of(self.machine, tuple(own))

    def _signals(self, effects: tuple[str, ...]) -> list[MachineEffect]:
        return [one for one in self._present(effects) if one.port == "signal"]

    def _present(self, effects: tuple[str, ...]) -> list[MachineEffect]:
        named = {*effects, *self._given}
        return [*self.machine.signals, *(e for e in self.machine.effects if e.name in named)]

    # ---- data

    def _data(self, piece: Piece) -> Data:
        run, span = self.experiment.runs[piece.recording], slice(piece.first, piece.until)
        values = np.column_stack([run.outputs[name][span] for name in self.channels])
        sigma = np.array([run.sigma[name] for name in self.channels])
        sigma = sigma * [one.level for one in self._noise]
        correlation = np.array([one.correlation for one in self._noise])
        wide = np.broadcast_to(sigma, values.shape).copy()
        t, name = run.t[span], run.name
        if len(t) < len(run):
            name = f"{name} {t[0]:.3g}-{t[-1]:.3g} s"
        return Data(name, t, values, wide, run.held_out, correlation=correlation)

    def recording(self, run: int) -> int:
        """Index of the recording that a run is part of."""
        return self._pieces[run].recording

    def _off(self, misfits: Sequence[Misfit]) -> list[tuple[str, float, str]]:
        some = [one for one in misfits if one.held_out] or list(misfits)
        out = []
        for k, one in enumerate(self.machine.outputs):
            off = np.concatenate([(m.predicted - m.recorded)[:, k] for m in some])
            out.append((one.words, float(np.sqrt(np.nanmean(off**2))), one.unit))
        return out
