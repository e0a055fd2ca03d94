"""The multiple-shooting program: its mesh, its unknowns and rows, addressed by name.

A limit enforced at the nodes can be violated between them, and with many coefficients the solver
moves the peaks there. So phases at which a solution violates a limit are added to those at which
it is enforced, and the program is re-solved until there is no violation.

Unknowns are the decisions, the means over the period, and then, node by node for each name, the
local ones. Rows are the continuity of each state, the means, the rows of the period and, node by
node for each name, those along the path.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rr_opt.array import Array
from rr_opt.design.shapes import Shape
from rr_opt.model.problem import Interval

LADDER = (16, 20, 24, 30, 36, 48, 72, 96, 144, 192, 288, 384, 768)
"""Numbers of intervals to choose from, so that few programs need building."""

GRIPS = ("grip1", "grip2")
"""Side force of each axle over the load on it."""

LOOKS = np.array([2, 1, 3]) / 4
"""Places in an interval at which the torque is limited; the first always."""
_REGULAR = 1
_ORDER = 6


@dataclass(frozen=True)
class Mesh:
    """Where a program evaluates the gait.

    phases    nodes, (N,), increasing over less than 1 from about 0
    substeps  integrator steps in each interval
    looks     (N, M) fractions of the intervals, beside the nodes, at which the torque is limited:
              LOOKS of them, or none
    turns     (N,) fractions of the intervals at which the angle of a free gait is limited
    checks    (K,) phases at which angle and rate of others are, besides the shape's regular grid
    margin    kept from the torque limit everywhere, relative
    """

    phases: Array
    substeps: int
    looks: Array
    turns: Array
    checks: Array
    margin: float = 0.0

    @property
    def intervals(self) -> int:
        """N."""
        return len(self.phases)

    def with_torque_at(self, peaks: Array) -> Mesh:
        """With the torque limited at these phases of [0, 1) too.

        In each interval, the look farthest from the peak is replaced, except for the regular ones:
        nearby looks keep the peak from moving aside.
        """
        if not len(peaks):
            return self
        looks = self.looks.copy()
        if not looks.shape[1]:
            looks = np.tile(LOOKS, (self.intervals, 1))
        for k, fraction in self._placed(peaks):
            looks[k, _REGULAR + np.abs(looks[k, _REGULAR:] - fraction).argmax()] = fraction
        return replace(self, looks=looks)

    def with_checks_at(self, phases: Array) -> Mesh:
        """With angle and rate limited at these phases too."""
        turns = self.turns.copy()
        for k, fraction in self._placed(phases):
            turns[k] = fraction
        return replace(self, turns=turns, checks=np.append(self.checks, phases))

    def _placed(self, phases: Array) -> Iterator[tuple[int, float]]:
        """The interval of each phase, and its fraction of it."""
        ends = np.append(self.phases, self.phases[0] + 1)
        for phase in ends[0] + (phases - ends[0]) % 1:
            k = int(np.searchsorted(ends, phase, side="right")) - 1
            yield k, (phase - ends[k]) / (ends[k + 1] - ends[k])


def regular(intervals: int) -> Mesh:
    """Equal intervals, the torque limited at nodes only."""
    phases = np.arange(intervals) / intervals
    return Mesh(phases, 1, np.zeros((intervals, 0)), np.full(intervals, 0.5), np.zeros(0))


def intervals_for(intervals: int, error: float, wanted: float) -> int:
    """The intervals needed for the wanted error, given the error with this many."""
    needed = intervals * (error / wanted) ** (1 / _ORDER)
    return at_least(needed)


def at_least(intervals: float) -> int:
    """The next number of the ladder."""
    return next((n for n in LADDER if n >= intervals), LADDER[-1])


COMMON = ("period", "ballast", "turn")
"""T (s), I2 (kg m2) or number of loads on a scale from 0 at its lower bound to 1 at its upper,
heading per period (rad)."""
MEANS = ("Vx", "Vy", "Ex", "Ey")
"""Mean velocity (m/s) and mean heading vector, in the frame that turns with the gait."""
DYNAMIC = ("v", "chi")
"""Speed of axle 1 (m/s), heading seen from that frame (rad)."""
TURN = ("curvature", "yaw_rate", "heading")
ROWS = ("direction", *TURN)
"""Rows that hold once per period for any shape."""

FREE = Interval(-np.inf, np.inf)
ZERO = Interval(0.0, 0.0)


@dataclass(frozen=True)
class ProgramLayout:
    """Unknowns and rows of the program of a shape with `intervals` intervals, each with the named
    loads limited at `looks` points besides the node."""

    shape: Shape
    intervals: int
    looks: int
    loads: tuple[str, ...] = ("torque",)

    @property
    def decisions(self) -> tuple[str, ...]:
        """Unknowns of the whole period."""
        return COMMON + self.shape.decisions

    @property
    def means(self) -> tuple[str, ...]:
        """Means over the period."""
        return MEANS + self.shape.integrals

    @property
    def states(self) -> tuple[str, ...]:
        """Local unknowns that an interval propagates."""
        return DYNAMIC + self.shape.states

    @property
    def local(self) -> tuple[str, ...]:
        """Unknowns of every node."""
        return self.states + self.shape.controls

    @property
    def limits(self) -> tuple[str, ...]:
        """Rows that hold once a period."""
        return self.shape.limits + ROWS

    @property
    def path(self) -> tuple[str, ...]:
        """Rows of every node."""
        return self.shape.path + tuple(row for load in self.loads for row in self.along(load))

    def along(self, load: str) -> tuple[str, ...]:
        """A load at the node, at the looks and, where it jumps at nodes, at the end."""
        looks = tuple(f"{load}@{k}" for k in range(self.looks))
        return (load, *looks, f"{load}@end") if self.shape.controls else (load, *looks)

    def first(self, name: str) -> int:
        """Index of the first of a local unknown."""
        once = len(self.decisions) + len(self.means)
        return once + self.local.index(name) * self.intervals

    def unknowns(self, x: Array) -> dict[str, Any]:
        """Numbers by name, (N,) of a local one."""
        return self._named(x, self.decisions + self.means, self.local)

    def rows(self, g: Array) -> dict[str, Any]:
        """Rows by name, except those that link nodes and means."""
        tied = self.intervals * len(self.states) + len(self.means)
        return self._named(g[tied:], self.limits, self.path)

    def stacked(self, values: Mapping[str, Any]) -> Array:
        """The vector of unknowns."""
        return np.concatenate(
            [
                [values[name] for name in self.decisions + self.means],
                *(values[name] for name in self.local),
            ]
        )

    def bounds(self, unknowns: Mapping[str, Interval]) -> tuple[Array, Array]:
        """Lower and upper bounds of the unknowns; those not named are free."""
        return self._bounds(unknowns, self.decisions + self.means, self.local, 0)

    def row_bounds(self, rows: Mapping[str, Interval]) -> tuple[Array, Array]:
        """Lower and upper bounds of all rows; those that link nodes and means are 0."""
        tied = self.intervals * len(self.states) + len(self.means)
        return self._bounds(rows, self.limits, self.path, tied)

    def _named(self, values: Array, once: tuple[str, ...], along: tuple[str, ...]) -> dict:
        parts = values[len(once) :].reshape(len(along), self.intervals)
        return dict(zip(once, values, strict=False)) | dict(zip(along, parts, strict=True))

    def _bounds(
        self,
        given: Mapping[str, Interval],
        once: tuple[str, ...],
        along: tuple[str, ...],
        tied: int,
    ) -> tuple[Array, Array]:
        names = *once, *(name for name in along for _ in range(self.intervals))
        intervals = [ZERO] * tied + [given.get(name, FREE) for name in names]
        low, high = np.array([(one.low, one.high) for one in intervals]).T
        return low, high
