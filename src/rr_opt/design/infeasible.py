"""Why no gait keeps all limits, and how far each must give, in sentences.

Angle, rate and singularity bound the amplitude alone, so their clashes with the gait's bounds
are known exactly. For the torque the smallest peak that any allowed gait has is searched.
"""

from __future__ import annotations

import math

from rr_opt.design.decisions import Decisions, reach_before_singularity
from rr_opt.design.landscape import Landscape
from rr_opt.design.seeds import least_torque
from rr_opt.problem import Problem


def posture_clashes(problem: Problem, box: Decisions) -> str:
    """Why no gait keeps angle, rate and singularity; empty if some do."""
    return _told(_angle(problem) + _rate(problem) + _ballast(box))


def torque_clash(problem: Problem, box: Decisions, landscapes: list[Landscape]) -> str:
    """Why no gait that keeps the other limits keeps the torque's; empty if some do."""
    return _told(_torque(problem, box, landscapes))


def direction_clash(problem: Problem, fastest: float) -> str:
    """Why no gait goes the way it should; `fastest` is the best speed that way in a scan, m/s."""
    if problem.direction == "either" or fastest > 0:
        return ""
    other = "backward" if problem.direction == "forward" else "forward"
    return _told(
        [
            f"`direction: {problem.direction}` clashes with the bounds: every gait tried that "
            f"keeps the other limits drives {other}, the slowest at {abs(fastest):.3g} m/s. Allow "
            f"`direction: {other}` or `either`, or widen the bounds on amplitude, period or offset."
        ]
    )


def _told(clashes: list[str]) -> str:
    return " ".join(["No gait keeps all limits.", *clashes]) if clashes else ""


def _angle(problem: Problem) -> list[str]:
    gait, limits, robot = problem.gait, problem.limits, problem.robot
    least = abs(gait.offset.clip(0.0))
    needed = gait.amplitude.low + least
    of = f"the amplitude's lower bound {gait.amplitude.low:.4g} rad"
    if least:
        of += f" about an offset of at least {least:.4g} rad"
    clashes = []
    if needed > limits.angle:
        clashes.append(
            f"Limit `angle` ({limits.angle:.4g} rad) clashes with {of}: raise the limit to "
            f"{needed:.4g} rad, or lower the amplitude's bound to {limits.angle - least:.4g} rad."
        )
    reach = reach_before_singularity(robot, limits.singularity)
    if needed > reach:
        S1 = robot.platform1.c * math.cos(needed) + robot.platform2.c
        lower = (
            f"lower the amplitude's bound to {reach - least:.4g} rad"
            if reach > least
            else "bring the offset nearer to 0"
        )
        give = (
            f"lower the margin to {1e3 * S1:.4g} mm, or {lower}."
            if S1 > 0
            else f"{lower}; no margin allows it, as S1 falls to {1e3 * S1:.4g} mm, past the "
            "singular posture."
        )
        clashes.append(
            f"Limit `singularity` (S1 = c1 cos phi + c2 >= {1e3 * limits.singularity:.4g} mm, "
            f"so |phi| <= {max(reach, 0.0):.4g} rad) clashes with {of}: {give}"
        )
    return clashes


def _rate(problem: Problem) -> list[str]:
    gait, limits = problem.gait, problem.limits
    needed = 2 * math.pi * gait.amplitude.low / gait.period.high
    if needed <= limits.rate:
        return []
    return [
        f"Limit `rate` ({limits.rate:.4g} rad/s) clashes with the amplitude's lower bound "
        f"{gait.amplitude.low:.4g} rad and the period's upper bound {gait.period.high:.4g} s: "
        f"raise the limit to {needed:.4g} rad/s ({needed * 30 / math.pi:.4g} rpm), or the period's "
        f"bound to {2 * math.pi * gait.amplitude.low / limits.rate:.4g} s, or lower the "
        f"amplitude's bound to {limits.rate * gait.period.high / (2 * math.pi):.4g} rad."
    ]


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
    return [
        f"Limit `torque` ({limit:.4g} N m) clashes with the gait's bounds: among the gaits that "
        f"keep the other limits, the least peak torque is {least:.4g} N m. Raise the limit to "
        "that, or allow longer periods or smaller amplitudes."
    ]
