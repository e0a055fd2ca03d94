"""Predicted runs: the drive along them, their states, and what to differentiate them by."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from rr_opt.array import Array, Indices

_SHORTEST = 100
"""Fewest samples in a piece."""


@dataclass(frozen=True)
class DrivePath:
    """The drive over all steps of a run.

    h      (steps,) s, `each` of them between two samples
    nodes  (size, 3, steps) at the beginning, in the middle and at the end of each step
    at     (size, samples) at the samples
    fine   how many steps derivatives take as one
    """

    h: Array
    nodes: Array
    at: Array
    each: int
    fine: int = 1

    @cached_property
    def inputs(self) -> Array:
        """(steps, 1 + 3 size): each step's length, and its drive at all three places."""
        nodes = self.nodes.transpose(2, 1, 0).reshape(self.h.size, -1)
        return np.column_stack([self.h, nodes])

    def part(self, first: int, last: int) -> DrivePath:
        """From sample `first` to sample `last`."""
        during = slice(first * self.each, last * self.each)
        h, nodes, at = self.h[during], self.nodes[:, :, during], self.at[:, first : last + 1]
        return DrivePath(h, nodes, at, self.each, self.fine)

    @cached_property
    def coarse(self) -> DrivePath:
        """In the steps of derivatives."""
        return self.coarser(self.fine)

    def coarser(self, count: int) -> DrivePath:
        """In steps of so many each; their middle is the mean."""
        split = self.nodes.reshape(*self.nodes.shape[:2], -1, count)
        nodes = split[:, 0, :, 0], split[:, 1].mean(axis=2), split[:, 2, :, -1]
        h = self.h.reshape(-1, count).sum(axis=1)
        return DrivePath(h, np.stack(nodes, axis=1), self.at, self.each // count)


@dataclass(frozen=True)
class Path:
    """The states (size, steps + 1) of a run and its outputs (samples, channels)."""

    states: Array
    seen: Array

    def part(self, first: int, last: int, each: int) -> Path:
        """From sample `first` to sample `last`, with `each` steps between two samples."""
        states = self.states[:, first * each : last * each + 1]
        return Path(states, self.seen[first : last + 1])

    def coarser(self, count: int) -> Path:
        """In steps of so many each."""
        return Path(self.states[:, ::count], self.seen)


@dataclass(frozen=True)
class DriveSlopes:
    """Derivatives of the drive by those wanted quantities that move it.

    at       (size, samples, k) at the samples
    middle   (size, steps, k) in the middle of each step
    columns  (k,) indices of these quantities
    """

    at: Array
    middle: Array
    columns: Indices

    def part(self, first: int, last: int, each: int) -> DriveSlopes:
        """From sample `first` to sample `last`, with `each` steps between two samples."""
        middle = self.middle[:, first * each : last * each]
        return DriveSlopes(self.at[:, first : last + 1], middle, self.columns)

    def coarser(self, count: int) -> DriveSlopes:
        """In steps of so many each."""
        size, steps, k = self.middle.shape
        middle = self.middle.reshape(size, steps // count, count, k).mean(axis=2)
        return DriveSlopes(self.at, middle, self.columns)


@dataclass(frozen=True)
class Recorded:
    """What was recorded (samples, channels), 0 for no data, and 1/sigma, 0 for no data."""

    values: Array
    weight: Array

    @classmethod
    def of(cls, values: Array, sigma: Array) -> Recorded:
        """From values that are NaN where there are no data."""
        seen = np.isfinite(values)
        return cls(np.where(seen, values, 0.0), np.where(seen, 1 / sigma, 0.0))

    def off(self, predicted: Array) -> Array:
        """(predicted - recorded)/sigma, 0 for no data."""
        return (predicted - self.values) * self.weight

    def part(self, first: int, last: int) -> Recorded:
        """From sample `first` to sample `last`, which is left to another part."""
        weight = self.weight[first : last + 1].copy()
        weight[last - first :] = 0.0
        return Recorded(self.values[first : last + 1], weight)


@dataclass(frozen=True)
class Sought:
    """A predicted run, and what to differentiate it by.

    wanted  (np, nw) derivatives of p by the wanted quantities
    more    (samples, channels, k) further columns
    """

    path: DrivePath
    made: Path
    p: Array
    wanted: Array
    drive_by: DriveSlopes | None
    recorded: Recorded
    more: Array | None = None

    @property
    def coarse(self) -> Sought:
        """The same in the steps of derivatives."""
        count, by = self.path.fine, self.drive_by
        if count == 1:
            return self
        by = by and by.coarser(count)
        return replace(self, path=self.path.coarse, made=self.made.coarser(count), drive_by=by)

    def pieces(self, count: int) -> list[Sought]:
        """Cut into up to `count` pieces; a sample between two of them is the later one's."""
        samples = self.path.at.shape[1] - 1
        count = min(count, samples // _SHORTEST)
        if count < 2:
            return [self]
        edges = [samples * k // count for k in range(count + 1)]
        return [self._piece(a, b, samples) for a, b in itertools.pairwise(edges)]

    def _piece(self, first: int, last: int, samples: int) -> Sought:
        each, until = self.path.each, last + (last == samples)
        return replace(
            self,
            path=self.path.part(first, last),
            made=self.made.part(first, last, each),
            drive_by=self.drive_by and self.drive_by.part(first, last, each),
            recorded=self.recorded.part(first, until),
            more=None if self.more is None else self.more[first : last + 1],
        )
