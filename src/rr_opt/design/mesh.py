"""The mesh of a program: its nodes, and where between them limits are held.

A limit that holds at every node can be broken between two, and where a shape has many
coefficients the solver sees to it that its peaks lie there. So phases at which an answer breaks a
limit are added to those at which it is held, and it is solved again, until its peaks have nowhere
to go. Only a sine's peaks are as good as known: a node moved onto one is enough.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LADDER = (16, 20, 24, 30, 36, 48, 72, 96, 144, 192, 288, 384, 768)
"""Numbers of intervals to choose from, so that few programs are ever built."""

LOOKS = np.array([2, 1, 3]) / 4
"""Places of an interval at which the torque is held; the first one always."""
_REGULAR = 1
_ORDER = 6


@dataclass(frozen=True)
class Mesh:
    """Where a program looks at the gait.

    phases    nodes, (N,), increasing over less than 1 from about 0
    substeps  steps of the integrator in each interval
    looks     (N, M) fractions of the intervals at which the torque is held beside the nodes: LOOKS
              of them, or none
    checks    (K,) phases at which angle and rate are, beside the shape's regular grid
    margin    kept from the torque's limit everywhere, relative
    """

    phases: Array
    substeps: int
    looks: Array
    checks: Array
    margin: float = 0.0

    @property
    def intervals(self) -> int:
        """N."""
        return len(self.phases)

    def with_nodes_at(self, peaks: Array) -> Mesh:
        """With equal intervals but for the nodes that are nearest to these phases of [0, 1), which
        are moved there. The first may come to lie just before 0."""
        phases = np.arange(self.intervals) / self.intervals
        for peak in peaks:
            nearest = round(peak * self.intervals)
            phases[nearest % self.intervals] = peak - nearest // self.intervals
        return replace(self, phases=phases)

    def with_torque_at(self, peaks: Array) -> Mesh:
        """With the torque held at these phases of [0, 1) too.

        In each interval the look that is farthest from the peak gives way, of those that are not
        regular: what is near keeps the peak from moving aside.
        """
        if not len(peaks):
            return self
        looks = self.looks.copy()
        if not looks.shape[1]:
            looks = np.tile(LOOKS, (self.intervals, 1))
        ends = np.append(self.phases, self.phases[0] + 1)
        for peak in ends[0] + (peaks - ends[0]) % 1:
            k = int(np.searchsorted(ends, peak, side="right")) - 1
            fraction = (peak - ends[k]) / (ends[k + 1] - ends[k])
            looks[k, _REGULAR + np.abs(looks[k, _REGULAR:] - fraction).argmax()] = fraction
        return replace(self, looks=looks)

    def with_checks_at(self, phases: Array) -> Mesh:
        """With angle and rate held at these phases too."""
        return replace(self, checks=np.append(self.checks, phases))


def regular(intervals: int) -> Mesh:
    """Equal intervals, the torque held at nodes alone."""
    phases = np.arange(intervals) / intervals
    return Mesh(phases, 1, np.zeros((intervals, 0)), np.zeros(0))


def intervals_for(intervals: int, error: float, wanted: float) -> int:
    """How many intervals make the wanted error, if so many make this one."""
    needed = intervals * (error / wanted) ** (1 / _ORDER)
    return at_least(needed)


def at_least(intervals: float) -> int:
    """The next number of the ladder."""
    return next((n for n in LADDER if n >= intervals), LADDER[-1])
