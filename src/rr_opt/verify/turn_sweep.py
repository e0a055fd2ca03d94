"""The sweep of a turn: gaits all over the bounds, each brought to turn as asked.

As `check_optimum` for a turn, with which it shares no more than the array model: a grid of all
decisions, the best of it followed by smaller grids, and more of them around the claimed gait.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from math import isclose
from typing import NamedTuple

import numpy as np

from rr_opt.array import Array
from rr_opt.model.gait import Gait, SineGait
from rr_opt.model.problem import Interval, Problem
from rr_opt.verify.evaluate import Found, kept_limits
from rr_opt.verify.grid import boxes, whole_loads
from rr_opt.verify.speeds import model_of, robot_with, speed_of, speeds
from rr_opt.verify.sweep import SweepCheck, compared
from rr_opt.verify.turn_points import Care, Turning, TurnPoints

_SLACK = 1e-6


class _Effort(NamedTuple):
    """values of period, offset, share of the amplitude and ratio; care for all of them, and for
    the smaller grids; rounds of those."""

    counts: tuple[int, int, int, int]
    wide: Care
    close: Care
    rounds: int


# Other friction than viscous takes some hundred times as long.
_WIDE = Care(tolerance=1e-3, newton=6, step=1e-3, kept=2e-2)
_CLOSE = Care(tolerance=1e-6, newton=3, step=1e-4, kept=1e-6)
_EFFORT = {
    True: _Effort((10, 9, 6, 4), _WIDE, _CLOSE, 10),
    False: _Effort((4, 5, 3, 2), _WIDE, Care(1e-4, 2, 1e-3, 1e-3), 4),
}


def check_turn(problem: Problem, gait: Gait, ratio: float | None, speed: float) -> SweepCheck:
    """Compare a claimed fastest turn with a sweep, as `check_optimum` does without a turn.

    A gait of another shape is compared with all sines. Of whole loads every number is swept.
    """
    choice = problem.inertia_ratio
    if choice is None:
        return _check(problem, gait, None, speed, None)
    if not (choice.by == "loads" and choice.loads.whole):
        return _check(problem, gait, ratio, speed, boxes(problem)["ratio"])
    checks = [
        _check(problem, gait, ratio, speed, Interval(loaded, loaded))
        for loaded in whole_loads(problem).tolist()
    ]
    best = min(checks, key=lambda check: check.gap)
    return replace(best, points=sum(check.points for check in checks))


def _check(
    problem: Problem, gait: Gait, ratio: float | None, speed: float, ratios: Interval | None
) -> SweepCheck:
    """Over these ratios; the claimed gait is followed if its own is one of them."""
    effort = _EFFORT[model_of(problem.robot).viscous]
    wide, turning = (Turning(problem, ratios, care) for care in (effort.wide, effort.close))
    box = problem.gait
    decisions = (box.period, box.offset, box.amplitude, ratios)
    counts = [
        1 if one is None or one.fixed else count
        for one, count in zip(decisions, effort.counts, strict=True)
    ]
    axes = [np.linspace(0.0, 1.0, count) for count in counts]
    everywhere = np.array(list(itertools.product(*axes))).T
    far, points = _best(problem, wide, everywhere)
    width = np.array([1 / (count - 1) if count > 1 else 0.0 for count in counts])
    own = None
    if isinstance(gait, SineGait):
        sine = (gait.amplitude, gait.period, gait.offset)
        claimed = float(speeds(problem, *sine, ratio, effort.close.tolerance).speed)
        if ratio is None or ratios is None or not ratios.fixed or isclose(ratio, ratios.low):
            own = turning.place(np.array([*sine, ratio or 0.0]))
    else:
        claimed = speed_of(robot_with(problem, ratio), gait).speed
    best = None
    for start, first, rounds in ((far, width / 2, effort.rounds), (own, width / 50, 4)):
        if start is None:
            continue
        found, more = _closer(problem, turning, start, first, rounds)
        points += more
        best = found if _speed(problem, turning, found) > _speed(problem, turning, best) else best
    top = _found(turning, best, ratios is not None)
    return compared(speed, claimed, top, points)


def _closer(
    problem: Problem, turning: Turning, start: Array, width: Array, rounds: int
) -> tuple[Array | None, int]:
    """The best place that smaller and smaller grids around the best so far lead to."""
    best, points = start, 0
    steps = np.array(list(itertools.product((-1.0, 0.0, 1.0), repeat=4))).T
    steps = np.unique(steps * (width > 0)[:, None], axis=1)
    for _ in range(rounds):
        around = np.clip(best + steps * width[:, None], 0.0, 1.0)
        found, more = _best(problem, turning, around)
        points += more
        gained = found is not None and _speed(problem, turning, found) > _speed(
            problem, turning, best
        )
        if found is not None and gained:
            best = found
        else:
            width = width / 2
    return best, points


def _best(problem: Problem, turning: Turning, unit: Array) -> tuple[Array | None, int]:
    """The fastest place (4, 1) next to these that turns as asked within the limits, and how many
    were looked at."""
    sets = turning.active_sets
    tried = np.concatenate([turning.held(unit, active) for active in sets], axis=1)
    points = turning.at(tried)
    merit = _merit(problem, points)
    top = int(merit.argmax())
    place = None if merit[top] == -np.inf else points.unit[:, [top]]
    return place, tried.shape[1]


def _speed(problem: Problem, turning: Turning, place: Array | None) -> float:
    return -math.inf if place is None else float(_merit(problem, turning.at(place))[0])


def _merit(problem: Problem, points: TurnPoints) -> Array:
    """|speed| where everything is kept, else -inf."""
    kept = kept_limits(problem, points.gaits, points.seen, _SLACK)
    every = np.logical_and.reduce([points.turns, *kept.values()])
    return np.where(every, np.abs(points.seen.speed), -np.inf)


def _found(turning: Turning, place: Array | None, has_ratio: bool) -> Found | None:
    if place is None:
        return None
    points = turning.at(place)
    *sizes, ratio = points.gaits[:, 0].tolist()
    speed, torque = float(points.seen.speed[0]), float(points.seen.peak_torque[0])
    return Found(SineGait(*sizes), ratio if has_ratio else None, speed, torque)
