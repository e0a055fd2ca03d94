"""The drive of a machine: recorded inputs, linear between samples, as effects change them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import numpy as np

from rr_opt.array import Array
from rr_opt.model.machine import Machine, MachineEffect, MachineRun, Scales, Signals
from rr_opt.sysid.paths import DrivePath, DriveSlopes

_KEPT = 8
"""Sets of constants whose drives are cached."""


@dataclass(frozen=True)
class Piece:
    """A part of a recording that is predicted separately: samples first <= k < until."""

    recording: int
    first: int
    until: int


@dataclass
class MeasuredDrives:
    """The drives of all recordings."""

    machine: Machine
    recordings: Sequence[MachineRun]
    scales: Scales
    _kept: dict[tuple, dict] = field(default_factory=dict)

    def with_inputs(self, inputs: Mapping[int, Signals]) -> MeasuredDrives:
        """The same with some inputs of some recordings replaced."""
        runs = [
            replace(run, inputs={**run.inputs, **inputs.get(k, {})})
            for k, run in enumerate(self.recordings)
        ]
        return MeasuredDrives(self.machine, runs, self.scales)

    def path(
        self, piece: Piece, signals: Sequence[MachineEffect], values: Mapping[str, float]
    ) -> DrivePath:
        """The drive over a piece.

        signals  effects on the inputs, with constants in values, 0 unless given
        """
        constants = tuple(values.get(e.quantity(c.name), 0.0) for e in signals for c in e.constants)
        key = (tuple(e.name for e in signals), constants)
        if key not in self._kept:
            while len(self._kept) >= _KEPT:
                del self._kept[next(iter(self._kept))]
            self._kept[key] = {}
        kept = self._kept[key]
        if piece not in kept:
            if piece.recording not in kept:
                kept[piece.recording] = self._whole(piece.recording, signals, constants)
            kept[piece] = kept[piece.recording].part(piece.first, piece.until - 1)
        return kept[piece]

    def slopes(
        self,
        piece: Piece,
        signals: Sequence[MachineEffect],
        values: Mapping[str, float],
        wanted: Sequence[str],
    ) -> DriveSlopes | None:
        """Derivatives of the inputs by the signals' constants, by differences; None if none is
        wanted."""
        own = [(e, c) for e in signals for c in e.constants if e.quantity(c.name) in wanted]
        if not own:
            return None
        here = self.path(piece, signals, values)
        at = np.empty((*here.at.shape, len(own)))
        middle = np.empty((len(here.nodes), here.h.size, len(own)))
        for k, (effect, constant) in enumerate(own):
            name = effect.quantity(constant.name)
            step, value = 0.05 * constant.size(self.scales), values.get(name, 0.0)
            ends = [min(max(value + s, constant.low), constant.high) for s in (step, -step)]
            up, down = (self.path(piece, signals, {**values, name: x}) for x in ends)
            at[..., k] = (up.at - down.at) / (ends[0] - ends[1])
            middle[..., k] = (up.nodes[:, 1] - down.nodes[:, 1]) / (ends[0] - ends[1])
        columns = [wanted.index(effect.quantity(constant.name)) for effect, constant in own]
        return DriveSlopes(at, middle, np.array(columns))

    def _whole(
        self, recording: int, signals: Sequence[MachineEffect], constants: Sequence[float]
    ) -> DrivePath:
        run, left = self.recordings[recording], iter(constants)
        u = run.inputs
        for effect in signals:
            c = SimpleNamespace(**{k.name: next(left) for k in effect.constants})
            u = {**u, **effect.law(run.t, u, c)}
        rows = [u[c.name] for c in self.machine.inputs]
        return straight(run.t, rows, len(self.machine.ports), self.machine.step)


def straight(t: Array, inputs: Sequence[Array], unknown: int, step: float) -> DrivePath:
    """Inputs that are linear between samples, followed by unknown ones that are 0."""
    usual = float(np.median(np.diff(t)))
    each = 1 << max(int(np.ceil(np.log2(usual / step))), 0)
    inner = np.arange(each) / each
    edges = np.append((t[:-1, None] + np.diff(t)[:, None] * inner).ravel(), t[-1])
    rows = np.array([np.interp(edges, t, u) for u in inputs])
    rows = np.vstack([rows, np.zeros((unknown, edges.size))])
    nodes = np.stack([rows[:, :-1], (rows[:, :-1] + rows[:, 1:]) / 2, rows[:, 1:]], axis=1)
    return DrivePath(np.diff(edges), nodes, rows[:, ::each], each)


def beside(moved: DriveSlopes | None, more: DriveSlopes, wanted: int) -> DriveSlopes:
    """Slopes by the wanted quantities, with further columns appended."""
    if moved is None:
        return replace(more, columns=wanted + more.columns)
    return DriveSlopes(
        np.concatenate([moved.at, more.at], axis=-1),
        np.concatenate([moved.middle, more.middle], axis=-1),
        np.concatenate([moved.columns, wanted + more.columns]),
    )
