"""A machine's equations as a system to be stepped, its numbers as quantities to be fitted, and its
unknown inputs: at each port a function of a state or a recorded input."""

import itertools
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.model.machine import Machine, MachineEffect, MachineRun, Scales
from rr_opt.model.parameters import Uncertainty
from rr_opt.sysid.machine import CONSTANT, Term
from rr_opt.sysid.model import EffectInfo, Form, Quantity, Request
from rr_opt.sysid.paths import DrivePath, DriveSlopes, Path
from rr_opt.sysid.shooting import System
from rr_opt.units import Number

_EVERY = 0.05
"""s, over which rates are averaged to suppress noise."""


@lru_cache
def system_of(machine: Machine, effects: tuple[str, ...]) -> tuple[System, tuple[str, ...]]:
    """The equations of motion with some effects, and the names of their parameters."""
    inside = [one for one in map(machine.effect, effects) if one.port != "signal"]
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


def scales_of(machine: Machine, runs: Sequence[MachineRun], nominal: Mapping[str, float]) -> Scales:
    """Usual sizes in some recordings."""
    sizes = {c.name: _rms([run.inputs[c.name] for run in runs]) for c in machine.inputs}
    for c in machine.outputs:
        sizes[f"{c.name}_rate"] = _rms([_rates(run.t, run.outputs[c.name]) for run in runs])
    return machine.scales({**nominal, **sizes})


def parameter_quantity(machine: Machine, name: str, value: float, known: Uncertainty) -> Quantity:
    """A parameter of the nominal model."""
    own = machine.parameter(name)
    assert own is not None
    if known.factor:
        # 0 has no factor: such a value may be anything usual.
        size = (
            abs(value) or abs(Number(own.unit, own.example).read(own.example)) or own.spread.sigma
        )
        low, high = sorted((value / known.factor, (value or size) * known.factor))
        low = low if own.low > 0 else own.low  # friction may be zero
        return Quantity(name, own.unit, value, size, True, low, high, value, free=True)
    return Quantity(name, own.unit, value, known.sigma, True, own.low, own.high, value)


def effect_info(effect: MachineEffect, scales: Scales) -> EffectInfo:
    """An effect as a candidate for what is missing."""

    def form(names: Sequence[str]) -> Form:
        own = [(effect.quantity(c.name), c) for c in effect.constants if c.name in names]
        quantities = (
            Quantity(name, c.unit, 0.0, c.size(scales), False, c.low, c.high, 0.0)
            for name, c in own
        )
        return Form(tuple(quantities), ({name: c.begin * c.size(scales) for name, c in own},))

    forms = effect.forms or (tuple(c.name for c in effect.constants),)
    return EffectInfo(
        *(effect.name, effect.channel, tuple(map(form, forms))),
        smooth=effect.smooth,
        form_error=effect.form_error,
    )


def _rms(parts: Sequence[Array]) -> float:
    return float(np.sqrt(np.nanmean(np.concatenate(parts) ** 2)))


def _rates(t: Array, y: Array) -> Array:
    every = max(round(_EVERY / float(np.median(np.diff(t)))), 1)
    return np.diff(y[::every]) / np.diff(t[::every])


_SHAPES = 7
"""Knots between which an unknown input is linear."""


def unknown_inputs(
    machine: Machine, made: Sequence[tuple[Request, DrivePath, Path]]
) -> tuple[list[Term], Iterator[DriveSlopes]]:
    """The terms, and the derivatives of each segment's drive by them."""
    terms, shapes, column = [], [], 0
    known = (*machine.states, *(one.name for one in machine.inputs))
    for channel, name in itertools.product(machine.ports, (CONSTANT, *machine.variables)):
        row = len(machine.inputs) + list(machine.ports).index(channel)
        words, unit = machine.variables.get(name, (CONSTANT, ""))
        if name == CONSTANT:
            at, values = np.zeros(1), [np.zeros(path.h.size) for _, path, _ in made]
        else:
            values = [_along(known.index(name), path, way) for _, path, way in made]
            at = _knots(np.concatenate([one.ravel() for one in values]))
            if at.size < 3:
                continue
        columns = tuple(range(column, column + at.size))
        terms.append(Term(channel, words, columns, unit, at, np.eye(at.size)))
        shapes.append((row, at, values))
        column += at.size

    def moved(k: int, path: DrivePath) -> DriveSlopes:
        middle = np.zeros((len(path.nodes), path.h.size, column))
        for (row, at, values), term in zip(shapes, terms, strict=True):
            middle[row][:, list(term.columns)] = _hats(values[k], at)
        at = np.zeros((len(path.nodes), path.at.shape[1], column))
        return DriveSlopes(at, middle, np.arange(column))

    return terms, (moved(k, path) for k, (_, path, _) in enumerate(made))


def _along(k: int, path: DrivePath, made: Path) -> Array:
    """A state or an input in the middle of each step (steps,)."""
    states = made.states
    if k >= len(states):
        return path.nodes[k - len(states), 1]
    return (states[k, :-1] + states[k, 1:]) / 2


def _knots(values: Array) -> Array:
    """Knots of an unknown input, with equally many values between neighbours."""
    at = np.unique(np.quantile(values, np.linspace(0.01, 0.99, _SHAPES)))
    return at[np.append(True, np.diff(at) > 1e-3 * np.ptp(at))] if at.size > 1 else at


def _hats(values: Array, at: Array) -> Array:
    """Hat functions: 1 at one of the knots and 0 at the others (..., knots)."""
    if at.size == 1:
        return np.ones((*values.shape, 1))
    unit = np.eye(at.size)
    return np.stack([np.interp(values, at, row) for row in unit], axis=-1)
