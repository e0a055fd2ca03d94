"""Any machine of `model.machine`, driven by measured inputs, as a model that can be identified.

The inputs are straight between the samples, and noisy: what that noise makes of a prediction is
part of what no model can do better (`form_error`). How far a prediction can be trusted is seen from
the machine itself: an unstable posture multiplies every error, and a window is no longer than that
takes to spoil it.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property, lru_cache
from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.model.machine import Constant, Machine, MachineEffect, MachineExperiment, MachineRun
from rr_opt.model.parameters import Uncertainty
from rr_opt.sysid.diagnosis import Misfit
from rr_opt.sysid.estimation import Fit
from rr_opt.sysid.machine import CONSTANT, Term
from rr_opt.sysid.model import (
    Choice,
    Data,
    EffectInfo,
    Form,
    Linearisation,
    Noise,
    Quantity,
    Request,
    Segment,
    Simulation,
    segments,
)
from rr_opt.sysid.sensitivities import DriveSlopes, Recorded, Sought, grams
from rr_opt.sysid.shooting import DrivePath, Path, System, predict_all

SPOILT = 7.4
"""e^2: a window is no longer than errors take to grow so many times anywhere."""

_WINDOWS = (0.125, 0.25, 0.5, 1.0, 2.0)
"""Lengths of windows, s."""

WINDOWS = 2.0
"""In a part of a recording that is predicted from the others."""

STIRRED = 6.0
"""RMS in sigma: nor are the inputs' errors to drown what is recorded."""

MODES = 4
"""Of the errors that a force left out makes in a window, beside those that its start takes up."""

_EARLY = 0.05
"""s, from which the state at the beginning of a segment is seen."""

_DRAWS = 3
"""Of the inputs' noise."""

_SHAPES = 7
"""Points between which an unknown input is straight."""


class OdeModel:
    """Recordings of a machine; answers `sysid.model.Model`."""

    def __init__(
        self,
        experiment: MachineExperiment,
        noise: Sequence[Noise] | None = None,
        *,
        parted: bool = False,
    ) -> None:
        """noise: of each output, against what the recordings state; parted: into runs already."""
        self.experiment, self.machine = experiment, experiment.machine
        machine = self.machine
        self.channels = tuple(one.name for one in machine.outputs)
        self._noise = noise or [Noise()] * len(self.channels)
        self.nominal = dict(experiment.nominal)
        self.runs: Sequence[Data] = [self._data(run) for run in experiment.runs]
        self.parameters = tuple(
            _quantity(machine, name, self.nominal[name], experiment.uncertainty[name])
            for name in (one.name for one in machine.parameters)
            if name in experiment.uncertainty
        )
        given = {name.partition(".")[0] for name in self.nominal if "." in name}
        self._given = tuple(sorted(given))
        self.catalogue: Mapping[str, EffectInfo] = {
            one.name: _info(one, self._scales) for one in machine.effects if one.name not in given
        }
        self.inputs = {channel: words for channel, (_, _, words) in machine.ports.items()}
        self.bandwidth = machine.bandwidth
        self._paths: dict[Any, tuple[DrivePath, Array | None]] = {}
        self.horizon = self.segment_length = 0.5
        self.horizon = self.segment_length = self._trusted()
        self.correlation_time = self.horizon / MODES
        if not parted:
            length = WINDOWS * self.horizon
            # Windows are independent: parts of a recording are predicted from one another.
            parts = (part for run in experiment.runs for part in _parts(run, length))
            self.experiment = replace(experiment, runs=tuple(parts))
            self.runs = [self._data(run) for run in self.experiment.runs]
            self._paths.clear()

    def with_noise(self, noise: Sequence[Noise]) -> OdeModel:
        """The same with other noise."""
        of_stated = [
            replace(new, level=new.level * old.level)
            for new, old in zip(noise, self._noise, strict=True)
        ]
        other = OdeModel(self.experiment, of_stated, parted=True)
        other.horizon = other.segment_length = self.horizon
        other.correlation_time = self.correlation_time
        return other

    @property
    def form_error(self) -> float:
        """RMS in sigma that the inputs' own noise leaves in a prediction, its start refitted."""
        return self._form_error

    @cached_property
    def _form_error(self) -> float:
        return self._stirred(self.horizon)

    def _stirred(self, length: float) -> float:
        rng, left, count = np.random.default_rng(0), 0.0, 0
        for k, run in enumerate(self.experiment.runs):
            noisy = [c.name for c in self.machine.inputs if run.sigma.get(c.name, 0.0) > 0]
            if not noisy:
                continue
            cut = segments({k: self.runs[k]}, length)
            asked = self._guessed(cut)
            for _ in range(_DRAWS):
                drawn = {
                    name: run.inputs[name] + run.sigma[name] * rng.standard_normal(len(run))
                    for name in noisy
                }
                other = self._made(asked, (), {k: drawn})
                for plain, moved, by in zip(
                    self._made(asked, ()), other, self._starts(asked), strict=True
                ):
                    one, _, _ = plain
                    off = ((moved[2].seen - plain[2].seen) * self._recorded(one).weight).ravel()
                    off = np.where(np.isfinite(off), off, 0.0)
                    off -= by @ np.linalg.lstsq(by, off, rcond=None)[0]
                    left, count = left + float(off @ off), count + off.size
        return float(np.sqrt(left / count)) if count else 0.0

    # ---- protocol

    def upstream(self) -> Sequence[tuple[tuple[Choice, ...], Mapping[str, float]]]:
        """Nothing: what drives it is taken as it was measured."""
        return [((), {})]

    def proposals(
        self, fit: Fit, complete: Sequence[str]
    ) -> Sequence[tuple[Choice, Mapping[str, float]]]:
        """Where the forms of effects without derivatives say."""
        return [
            (Choice(name), guess)
            for name, info in self.catalogue.items()
            if not info.smooth and name not in complete
            for guess in info.forms[0].guesses
        ]

    def next_experiment(self, best: Fit, rival: tuple[str, Fit] | None) -> None:
        """Not looked for."""

    def equivalent(self, values: Mapping[str, float]) -> None:
        """None: no two sets of values are alike."""

    def worth(self, before: Sequence[Misfit], after: Sequence[Misfit]) -> str:
        """By how much the outputs are off, in their own units."""
        pairs = zip(self._off(before), self._off(after), strict=True)
        listed = ", ".join(f"{b[0]} was {b[1]:.3g} {b[2]} off and is {a[1]:.3g} {a[2]} off now"
                           for b, a in pairs)  # fmt: skip
        return f"predicted over {self.horizon:.3g} s, {listed} (RMS); "

    def accuracy(self, misfits: Sequence[Misfit]) -> str:
        """The same, of the corrected model."""
        listed = ", ".join(f"{name} to {off:.3g} {unit}" for name, off, unit in self._off(misfits))
        return f"Over {self.horizon:.3g} s the corrected model predicts {listed} (RMS)."

    def initial_state(
        self, segment: Segment, effects: tuple[str, ...], values: Mapping[str, float]
    ) -> Array:
        """From straight lines through the first moments of the outputs."""
        run, data = self.experiment.runs[segment.run], self.runs[segment.run]
        t = data.t[segment.first :]
        early = slice(segment.first, segment.first + max(int(np.searchsorted(t, t[0] + _EARLY)), 4))
        seen: dict[str, float] = {name: float(y[segment.first]) for name, y in run.inputs.items()}
        for k, name in enumerate(self.channels):
            y, at = data.values[early, k], data.t[early] - t[0]
            known = np.isfinite(y)
            if known.sum() < 2:
                y, at = data.values[:, k], data.t - t[0]
                known = np.isfinite(y) & (np.abs(at) <= 10 * _EARLY)
            slope, first = np.polyfit(at[known], y[known], 1)
            seen |= {name: float(first), f"{name}_rate": float(slope)}
        begun = self.machine.start(seen)
        return np.array([begun[name] for name in self.machine.states])

    def converted(
        self, request: Request, before: tuple[str, ...], effects: tuple[str, ...]
    ) -> Array:
        """The same: no effect has a state of its own."""
        return request.state

    @cached_property
    def _state_scale(self) -> Array:
        """As much as noise; of a rate as much as makes that in a window, as a force pushes both."""
        sigma = {c: float(np.nanmedian(self.runs[0].sigma[:, k]))
                 for k, c in enumerate(self.channels)}  # fmt: skip
        rest = float(np.sqrt(np.mean(np.square(list(sigma.values())))))
        own = [sigma.get(s, np.sqrt(3) * rest / self.segment_length) for s in self.machine.states]
        return np.array(own)

    def state_scale(self, effects: tuple[str, ...]) -> Array:
        """See above."""
        return self._state_scale

    def state_prior(self, effects: tuple[str, ...]) -> Array:
        """Nothing is known."""
        return np.full(self._state_scale.size, np.inf)

    def simulate(
        self, requests: Sequence[Request], effects: tuple[str, ...]
    ) -> Sequence[Simulation]:
        """Simulate segments."""
        return [
            Simulation(self._recorded(one).off(made.seen), made.states[:, -1])
            for one, _, made in self._made(requests, effects)
        ]

    def linearise(
        self, requests: Sequence[Request], effects: tuple[str, ...], wanted: tuple[str, ...]
    ) -> Sequence[Linearisation]:
        """Linearise segments."""
        return self._linearised(requests, effects, wanted)

    def predicted(self, request: Request, effects: tuple[str, ...]) -> Array:
        """What would be recorded of a segment (n, channels)."""
        return self._made([request], effects)[0][2].seen

    def unknown_inputs(self, fit: Fit) -> tuple[Sequence[Term], Mapping[Segment, Linearisation]]:
        """At each port something that depends on a state or an input."""
        problem, machine = fit.problem, self.machine
        requests = problem.requests(fit.values, fit.states)
        made = self._made(requests, fit.effects)
        terms, shapes, column = [], [], 0
        known = (*machine.states, *(one.name for one in machine.inputs))
        for channel, name in itertools.product(machine.ports, (CONSTANT, *machine.variables)):
            row = len(machine.inputs) + list(machine.ports).index(channel)
            words, unit = machine.variables.get(name, (CONSTANT, ""))
            if name == CONSTANT:
                at, values = np.zeros(1), [np.zeros((3, path.h.size)) for _, path, _ in made]
            else:
                k = known.index(name)
                values = [_along(k, path, way) for _, path, way in made]
                at = _knots(np.concatenate([one.ravel() for one in values]))
                if at.size < 3:
                    continue
            columns = tuple(range(column, column + at.size))
            terms.append(Term(channel, words, columns, unit, at, np.eye(at.size)))
            shapes.append((row, at, values))
            column += at.size
        nq, out = len(problem.names), {}
        names = problem.names

        def moved(k: int, path: DrivePath) -> DriveSlopes:
            nodes = np.zeros((path.nodes.shape[0], 3, path.h.size, column))
            for (row, at, values), term in zip(shapes, terms, strict=True):
                nodes[row][:, :, list(term.columns)] = _hats(values[k], at)
            return DriveSlopes(np.zeros((path.nodes.shape[0], path.at.shape[1], column)), nodes)

        for k, (one, every) in enumerate(zip(requests, made, strict=True)):
            (linear,) = self._linearised([one], fit.effects, names, moved(k, every[1]))
            out[one.segment] = linear
        assert nq == len(names)
        return terms, out

    # ---- prediction

    def _made(
        self,
        requests: Sequence[Request],
        effects: tuple[str, ...],
        inputs: Mapping[int, Mapping[str, Array]] | None = None,
    ) -> list[tuple[Request, DrivePath, Path]]:
        system, names = self._system(effects)
        paths = [self._path(one, effects, inputs or {}) for one in requests]
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
        extra = more.at.shape[2] if more else 0
        by = np.array([[float(own == name) for name in wanted] for own in names])
        by = np.hstack([by.reshape(len(names), len(wanted)), np.zeros((len(names), extra))])
        sought = []
        for one, path, made in self._made(requests, effects):
            moved = self._moved(one, effects, wanted, path)
            if more:
                moved = _beside(moved, more, path, len(wanted))
            p = self._values(names, one)
            sought.append(Sought(path, made, p, by, moved, self._recorded(one)))
        return [Linearisation(gram, end) for gram, end in grams(system, sought)]

    def _values(self, names: Sequence[str], request: Request) -> Array:
        given = {**self.nominal, **request.values}
        return np.array([given.get(name, 0.0) for name in names])

    def _recorded(self, request: Request) -> Recorded:
        segment, data = request.segment, self.runs[request.segment.run]
        values = data.values[segment.span].copy()
        values[segment.until - segment.first :] = np.nan
        return Recorded.of(values, data.weighted_sigma[segment.span])

    def _system(self, effects: tuple[str, ...]) -> tuple[System, tuple[str, ...]]:
        every = {*effects, *self._given}
        own = tuple(one.name for one in self.machine.effects if one.name in every)
        return _system(self.machine, own)

    def _signals(self, effects: tuple[str, ...]) -> list[MachineEffect]:
        every = {*effects, *self._given}
        return [e for e in self.machine.effects if e.port == "signal" and e.name in every]

    def _path(
        self, request: Request, effects: tuple[str, ...], inputs: Mapping[int, Mapping[str, Array]]
    ) -> DrivePath:
        run = request.segment.run
        signals = self._signals(effects)
        whole = self._whole(run, signals, request.values, inputs.get(run))
        return _part(whole, request.segment)

    def _whole(
        self,
        run: int,
        signals: Sequence[MachineEffect],
        values: Mapping[str, float],
        inputs: Mapping[str, Array] | None = None,
    ) -> DrivePath:
        given = {**self.nominal, **values}
        constants = tuple(given.get(e.quantity(c.name), 0.0) for e in signals for c in e.constants)
        key = (run, tuple(e.name for e in signals), constants)
        if inputs is None and key in self._paths:
            return self._paths[key][0]
        one = self.experiment.runs[run]
        u = {**one.inputs, **(inputs or {})}
        left = iter(constants)
        for effect in signals:
            c = SimpleNamespace(**{k.name: next(left) for k in effect.constants})
            u = {**u, **effect.law(one.t, u, c)}
        path = _drive(one.t, [u[c.name] for c in self.machine.inputs], len(self.machine.ports),
                      self.machine.step)  # fmt: skip
        if inputs is None:
            if len(self._paths) > 200:
                self._paths.clear()
            self._paths[key] = (path, None)
        return path

    def _moved(
        self, request: Request, effects: tuple[str, ...], wanted: tuple[str, ...], path: DrivePath
    ) -> DriveSlopes | None:
        """How the inputs move with the constants of signals, by differences."""
        signals = self._signals(effects)
        own = [(e, c) for e in signals for c in e.constants if e.quantity(c.name) in wanted]
        if not own:
            return None
        at = np.zeros((*path.at.shape, len(wanted)))
        nodes = np.zeros((*path.nodes.shape, len(wanted)))
        for effect, constant in own:
            name = effect.quantity(constant.name)
            step = 0.05 * constant.size(self._scales)
            value = request.values.get(name, 0.0)
            ends = [min(max(value + s, constant.low), constant.high) for s in (step, -step)]
            up, down = (
                _part(self._whole(request.segment.run, signals, {**request.values, name: x}),
                      request.segment) for x in ends
            )  # fmt: skip
            k = wanted.index(name)
            at[..., k] = (up.at - down.at) / (ends[0] - ends[1])
            nodes[..., k] = (up.nodes - down.nodes) / (ends[0] - ends[1])
        return DriveSlopes(at, nodes)

    # ---- what the recordings say of the machine

    @cached_property
    def _scales(self) -> Mapping[str, float]:
        runs = self.experiment.runs
        sizes = {
            one.name: float(
                np.sqrt(np.nanmean(np.concatenate([r.inputs[one.name] for r in runs]) ** 2))
            )
            for one in self.machine.inputs
        }
        for k, name in enumerate(self.channels):
            rates = [_rates(d.t, d.values[:, k]) for d in self.runs]
            sizes[f"{name}_rate"] = _rms(rates)
        return self.machine.scales({**self.nominal, **sizes})

    def _guessed(self, cut: Sequence[Segment]) -> list[Request]:
        return [Request(one, self.nominal, self.initial_state(one, (), {})) for one in cut]

    def _trusted(self) -> float:
        """The longest window over which errors do not grow too much, s."""
        fitted = {k: one for k, one in enumerate(self.runs) if not one.held_out}
        scale = self._state_scale
        trusted = _WINDOWS[0]
        for length in _WINDOWS:
            cut, size = segments(fitted, length), scale.size
            ends = [one.end[:, :size] for one in self._linearised(self._guessed(cut), (), ())]
            growth = max(np.linalg.norm(end * scale / scale[:, None], 2) for end in ends)
            if not (growth <= SPOILT and self._stirred(length) <= STIRRED):
                break
            trusted = length
        return trusted

    def _starts(self, requests: Sequence[Request]) -> list[Array]:
        """Residuals' derivatives by the start (n channels, size), by differences."""
        base = [made.seen for _, _, made in self._made(requests, ())]
        columns: list[list[Array]] = [[] for _ in requests]
        for k, step in enumerate(1e-4 * self._state_scale):
            asked = [replace(one, state=one.state + step * np.eye(one.state.size)[k])
                     for one in requests]  # fmt: skip
            for n, (one, _, made) in enumerate(self._made(asked, ())):
                by = (made.seen - base[n]) / step * self._recorded(one).weight
                columns[n].append(np.where(np.isfinite(by), by, 0.0).ravel())
        return [np.array(one).T for one in columns]

    def _data(self, run: MachineRun) -> Data:
        values = np.column_stack([run.outputs[name] for name in self.channels])
        sigma = np.array([run.sigma[name] for name in self.channels])
        sigma = sigma * [one.level for one in self._noise]
        correlation = np.array([one.correlation for one in self._noise])
        wide = np.broadcast_to(sigma, values.shape).copy()
        return Data(run.name, run.t, values, wide, run.held_out, correlation=correlation)

    def _off(self, misfits: Sequence[Misfit]) -> list[tuple[str, float, str]]:
        some = [one for one in misfits if one.held_out] or list(misfits)
        out = []
        for k, one in enumerate(self.machine.outputs):
            off = np.concatenate([(m.predicted - m.recorded)[:, k] for m in some])
            out.append((one.words, float(np.sqrt(np.nanmean(off**2))), one.unit))
        return out


@lru_cache
def _system(machine: Machine, effects: tuple[str, ...]) -> tuple[System, tuple[str, ...]]:
    """The motion with some effects in it, and the names of its parameters."""
    own = [machine.effect(name) for name in effects]
    inside = [one for one in own if one.port != "signal"]
    x = {name: ca.SX.sym(name) for name in machine.states}
    u = {one.name: ca.SX.sym(one.name) for one in machine.inputs}
    unknown = {port: ca.SX.sym(port) for port, _, _ in machine.ports.values()}
    p = {one.name: ca.SX.sym(one.name) for one in machine.parameters}
    p |= {e.quantity(c.name): ca.SX.sym(e.quantity(c.name)) for e in inside for c in e.constants}
    plain = {name: value for name, value in p.items() if "." not in name}

    def add(port: str, **local: Any) -> ca.SX:
        total = unknown.get(port, ca.SX(0))
        names = SimpleNamespace(**{**x, **u, **plain, **local})
        for effect in inside:
            if effect.port == port:
                constants = {c.name: p[effect.quantity(c.name)] for c in effect.constants}
                total = total + effect.law(names, SimpleNamespace(**constants))
        return total

    names = SimpleNamespace(**x, **u, **plain)
    inputs = [ca.vertcat(*x.values()), ca.vertcat(*u.values(), *unknown.values()),
              ca.vertcat(*p.values())]  # fmt: skip
    rates, seen = machine.rates(names, add), machine.seen(names, add)
    system = System(
        ca.Function("rates", inputs, [ca.vertcat(*(rates[name] for name in machine.states))]),
        ca.Function("seen", inputs, [ca.vertcat(*(seen[one.name] for one in machine.outputs))]),
        stiff=machine.stiff,
        lasts=True,
    )
    return system, tuple(p)


def _parts(run: MachineRun, length: float) -> list[MachineRun]:
    """A recording in equal parts of about a length, s."""
    count = max(int((run.t[-1] - run.t[0]) / length), 1)
    edges = np.linspace(0, len(run), count + 1).astype(int)
    if count == 1:
        return [run]

    def part(a: int, b: int) -> MachineRun:
        cut = {name: y[a:b] for name, y in run.inputs.items()}
        seen = {name: y[a:b] for name, y in run.outputs.items()}
        name = f"{run.name} {run.t[a]:.3g}-{run.t[b - 1]:.3g} s"
        return replace(run, name=name, t=run.t[a:b], inputs=cut, outputs=seen)

    return [part(a, b) for a, b in itertools.pairwise(edges.tolist())]


def _drive(t: Array, inputs: Sequence[Array], unknown: int, step: float) -> DrivePath:
    """Inputs that are straight between samples."""
    usual = float(np.median(np.diff(t)))
    each = 1 << max(int(np.ceil(np.log2(usual / step))), 0)
    inner = np.arange(each) / each
    edges = np.append((t[:-1, None] + np.diff(t)[:, None] * inner).ravel(), t[-1])
    rows = np.array([np.interp(edges, t, u) for u in inputs])
    rows = np.vstack([rows, np.zeros((unknown, edges.size))])
    nodes = np.stack([rows[:, :-1], (rows[:, :-1] + rows[:, 1:]) / 2, rows[:, 1:]], axis=1)
    return DrivePath(np.diff(edges), nodes, rows[:, ::each], each)


def _part(whole: DrivePath, segment: Segment) -> DrivePath:
    first, last, each = segment.first, segment.last, whole.each
    steps = slice(first * each, last * each)
    return DrivePath(whole.h[steps], whole.nodes[:, :, steps], whole.at[:, first : last + 1], each)


def _beside(
    moved: DriveSlopes | None, more: DriveSlopes, path: DrivePath, wanted: int
) -> DriveSlopes:
    if moved is None:
        moved = DriveSlopes(
            np.zeros((*path.at.shape, wanted)), np.zeros((*path.nodes.shape, wanted))
        )
    return DriveSlopes(
        np.concatenate([moved.at, more.at], axis=-1),
        np.concatenate([moved.nodes, more.nodes], axis=-1),
    )


def _along(k: int, path: DrivePath, made: Path) -> Array:
    """A state or an input (3, steps) at the beginning, middle and end of each step."""
    states = made.states
    if k >= len(states):
        return path.nodes[k - len(states)]
    y = states[k]
    return np.array([y[:-1], (y[:-1] + y[1:]) / 2, y[1:]])


def _knots(values: Array) -> Array:
    """Where an unknown input is shown: as many values between each two."""
    at = np.unique(np.quantile(values, np.linspace(0.01, 0.99, _SHAPES)))
    return at[np.append(True, np.diff(at) > 1e-3 * np.ptp(at))] if at.size > 1 else at


def _hats(values: Array, at: Array) -> Array:
    """Functions that are 1 at one of the knots and 0 at the others (..., knots)."""
    if at.size == 1:
        return np.ones((*values.shape, 1))
    unit = np.eye(at.size)
    return np.stack([np.interp(values, at, row) for row in unit], axis=-1)


def _rms(parts: Sequence[Array]) -> float:
    return float(np.sqrt(np.nanmean(np.concatenate(parts) ** 2)))


def _rates(t: Array, y: Array) -> Array:
    """Mean rates over a twentieth of a second each, so that noise does not count."""
    every = max(round(0.05 / float(np.median(np.diff(t)))), 1)
    return np.diff(y[::every]) / np.diff(t[::every])


def _quantity(machine: Machine, name: str, value: float, known: Uncertainty) -> Quantity:
    own = machine.parameter(name)
    assert own is not None
    if known.factor:
        low, high = sorted((value / known.factor, value * known.factor))
        low = low if own.low > 0 else own.low  # friction may be none
        return Quantity(name, own.unit, value, abs(value), True, low, high, value, free=True)
    return Quantity(name, own.unit, value, known.sigma, True, own.low, own.high, value)


def _info(effect: MachineEffect, scales: Mapping[str, float]) -> EffectInfo:
    sizes = {c.name: c.size(scales) for c in effect.constants}

    def quantity(c: Constant) -> Quantity:
        return Quantity(
            effect.quantity(c.name), c.unit, 0.0, sizes[c.name], False, c.low, c.high, 0.0
        )

    guess = {effect.quantity(c.name): c.begin * sizes[c.name] for c in effect.constants}
    form = Form(tuple(map(quantity, effect.constants)), (guess,))
    return EffectInfo(
        *(effect.name, effect.family, effect.channel, effect.sentence, (form,)),
        smooth=effect.smooth,
        form_error=effect.form_error,
    )
