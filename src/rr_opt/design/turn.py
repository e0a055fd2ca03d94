"""The fastest turn: the gait that goes fastest along a circle or an arc that is asked for.

A whole number of periods is found by branch and bound: solved for any number, and where the
answer is no whole one, again for those below it and for those above it. A part that is slower
than a whole number already found is left.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from rr_opt.design.decisions import decisions
from rr_opt.design.infeasible import nearest_turn, posture_clashes
from rr_opt.design.maximize_speed import Optimum, maximize_speed
from rr_opt.design.turn_target import SURE, Target, posed
from rr_opt.model.problem import Interval, Problem
from rr_opt.motion.servo import for_joint
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import Status

Progress = Callable[[str], None]

_WHOLE = 1e-4
"""A number of periods this near to a whole one is that."""


@dataclass(frozen=True)
class MeanMotion:
    """What a gait does on the way round: signed speed (m/s), curvature (1/m) and yaw rate
    (rad/s), positive to the left; heading (rad), length (m), time (s) and periods of the arc."""

    speed: float
    curvature: float
    yaw_rate: float
    heading: float
    length: float
    time: float
    periods: float


@dataclass(frozen=True)
class Turned:
    """The answer to a turn.

    optimum   as of `maximize_speed`; its problem has the turn and the offset that was open
    opened    the problem fixed the offset, and it was opened
    arc       None if there is no gait; a full circle where no heading was asked for
    """

    target: Target
    optimum: Optimum
    opened: bool
    arc: MeanMotion | None = None


def fastest_turn(problem: Problem, target: Target, progress: Progress = lambda _: None) -> Turned:
    """Solve a turn; the outcomes are those of `maximize_speed`.

    Raises InputError for a robot that has no steady cycle to find.
    """
    asked, opened = posed(for_joint(problem), target)
    optimum = maximize_speed(asked, progress)
    if optimum.status is Status.INFEASIBLE:
        optimum = replace(optimum, message=optimum.message + _sooner(asked, target))
    if target.whole and target.heading and optimum.best:
        optimum = _whole(asked, target.heading, optimum, progress)
    return Turned(target, optimum, opened, arc_of(optimum, target.heading))


def _sooner(problem: Problem, target: Target) -> str:
    """What the nearest turn in reach says of the time or the length that was asked for."""
    box = decisions(problem)
    if target.heading is None or target.radius is not None or posture_clashes(problem, box):
        return ""
    nearest = nearest_turn(problem, box)
    reached = nearest.yaw_rate if target.within is not None else nearest.curvature
    if reached * target.heading <= 0:
        return ""
    needed = target.heading / reached * (1 + SURE)
    unit, what = ("s", "within") if target.within is not None else ("m", "length")
    return f" For this change of heading that is --{what} '{needed:.4g} {unit}' or more."


def arc_of(optimum: Optimum, heading: float | None) -> MeanMotion | None:
    """The arc of this heading (rad), or a full circle, by an optimum's gait."""
    if optimum.best is None or optimum.robot is None:
        return None
    cycle = steady_cycle(optimum.robot, optimum.best.gait).cycle
    yaw_rate = cycle.dpsi / cycle.period
    turned = math.copysign(2 * math.pi, yaw_rate) if heading is None else heading
    time = turned / yaw_rate
    return MeanMotion(
        speed=cycle.speed,
        curvature=yaw_rate / abs(cycle.speed),
        yaw_rate=yaw_rate,
        heading=turned,
        length=abs(cycle.speed) * time,
        time=time,
        periods=time / cycle.period,
    )


def _whole(problem: Problem, heading: float, relaxed: Optimum, progress: Progress) -> Optimum:
    """The fastest of the gaits that turn by heading/n a period, n = 1, 2, ..."""
    best: Optimum | None = None
    failed: Optimum | None = None
    parts: list[tuple[float, float, Optimum | None]] = [(0, math.inf, relaxed)]
    while parts:
        low, high, optimum = parts.pop(0)
        if optimum is None:
            progress(f"periods: {low:g} to {high:g}")
            optimum = maximize_speed(_with_periods(problem, heading, low, high))
        arc = arc_of(optimum, heading)
        if arc is None or optimum.best is None:
            failed = failed or optimum
            continue
        if best and best.best and abs(optimum.best.speed) <= abs(best.best.speed):
            continue
        nearest = max(round(arc.periods), 1)
        if abs(arc.periods - nearest) <= _WHOLE:
            best = optimum
            continue
        below = math.floor(arc.periods)
        sides = [(max(low, 1), min(below, high)), (max(below + 1, low), high)]
        # A part that its own answer is not in would come again and again.
        parts += [(*side, None) for side in sides if side[0] <= side[1] and side != (low, high)]
    return best or _not_whole(heading, relaxed, failed)


def _with_periods(problem: Problem, heading: float, low: float, high: float) -> Problem:
    """The problem with the number of periods for the heading bounded."""
    ends = sorted((heading / high, heading / low))
    turn = replace(problem.turn, heading=Interval(*ends)) if problem.turn else None
    return replace(problem, turn=turn)


def _not_whole(heading: float, relaxed: Optimum, failed: Optimum | None) -> Optimum:
    """No whole number of periods does it: the nearest heading that one does."""
    arc = arc_of(relaxed, heading)
    if arc is None or (failed and failed.status is not Status.INFEASIBLE):
        return failed or relaxed
    count = max(round(arc.periods), 1)
    nearest = math.degrees(heading / arc.periods * count)
    message = (
        f"No whole number of periods turns by {math.degrees(heading):.6g} deg on this circle "
        f"within the limits. The fastest gait there makes {nearest:.6g} deg in {count} "
        f"period{'s' if count > 1 else ''}. Ask for that heading, or leave out --cycles whole."
    )
    return Optimum(Status.INFEASIBLE, message, relaxed.problem)
