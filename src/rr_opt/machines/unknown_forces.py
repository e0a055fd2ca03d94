"""What may push a machine that its model lacks: at each port a function of a state or an input."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

import numpy as np

from rr_opt.array import Array
from rr_opt.model.machine import Machine
from rr_opt.sysid.machine import CONSTANT, Term
from rr_opt.sysid.model import Request
from rr_opt.sysid.sensitivities import DriveSlopes
from rr_opt.sysid.shooting import DrivePath, Path

_SHAPES = 7
"""Points between which an unknown input is straight."""


def forces(
    machine: Machine, made: Sequence[tuple[Request, DrivePath, Path]]
) -> tuple[list[Term], Iterator[DriveSlopes]]:
    """The terms, and how they move the drive of each segment."""
    terms, shapes, column = [], [], 0
    known = (*machine.states, *(one.name for one in machine.inputs))
    for channel, name in itertools.product(machine.ports, (CONSTANT, *machine.variables)):
        row = len(machine.inputs) + list(machine.ports).index(channel)
        words, unit = machine.variables.get(name, (CONSTANT, ""))
        if name == CONSTANT:
            at, values = np.zeros(1), [np.zeros((3, path.h.size)) for _, path, _ in made]
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
        nodes = np.zeros((path.nodes.shape[0], 3, path.h.size, column))
        for (row, at, values), term in zip(shapes, terms, strict=True):
            nodes[row][:, :, list(term.columns)] = _hats(values[k], at)
        return DriveSlopes(np.zeros((path.nodes.shape[0], path.at.shape[1], column)), nodes)

    return terms, (moved(k, path) for k, (_, path, _) in enumerate(made))


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
