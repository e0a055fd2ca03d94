"""What may push a Roller Racer that its model lacks, as functions of what it may depend on.

Each channel, a place where a force or a motion can enter, is tried with each variable, as a few
functions of it along the recorded path.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.machines.racer.model import RacerModel
from rr_opt.machines.racer.observed import Along, observed
from rr_opt.machines.racer.unknown_input import linearised_inputs
from rr_opt.sysid.estimation import Fit
from rr_opt.sysid.machine import CONSTANT, Term
from rr_opt.sysid.model import Linearisation, Segment

CHANNELS: Mapping[str, tuple[float, ...]] = {
    "rolling": (1, 1, 1, 1, 0, 0, 0),
    "yaw": (-1, 1, -1, 1, 0, 0, 0),
    "constraint_axle1": (0, 0, 0, 0, 1, 0, 0),
    "constraint_axle2": (0, 0, 0, 0, 0, 1, 0),
    "actuation": (0, 0, 0, 0, 0, 0, 1),
}
"""What of PUSHES each channel moves; rolling forces along the wheels' directions."""

_SIDE, _ANGLE = 0.02, 0.02
"""Usual sizes: of a side speed, as a share of the robot's; of an error of the angle, rad."""


@dataclass(frozen=True)
class _Variable:
    """A variable (n,) along a path, and functions (n,) of it that are of about unit size.

    grid  where they are shown; empty where they are not functions of it alone
    """

    unit: str
    of: Callable[[_Moving], Array]
    functions: tuple[Callable[[Array, _Moving], Array], ...]
    grid: Array


@dataclass(frozen=True)
class _Moving:
    """A recorded path, the phase of its gait (n,), and the usual speed, m/s."""

    along: Along
    phase: Array
    usual: float

    @property
    def speed(self) -> Array:
        """Of the axles, over the usual one."""
        return self.along.axles.mean(axis=0) / self.usual


_ROUND = np.linspace(0, 2 * math.pi, 37)
_ACROSS = np.linspace(-2.0, 2.0, 41)
_NONE = np.zeros(0)


def _centred(x: Array) -> Array:
    return (x - x.mean()) / max(float(np.ptp(x)), 1e-3)


_VARIABLES: Mapping[str, _Variable] = {
    "phase of the cycle": _Variable(
        "rad",
        lambda m: m.phase,
        tuple(lambda x, _, k=k, f=f: f(k * x) for k in (1, 2) for f in (np.sin, np.cos)),
        _ROUND,
    ),
    "speed": _Variable(
        "of the usual",
        lambda m: m.speed,
        (lambda x, _: x, lambda x, _: x * np.abs(x), lambda x, _: np.tanh(5 * x)),
        _ACROSS,
    ),
    "heading": _Variable(
        "rad", lambda m: m.along.psi, (lambda x, _: np.sin(x), lambda x, _: np.cos(x)), _ROUND
    ),
    "place": _Variable(
        "m",
        lambda m: m.along.x,
        (lambda _, m: m.speed * _centred(m.along.x), lambda _, m: m.speed * _centred(m.along.y)),
        _NONE,
    ),
    "time": _Variable(
        "s", lambda m: m.along.t, (lambda x, m: m.speed * x / max(float(x[-1]), 1e-9),), _NONE
    ),
    CONSTANT: _Variable("", lambda m: m.along.t, (lambda x, _: np.ones_like(x),), _NONE),
}


def unknown_terms(
    racer: RacerModel, fit: Fit
) -> tuple[Sequence[Term], Mapping[Segment, Linearisation]]:
    """The terms, and the fit's segments linearised in the quantities and in the terms."""
    given = racer.simulator.given(fit.values)
    drag = (given["kappa1"] + given["kappa2"]) / 2 / given["h"] ** 2 * racer.setting.speed
    sizes = np.array([drag] * 4 + [_SIDE * racer.setting.speed] * 2 + [_ANGLE])
    usual = max(racer.setting.speed, 1e-6)
    requests, every, terms = fit.problem.requests(fit.values, fit.states), [], []
    for request in requests:
        along = observed(racer, request, fit.effects)
        gait = racer.experiment.runs[request.segment.run].gait
        moving = _Moving(along, 2 * math.pi * along.t / gait.period, usual)
        terms, columns = _terms(moving, sizes)
        every.append(columns)
    parts = linearised_inputs(racer, requests, fit.effects, fit.problem.names, every)
    return terms, {one.segment: part for one, part in zip(requests, parts, strict=True)}


def _terms(moving: _Moving, sizes: Array) -> tuple[list[Term], Array]:
    """Of every channel and variable, and their inputs along a path (columns, 7, n)."""
    terms: list[Term] = []
    columns: list[Array] = []
    for channel, pushes in CHANNELS.items():
        shape = sizes * np.array(pushes)
        size = float(np.abs(shape).max())
        for name, variable in _VARIABLES.items():
            first, x = len(columns), variable.of(moving)
            columns += [shape[:, None] * f(x, moving) for f in variable.functions]
            own = tuple(range(first, len(columns)))
            # A curve that is shown is of the variable alone, so that the path does not matter.
            alone = np.zeros((0, len(own)))
            if variable.grid.size:
                shown = [size * f(variable.grid, moving) for f in variable.functions]
                alone = np.array(shown).T
            terms.append(Term(channel, name, own, variable.unit, variable.grid, alone))
    return terms, np.array(columns)
