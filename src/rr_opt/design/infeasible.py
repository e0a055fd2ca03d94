"""Why no gait respects all limits, and how far each must change, in sentences.

Angle, rate and singularity bound the amplitude alone, so their conflicts with the gait's bounds
are known exactly. For the torque the smallest peak that any allowed gait has is searched, and for
a turn the nearest that any allowed gait makes.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from rr_opt.design.decisions import Decisions, reach_before_singularity
from rr_opt.design.landscape import Landscape
from rr_opt.design.seeds import least_torque
from rr_opt.design.turn.infeasible import turn_clashes
from rr_opt.model.problem import Problem

_ROUNDING = 1 + 1e-9


def posture_clashes(problem: Problem, box: Decisions) -> str:
    """Why no gait keeps angle, rate and singularity; empty if some do."""
    return _told(_angle(problem) + _rate(problem) + _ballast(box))


def torque_clash(problem: Problem, box: Decisions, landscapes: list[Landscape]) -> str:
    """Why no gait that keeps the other limits keeps the torque's, or none that keeps them all
    turns as asked; empty if some do."""
    heavy = _torque(problem, box, landscapes)
    return _told(heavy) or " ".join(turn_clashes(problem, box, landscapes))


def direction_clash(problem: Problem, fastest: float) -> str:
    """Why no gait goes the way it should; `fastest` is the best speed that way in a scan, m/s,
    of gaits that turn as asked if a turn is asked for: then it says nothing about the others."""
    if problem.direction == "either" or fastest > 0 or problem.turn:
        return ""
    other = "backward" if problem.direction == "forward" else "forward"
    return _told(
        [
            f"`direction: {problem.direction}` conflicts with the bounds: every gait tried that "
            f"respects the other limits drives {other}, the slowest at {abs(fastest):.3g} m/s. "
            f"Allow `direction: {other}` or `either`, or widen the gait's bounds."
        ]
    )


def _told(clashes: list[str]) -> str:
    if not clashes:
        return ""
    both = ["All of these have to change together."] if len(clashes) > 1 else []
    return " ".join(["No gait respects all limits.", *clashes, *both])


def _angle(problem: Problem) -> list[str]:
    gait, limits, robot = problem.gait, problem.limits, problem.robot
    least = abs(gait.offset.clip(0.0))
    needed = gait.amplitude.low + least
    of = f"the amplitude's lower bound {gait.amplitude.low:.6g} rad"
    if least:
        of += f" about an offset of at least {least:.6g} rad"
    clashes = []
    if needed > limits.angle * _ROUNDING:
        clashes.append(
            f"Limit `angle` ({limits.angle:.6g} rad)  conflicts with {of}: raise the limit to "
            f"{_up(needed)} rad, or {_lower(limits.angle, least)}."
        )
    reach = reach_before_singularity(robot, limits.singularity)
    if needed > reach * _ROUNDING:
        S1 = 1e3 * (robot.platform1.c * math.cos(needed) + robot.platform2.c)
        widest = 1e3 * (robot.platform1.c + robot.platform2.c)
        asked = f"Limit `singularity` (S1 = c1 cos phi + c2 >= {1e3 * limits.singularity:.6g} mm"
        if math.isinf(reach):
            clashes.append(
                f"{asked}) is more than the robot has: at phi = 0, S1 is {widest:.6g} mm. With "
                f"{of} it falls to {S1:.6g} mm: ask for a margin of at most that."
                if S1 > 0
                else f"{asked}) is more than the robot has: at phi = 0, S1 is {widest:.6g} mm. "
                "Ask for a smaller margin."
            )
        else:
            margin = (
                f"lower the margin to {_down(S1)} mm, or {_lower(reach, least)}."
                if S1 > 0
                else f"{_lower(reach, least)}; no margin allows it, as S1 falls to {S1:.6g} mm, "
                "past the singular posture."
            )
            clashes.append(
                f"{asked}, so |phi| <= {_down(reach)} rad) conflicts with {of}: {margin}"
            )
    return clashes


def _lower(reach: float, offset: float) -> str:
    """How the gait's bounds must change for |phi| to stay within reach."""
    if reach > offset:
        return f"lower the amplitude's bound to {_down(reach - offset)} rad"
    return f"bring the offset within {_down(reach)} rad and the amplitude's bound below the rest"


def _rate(problem: Problem) -> list[str]:
    gait, limits = problem.gait, problem.limits
    needed = 2 * math.pi * gait.amplitude.low / gait.period.high
    if needed <= limits.rate * _ROUNDING:
        return []
    return [
        f"Limit `rate` ({limits.rate:.6g} rad/s) conflicts with the amplitude's lower bound "
        f"{gait.amplitude.low:.6g} rad and the period's upper bound {gait.period.high:.6g} s: "
        f"raise the limit to {_up(needed)} rad/s ({_up(needed * 30 / math.pi)} rpm), or the "
        f"period's bound to {_up(2 * math.pi * gait.amplitude.low / limits.rate)} s, or lower the "
        f"amplitude's bound to {_down(limits.rate * gait.period.high / (2 * math.pi))} rad."
    ]


def _up(value: float) -> str:
    """Six digits, rounded up: the limit as printed is then enough."""
    return _rounded(value, math.ceil)


def _down(value: float) -> str:
    """Six digits, rounded down."""
    return _rounded(value, math.floor)


def _rounded(value: float, towards: Callable[[float], int]) -> str:
    step = 10.0 ** (math.floor(math.log10(abs(value))) - 5) if value else 1.0
    # What is exact to rounding stays as it is: 2.7 is not to become 2.70001.
    nearest = round(value / step)
    exact = abs(value / step - nearest) < 1e-6
    return f"{(nearest if exact else towards(value / step)) * step:.6g}"


def _ballast(box: Decisions) -> list[str]:
    if box.ballast.low <= box.ballast.high:
        return []
    return ["The inertia ratio's bounds lie below what the robot has without loads."]


def _torque(problem: Problem, box: Decisions, landscapes: list[Landscape]) -> list[str]:
    limit = problem.limits.torque
    if math.isinf(limit):
        return []
    least = min(least_torque(landscape, box) for landscape in landscapes)
    if least <= limit:
        return []
    # The search for it is good to a few parts in ten thousand.
    enough = _up(1.001 * least)
    return [
        f"Limit `torque` ({limit:.6g} N m) conflicts with the gait's bounds: among the gaits that "
        f"keep the other limits, the least peak torque is {enough} N m. Raise the limit to that, "
        "or allow longer periods or smaller amplitudes."
    ]
