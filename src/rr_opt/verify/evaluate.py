"""Speeds of a grid's points, which limits each satisfies, and finer grids around the best."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Problem
from rr_opt.verify.climb import turn_rows
from rr_opt.verify.compiled_cycles import Speeds
from rr_opt.verify.fourier import peak
from rr_opt.verify.grid import Grid, points
from rr_opt.verify.speeds import costs, least_S1, motions, speeds

Mask = NDArray[np.bool_]
Progress = Callable[[int, int], None]
"""Called with the points done and the points in all."""

LIMITS = ("rate", "angle", "singularity", "torque", "grip", "economy", "direction")

_SLACK = 1e-8
"""Relative violation of a limit that counts as rounding."""

_AIMS = (1e-3, 1e-4, 1e-6, 1e-7)
"""Relative distance below the torque limit that each secant step aims for."""

_WORTH = 0.8
"""Points slower than this fraction of the best are not moved to the torque limit."""

_PHASES = 64
"""Phases of the motions from which the cost of transport is computed."""

_ROWS = 4096
"""Rows of points between two reports of progress."""


@dataclass(frozen=True)
class Found:
    """A gait found by the sweep: offset >= 0 where phi0 and -phi0 are equivalent.

    ratio J20/J10 or None, speed signed, m/s; peak torque N m; turn rad per period; merit: the
    objective
    """

    gait: SineGait
    ratio: float | None
    speed: float
    peak_torque: float
    turn: float
    merit: float

    @property
    def radius(self) -> float:
        """Radius of its circle, m."""
        return self.gait.period * abs(self.speed / self.turn) if self.turn else math.inf


@dataclass(frozen=True)
class Evaluated:
    """K points; every array (K,).

    decisions    amplitude, period, offset, ratio (NaN: the robot as it is), (4, K)
    speed        signed, m/s; NaN where the limit on angle or singularity is violated
    peak_torque  N m; NaN there too
    turn         heading gained per period, rad; NaN there too
    value        the objective: |speed|, or the inverse of the cost of transport; NaN there too
    keeps        by limit's name: the point satisfies it; torque and direction are False where
                 the speed is NaN
    failed       how many points within angle and singularity have no resolved cycle
    """

    decisions: Array
    speed: Array
    peak_torque: Array
    turn: Array
    value: Array
    keeps: Mapping[str, Mask]
    failed: int

    @property
    def feasible(self) -> Mask:
        """All limits are satisfied."""
        return np.logical_and.reduce([self.keeps[name] for name in (*LIMITS, "turn")])

    @property
    def merit(self) -> Array:
        """The value where all limits are satisfied, else -inf."""
        return np.where(self.feasible, self.value, -np.inf)

    def found(self, index: int) -> Found:
        """One of the points."""
        amplitude, period, offset, ratio = self.decisions[:, index].tolist()
        return Found(
            SineGait(amplitude, period, offset),
            None if math.isnan(ratio) else ratio,
            float(self.speed[index]),
            float(self.peak_torque[index]),
            float(self.turn[index]),
            float(self.value[index]),
        )


def evaluate(
    problem: Problem, grid: Grid, tolerance: float, progress: Progress | None = None
) -> Evaluated:
    """Evaluate a grid's points; tolerance: of the speeds, relative."""
    arrays = points(problem, grid)
    shape = arrays[0].shape
    rows = [part.reshape(-1, shape[-1]) for part in arrays]
    speed, torque, turn = (np.full(rows[0].shape, np.nan) for _ in range(3))
    geometry = within(problem, rows[0], rows[2])
    wanted = np.flatnonzero((geometry["angle"] & geometry["singularity"])[:, 0])
    failed = 0
    for done in range(0, len(wanted), _ROWS):
        block = wanted[done : done + _ROWS]
        amplitude, period, offset, ratio = (part[block] for part in rows)
        found = speeds(problem, amplitude[:, :1], period, offset[:, :1], ratio[:, :1], tolerance)
        speed[block], torque[block], turn[block] = found.speed, found.peak_torque, found.turn
        failed += int((~found.converged & np.isfinite(period)).sum())
        if progress:
            progress(min(done + _ROWS, len(wanted)) * shape[-1], len(wanted) * shape[-1])
    seen = np.array([*arrays, *(part.reshape(shape) for part in (speed, torque, turn))])
    flat = seen[:, np.isfinite(arrays[1])]
    plain = evaluated(problem, flat, failed)
    reached = plain.merit.max(initial=0.0) if problem.objective == "speed" else 0.0
    line = _torque_line(problem, grid, seen, reached, tolerance)
    return evaluated(problem, np.concatenate([flat, line], axis=1), failed)


def evaluated(problem: Problem, points: Array, failed: int = 0) -> Evaluated:
    """points (7, K): decisions, speed, peak torque, turn."""
    decisions, (speed, torque, turn) = points[:4], points[4:]
    found = Speeds(speed, turn, torque, np.isfinite(speed))
    value, kept = np.abs(speed), _keeps(problem, decisions, found)
    if problem.economy:
        known = np.flatnonzero(np.isfinite(speed))
        cost = costs(problem, decisions[:, known], motions(problem, decisions[:, known], _PHASES))
        used = {**cost._asdict(), "speed": 2 * problem.limits.speed - value[known]}
        for name, limit in problem.limits.economy.items():
            kept["economy"][known] &= used[name] <= limit * (1 + _SLACK)
        if problem.objective != "speed":
            value = np.full(len(speed), np.nan)
            value[known] = 1 / cost.cost_of_transport
    return Evaluated(decisions, speed, torque, turn, value, kept, failed)


def within(problem: Problem, amplitude: Array, offset: Array) -> dict[str, Mask]:
    """Which gaits satisfy the limits on angle and singularity."""
    limits, far = problem.limits, np.abs(amplitude) + np.abs(offset)
    S1 = least_S1(problem.robot, amplitude, offset)
    return {
        "angle": far <= limits.angle * (1 + _SLACK),
        "singularity": limits.singularity * (1 - _SLACK) <= S1,
    }


def _keeps(problem: Problem, decisions: Array, found: Speeds) -> dict[str, Mask]:
    (amplitude, period, offset), limits, speed = decisions[:3], problem.limits, found.speed
    ahead = {"forward": speed > 0, "backward": speed < 0, "either": np.isfinite(speed)}
    kept = {
        "rate": np.abs(amplitude) * 2 * math.pi <= limits.rate * period * (1 + _SLACK),
        **within(problem, amplitude, offset),
        "torque": found.peak_torque <= limits.torque * (1 + _SLACK),
        "direction": ahead[problem.direction],
    }
    less, equal = turn_rows(problem, np.abs(found.speed), found.turn, decisions[1])
    kept["turn"] = np.isfinite(found.speed)
    for row in less:
        kept["turn"] &= row >= -_SLACK
    for row in equal:
        kept["turn"] &= np.abs(row) <= _SLACK
    kept["economy"] = np.isfinite(found.speed)
    kept["grip"] = np.ones(len(found.speed), bool)
    if math.isfinite(limits.grip):
        # Only points that satisfy all other limits are evaluated.
        asked = np.flatnonzero(np.logical_and.reduce(list(kept.values())))
        for grip in motions(problem, decisions[:, asked], grip=True).grips:
            kept["grip"][asked] &= peak(grip, False) <= limits.grip * (1 + _SLACK)
    return kept


def _torque_line(
    problem: Problem, grid: Grid, seen: Array, reached: float, tolerance: float
) -> Array:
    """Points (7, K) on the torque limit: decisions, speed, peak torque, turn.

    seen (7, A, F, R, B): the same of the grid's points; reached: the best merit among them. Each
    point lies between neighbours along the period (or, if that is fixed, the first free decision),
    one within the limit and one not much slower than the best; found by secants in the logarithm of
    the torque.
    """
    limit = problem.limits.torque
    axes = {"amplitude": 0, "offset": 1, "period": 3}
    order = [name for name in ("period", "amplitude", "offset") if name in grid.free]
    if not order or not np.isfinite(limit):
        return np.empty((7, 0))
    along = axes[order[0]]
    seen = np.moveaxis(seen, along + 1, -1)
    one, other = seen[..., :-1], seen[..., 1:]
    known = np.isfinite(one[5]) & np.isfinite(other[5])
    keeps, kept = (end[5] <= limit * (1 + _SLACK) for end in (one, other))
    worth = np.maximum(np.abs(one[4]), np.abs(other[4])) >= _WORTH * reached
    crossed = known & worth & (keeps != kept)
    one, other, keeps = one[:, crossed], other[:, crossed], keeps[crossed]
    inside, outside = np.where(keeps, one, other), np.where(keeps, other, one)
    low, high = np.maximum(inside[5], 1e-12 * limit), outside[5]
    inside, outside = inside[:4], outside[:4]
    best = np.array([*inside, *np.full((3, len(low)), np.nan)])
    for aim in _AIMS if len(low) else ():
        apart = np.maximum(np.log(high / low), 1e-12)
        rise = np.log(limit * (1 - aim) / low) / apart
        middle = inside + np.clip(rise, 0.0, 1.0) * (outside - inside)
        found = speeds(problem, *middle, tolerance)
        good = found.peak_torque <= limit
        worse = found.peak_torque > limit
        best[:, good] = np.array([*middle, found.speed, found.peak_torque, found.turn])[:, good]
        inside, low = np.where(good, middle, inside), np.where(good, found.peak_torque, low)
        outside, high = np.where(worse, middle, outside), np.where(worse, found.peak_torque, high)
    return best[:, np.isfinite(best[4])]
