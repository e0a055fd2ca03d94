"""The order of unknowns and rows in the program: names in, names out.

Unknowns are the decisions, the means over the period, and then, node by node for each name, the
local ones. Rows are the continuity of each state, the means, the rows of the period and, node by
node for each name, those along the path.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rr_opt.design.shapes import Shape
from rr_opt.problem import Interval

Array = NDArray[np.float64]

COMMON = ("period", "ballast", "turn")
"""T (s), I2 (kg m2) or number of loads on a scale from 0 at its lower bound to 1 at its upper,
heading per period (rad)."""
MEANS = ("Vx", "Vy", "Ex", "Ey")
"""Mean velocity (m/s) and mean heading vector, in the frame that turns with the gait."""
DYNAMIC = ("v", "chi")
"""Speed of axle 1 (m/s), heading seen from that frame (rad)."""
TURN = ("curvature", "yaw_rate", "heading")
ROWS = ("direction", *TURN)
"""Rows that hold once a period whatever the shape."""

FREE = Interval(-np.inf, np.inf)
ZERO = Interval(0.0, 0.0)


@dataclass(frozen=True)
class Layout:
    """Unknowns and rows of the program of a shape with `intervals` intervals, in each of which
    the torque is held at `looks` places beside the node."""

    shape: Shape
    intervals: int
    looks: int

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
        """Local unknowns that an interval carries on."""
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
        return self.shape.path + self.torque

    @property
    def torque(self) -> tuple[str, ...]:
        """The torque at the node, at the looks and, where it jumps at nodes, at the end."""
        looks = tuple(f"torque{k}" for k in range(self.looks))
        return ("torque", *looks, "torque_end") if self.shape.controls else ("torque", *looks)

    def first(self, name: str) -> int:
        """Where among the unknowns the first of a local one is."""
        once = len(self.decisions) + len(self.means)
        return once + self.local.index(name) * self.intervals

    def unknowns(self, x: Array) -> dict[str, Any]:
        """Numbers by name, (N,) of a local one."""
        return self._named(x, self.decisions + self.means, self.local)

    def rows(self, g: Array) -> dict[str, Any]:
        """Rows by name but for those that tie nodes and means together."""
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
        """Lower and upper bounds of the unknowns; what has no name is free."""
        return self._bounds(unknowns, self.decisions + self.means, self.local, 0)

    def row_bounds(self, rows: Mapping[str, Interval]) -> tuple[Array, Array]:
        """Lower and upper bounds of all rows; what ties nodes and means together is 0."""
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
        intervals = [given.get(name, FREE) for name in once]
        for name in along:
            intervals += [given.get(name, FREE)] * self.intervals
        intervals = [ZERO] * tied + intervals
        return (
            np.array([interval.low for interval in intervals]),
            np.array([interval.high for interval in intervals]),
        )
