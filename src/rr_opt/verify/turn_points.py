"""Gaits that turn as asked, from gaits all over the bounds: the points of a turn's sweep.

A gait is given by its period, the share of the amplitude that the limits leave it, its offset and
its inertia ratio. Newton's method moves the offset, and the amplitude too where two quantities
of the turn are fixed, until the gait turns as asked.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.model.problem import Interval, Problem
from rr_opt.verify.compiled_cycles import Speeds
from rr_opt.verify.grid import reach
from rr_opt.verify.speeds import speeds

ROWS = ("curvature", "yaw_rate", "heading")
OFFSET, SHARE = 1, 2
_CHORDS = 3
_LONGEST = 0.15
"""A step of Newton's method, in the unit box."""


@dataclass(frozen=True)
class TurnPoints:
    """K gaits: unit (4, K) in periods, offsets, shares of the amplitude, ratios; amplitude, period,
    offset, ratio (4, K); what they do; and whether they turn as asked."""

    unit: Array
    gaits: Array
    seen: Speeds
    turns: NDArray[np.bool_]


class Care(NamedTuple):
    """tolerance of the speeds; steps of Newton's method, and how far for its slopes; by how much,
    relative, a row may be off."""

    tolerance: float
    newton: int
    step: float
    kept: float


class Turning:
    """The gaits of a problem with a turn."""

    def __init__(self, problem: Problem, ratios: Interval | None, care: Care):
        turn = problem.turn
        self._problem, self._ratios, self._care = problem, ratios, care
        self._reach = reach(problem)
        asked = {name: getattr(turn, name) for name in ROWS}
        self._asked = {
            name: box
            for name, box in asked.items()
            if math.isfinite(box.low) or math.isfinite(box.high)
        }

    @property
    def active_sets(self) -> list[dict[str, float]]:
        """The possible active sets: all that is fixed, and one end of what is bounded."""
        fixed = {name: box.low for name, box in self._asked.items() if box.fixed}
        ends = [
            {name: end}
            for name, box in self._asked.items()
            if not box.fixed
            for end in (box.low, box.high)
            if math.isfinite(end) and end != 0
        ]
        return [fixed, *({**fixed, **one} for one in ends if len(fixed) < 2)]

    def at(self, unit: Array) -> TurnPoints:
        """The gaits at these places of the unit box, (4, K)."""
        gaits = self._gaits(unit)
        amplitude, period, offset, ratio = gaits
        known = None if self._ratios is None else ratio
        seen = speeds(self._problem, amplitude, period, offset, known, self._care.tolerance)
        rows = _rows(seen, period)
        turns = np.isfinite(seen.speed)
        for name, box in self._asked.items():
            slack = self._care.kept * max(
                abs(end) for end in (box.low, box.high) if math.isfinite(end)
            )
            turns &= (rows[name] >= box.low - slack) & (rows[name] <= box.high + slack)
        return TurnPoints(unit, gaits, seen, turns)

    def held(self, unit: Array, active: dict[str, float]) -> Array:
        """The places next to these where the named rows have these values, as far as Newton's
        method finds them."""
        moved = [OFFSET, SHARE][: len(active)]
        matrix = np.empty(0)
        for k in range(self._care.newton if active else 0):
            here = self._off(unit, active)
            # Slopes serve for some steps: they cost as much as a step each.
            if k % _CHORDS == 0:
                matrix = self._slopes(unit, here, moved, active)
            unit = unit.copy()
            unit[moved] = np.clip(unit[moved] - _solved(matrix, here.T).T, 0.0, 1.0)
        return unit

    def _slopes(
        self, unit: Array, here: Array, moved: list[int], active: dict[str, float]
    ) -> Array:
        """Slopes of the active rows along the decisions that are moved, (K, rows, moved)."""
        slopes = []
        for which in moved:
            # From the upper face the step goes down.
            step = np.where(unit[which] > 0.5, -self._care.step, self._care.step)
            other = unit.copy()
            other[which] += step
            slopes.append((self._off(other, active) - here) / step)
        return np.moveaxis(np.array(slopes), 2, 0).swapaxes(1, 2)

    def place(self, gait: Array) -> Array:
        """The unit place (4, 1) of amplitude, period, offset, ratio."""
        amplitude, period, offset, ratio = gait
        box = self._problem.gait
        most = self._most(period, offset)
        span = max(float(most) - box.amplitude.low, 1e-300)
        ratios = self._ratios or Interval(0.0, 0.0)
        values = (
            _share(math.log(period), math.log(box.period.low), math.log(box.period.high)),
            _share(offset, box.offset.low, box.offset.high),
            float(np.clip((amplitude - box.amplitude.low) / span, 0.0, 1.0)),
            _share(ratio, ratios.low, ratios.high),
        )
        return np.array(values)[:, None]

    def _gaits(self, unit: Array) -> Array:
        box, ratios = self._problem.gait, self._ratios or Interval(0.0, 0.0)
        period = box.period.low * (box.period.high / box.period.low) ** unit[0]
        # Ends exactly as given: a place may not leave its bounds by rounding.
        period = np.clip(period, box.period.low, box.period.high)
        offset = box.offset.low + unit[1] * (box.offset.high - box.offset.low)
        low, most = box.amplitude.low, self._most(period, offset)
        amplitude = low + unit[2] * np.maximum(most - low, 0.0)
        return np.array(
            [amplitude, period, offset, ratios.low + unit[3] * (ratios.high - ratios.low)]
        )

    def _most(self, period: Array | float, offset: Array | float) -> Array:
        """The largest amplitude that bounds and limits leave, rad."""
        box, limits = self._problem.gait, self._problem.limits
        by_rate = limits.rate * np.asarray(period) / (2 * math.pi)
        return np.minimum(np.minimum(box.amplitude.high, by_rate), self._reach - np.abs(offset))

    def _off(self, unit: Array, active: dict[str, float]) -> Array:
        points = self.at(unit)
        rows = _rows(points.seen, points.gaits[1])
        return np.array([rows[name] / value - 1 for name, value in active.items()])


def _rows(seen: Speeds, period: Array) -> dict[str, Array]:
    with np.errstate(divide="ignore", invalid="ignore"):
        curvature = seen.turn / (period * np.abs(seen.speed))
    return {"curvature": curvature, "yaw_rate": seen.turn / period, "heading": seen.turn}


def _solved(matrix: Array, right: Array) -> Array:
    """Newton's change (K, m), none longer than _LONGEST; none where it cannot be computed."""
    with np.errstate(all="ignore"):
        size = np.abs(np.linalg.det(matrix))
        good = np.isfinite(size) & (size > 1e-12) & np.isfinite(right).all(axis=1)
    change = np.zeros_like(right)
    if good.any():
        change[good] = np.linalg.solve(matrix[good], right[good][..., None])[..., 0]
    return np.clip(change, -_LONGEST, _LONGEST)


def _share(value: float, low: float, high: float) -> float:
    return float(np.clip((value - low) / (high - low), 0.0, 1.0)) if high > low else 0.0
