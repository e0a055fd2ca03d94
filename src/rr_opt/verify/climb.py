"""The local optimum next to a gait, by SLSQP on the sweep's own model.

Every limit is a smooth row. The torque counts by its peak in each part of the cycle, as the largest
of several peaks has a kink where they change places, and by its logarithm, as it grows a
hundredfold near the singular posture. Slopes are central differences, all of them in one call.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np

from rr_opt.array import Array
from rr_opt.model.problem import Problem
from rr_opt.verify.fourier import peaks
from rr_opt.verify.grid import DECISIONS, boxes, loads_are_whole, reach
from rr_opt.verify.speeds import PHASES, costs, model_of, motions

_STEP = {True: 1e-5, False: 1e-3}
"""Step of a difference, relative to each decision's range; by whether friction is viscous."""
_PARTS = 8
"""Parts of the cycle, each with its own peak."""
_LEAST = 1e-3
"""Utilisation of a limit below which a peak does not count."""
KEPT = 1e-8
"""Largest relative violation of a row."""


class _Care(NamedTuple):
    """phases of a cycle; tolerance and iterations of a climb, and its number of restarts, as the
    limiting peaks can change along it."""

    phases: int
    tolerance: float
    iterations: int
    repeats: int


_ROUGH, _FINE = _Care(PHASES // 2, 1e-6, 30, 1), _Care(2 * PHASES, 1e-10, 100, 4)
_RESOLVED = {True: 0.0, False: 1e-8}
"""Least tolerance, by whether friction is viscous: kinks keep a climb that asks for more from
ending."""
_SETTLED, _STEPS, _LONGEST = 1e-9, 5, 0.01
_AHEAD = 1e-6
"""Least V . E/|V|: at 0 a gait would go neither forward nor backward."""
_SLOWEST = 1e-12


@dataclass(frozen=True)
class Climbed:
    """The result of a climb.

    decisions: amplitude, period, offset, ratio (NaN: the robot as it is), (4,); points: gaits
    evaluated; kept: the end satisfies every limit and the turn; value: the objective, less a
    penalty for violated rows."""

    decisions: Array
    points: int
    kept: bool
    value: float


Aim = Literal["speed", "radius"]


def climb(problem: Problem, start: Array, aim: Aim = "speed", *, rough: bool = False) -> Climbed:
    """Climb to the best gait, or the tightest circle, from a start (4,) that may be infeasible."""
    from scipy.optimize import minimize  # 0.1 s that a sweep alone does not need

    care = _ROUGH if rough else _FINE
    local = _Local(problem, np.asarray(start, float), aim, care.phases)
    tolerance = max(care.tolerance, _RESOLVED[local.viscous])
    options = {"ftol": tolerance, "maxiter": care.iterations}
    z = local.first
    for _ in range(care.repeats if len(z) else 0):
        end = minimize(
            local.cost, z, jac=local.cost_slope, bounds=[(0.0, 1.0)] * len(z),
            constraints=local.constraints, method="SLSQP", options=options,
        )  # fmt: skip
        there = np.clip(end.x, 0.0, 1.0)
        if not local.settles(there):
            break
        there = local.inside(there)
        moved = float(np.abs(there - z).max())
        z = there
        if moved <= _SETTLED:
            break
    return Climbed(local.decisions(z[None])[:, 0], local.points, local.keeps(z), local.value(z))


def peak_torque(problem: Problem, decisions: Array) -> float:
    """The largest |torque| of a gait (4,), N m."""
    return float(peaks(motions(problem, decisions[:, None], _FINE.phases).torque, 1)[0, 0])


def cost_of_transport(problem: Problem, decisions: Array) -> float:
    """Of a gait (4,)."""
    gaits = decisions[:, None]
    found = motions(problem, gaits, _FINE.phases)
    return float(costs(problem, gaits, found).cost_of_transport[0])


class _Local:
    """Objective and rows over the free decisions, scaled to their ranges, and their slopes."""

    def __init__(self, problem: Problem, start: Array, aim: Aim, phases: int) -> None:
        inside = boxes(problem)
        self._problem, self._start, self._aim, self.points = problem, start, aim, 0
        whole = loads_are_whole(problem)
        self._free = np.array(
            [k for k, name in enumerate(DECISIONS)
             if inside[name].low < inside[name].high and not (whole and name == "ratio")], int,
        )  # fmt: skip
        ends = np.array([(inside[name].low, inside[name].high) for name in DECISIONS])
        self._low, self._span = ends[:, 0], ends[:, 1] - ends[:, 0]
        self.viscous = model_of(problem.robot).viscous
        self._step = _STEP[self.viscous]
        self.first = np.clip((start - self._low)[self._free] / self._span[self._free], 0.0, 1.0)
        self._unit, self._phases = 1.0, phases
        self._known: dict[bytes, tuple[Array, Array]] = {}
        self._equal = 0
        values = self._values(self.first[None])
        self._unit = max(float(np.abs(values[0, 0])), _SLOWEST)
        self._rows = len(values) - 1

    def decisions(self, z: Array) -> Array:
        """(4, K) of scaled points (K, n)."""
        found = np.repeat(self._start[:, None], len(z), axis=1)
        found[self._free] = self._low[self._free, None] + self._span[self._free, None] * z.T
        return found

    def inside(self, z: Array) -> Array:
        """The nearest feasible point: SLSQP often ends slightly infeasible."""
        for _ in range(_STEPS):
            values, slopes = self.look(z)
            fails = np.concatenate([values[1:], -values[1 + self._rows - self._equal :]])
            rows = np.concatenate([slopes[1:], -slopes[1 + self._rows - self._equal :]])
            off = fails < 0.1 * KEPT
            if not (fails < -0.1 * KEPT).any():
                break
            change = np.linalg.lstsq(rows[off], 0.2 * KEPT - fails[off], rcond=1e-9)[0]
            moved = np.clip(z + np.clip(change, -_LONGEST, _LONGEST), 0.0, 1.0)
            if not self.settles(moved):
                break
            z = moved
        return z

    def settles(self, z: Array) -> bool:
        """Whether the gait and its neighbours have steady cycles."""
        return all(np.isfinite(part).all() for part in self.look(z))

    def keeps(self, z: Array) -> bool:
        """Whether all rows hold."""
        rows = self.look(z)[0][1:]
        less, equal = np.split(rows, [self._rows - self._equal])
        return bool((less >= -KEPT).all() and (np.abs(equal) <= KEPT).all())

    def value(self, z: Array) -> float:
        """The objective, less its size times the violations."""
        value, rows = self.look(z)[0][0], self.look(z)[0][1:]
        less, equal = np.split(rows, [self._rows - self._equal])
        off = np.maximum(-less, 0.0).sum() + np.abs(equal).sum()
        return float(value - abs(value) * off)

    def look(self, z: Array) -> tuple[Array, Array]:
        """Values and slopes of the objective, of rows >= 0 and, last, of rows = 0."""
        key = z.tobytes()
        if key not in self._known:
            n, h = len(z), self._step
            ahead, behind = np.minimum(z + h, 1.0), np.maximum(z - h, 0.0)
            around = np.tile(z, (2 * n + 1, 1))
            np.fill_diagonal(around[1 : n + 1], ahead)
            np.fill_diagonal(around[n + 1 :], behind)
            values = self._values(around)
            with np.errstate(invalid="ignore"):
                slopes = (values[:, 1 : n + 1] - values[:, n + 1 :]) / (ahead - behind)
            self._known = {key: (values[:, 0], slopes)}
        return self._known[key]

    def cost(self, z: Array) -> float:
        """The objective, negated and scaled by its size at the start."""
        return -float(self.look(z)[0][0]) / self._unit

    def cost_slope(self, z: Array) -> Array:
        """Its slope."""
        return -self.look(z)[1][0] / self._unit

    @property
    def constraints(self) -> list[dict[str, Any]]:
        """In the form that SLSQP expects."""
        first = 1 + self._rows - self._equal
        kinds = {"ineq": slice(1, first), "eq": slice(first, None)}
        counts = {"ineq": first - 1, "eq": self._equal}
        return [
            {"type": kind, "fun": self._part(0, rows), "jac": self._part(1, rows)}
            for kind, rows in kinds.items()
            if counts[kind]
        ]

    def _part(self, which: int, rows: slice) -> Callable[[Array], Array]:
        return lambda z: self.look(z)[which][rows]

    # A gait without a steady cycle has non-finite values.
    @np.errstate(divide="ignore", over="ignore", invalid="ignore")
    def _values(self, z: Array) -> Array:
        gaits, problem = self.decisions(z), self._problem
        amplitude, period, offset, _ = gaits
        self.points += len(z)
        limits = problem.limits
        found = motions(problem, gaits, self._phases, grip=math.isfinite(limits.grip))
        speed = np.hypot(*found.velocity)
        far = reach(problem)
        rows = [far - amplitude - offset, far - amplitude + offset]
        if math.isfinite(limits.rate):
            rows.append(1 - amplitude * 2 * math.pi / (period * limits.rate))
        if problem.command and problem.bounds_command:
            low, high = problem.command.joint_amplitude(period)
            rows += [amplitude - low, high - amplitude]
        loads = [(found.torque, limits.torque), *((grip, limits.grip) for grip in found.grips)]
        for load, limit in loads:
            if math.isfinite(limit):
                rows += list(-np.log(np.maximum(peaks(load, _PARTS) / limit, _LEAST)))
        value = speed
        if problem.economy:
            cost = costs(problem, gaits, found)
            if problem.objective != "speed":
                value = 1 / cost.cost_of_transport
            used = {**cost._asdict(), "speed": limits.speed**2 / np.maximum(speed, _SLOWEST)}
            for name, limit in limits.economy.items():
                rows.append(-np.log(np.maximum(used[name] / limit, _LEAST)))
        if problem.direction != "either":
            ahead = (found.velocity * found.heading).sum(axis=0) / np.maximum(speed, _SLOWEST)
            rows.append((ahead if problem.direction == "forward" else -ahead) - _AHEAD)
        less, equal = turn_rows(problem, speed, found.turn, period)
        self._equal = len(equal)
        # The square of a radius has no kink at 0.
        if self._aim == "radius":
            value = -((speed * period / found.turn) ** 2)
        return np.array([value, *rows, *less, *equal])


def turn_rows(
    problem: Problem, speed: Array, turn: Array, period: Array
) -> tuple[list[Array], list[Array]]:
    """The requested turn, relative: rows that must be >= 0, and rows that must be 0. speed >= 0,
    m/s; turn in rad per period."""
    less: list[Array] = []
    equal: list[Array] = []
    if problem.turn is None:
        return less, equal
    rate = turn / period
    for box, value, per in (
        (problem.turn.curvature, rate, speed),
        (problem.turn.yaw_rate, rate, np.ones_like(rate)),
        (problem.turn.heading, turn, np.ones_like(rate)),
    ):
        for sign, end in ((1.0, box.low), (-1.0, box.high)):
            if not math.isfinite(end):
                continue
            size = np.maximum(abs(end) * per, _SLOWEST) if end else 1.0
            row = sign * (value - end * per) / size
            if not box.fixed:
                less.append(row)
            elif sign > 0:
                equal.append(row)
    return less, equal
