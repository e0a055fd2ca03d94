"""Why no gait respects all limits, and how far each must change, in sentences.

Angle, rate and singularity bound the amplitude alone, so their conflicts with the gait's bounds
are known exactly. For the torque the smallest peak that any allowed gait has is searched, and for
a turn the nearest that any allowed gait makes.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from rr_opt.array import Array
from rr_opt.design.climb import Merit
from rr_opt.design.decisions import Decisions, reach_before_singularity
from rr_opt.design.landscape import Cycles, Landscape
from rr_opt.design.scan import search
from rr_opt.design.seeds import least_torque
from rr_opt.design.turn_target import SURE, Nearest, asked_text, reached_text
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Interval, Problem

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
            f"Limit `angle` ({limits.angle:.6g} rad) conflicts with {of}: raise the limit to "
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


_NODES = 192
OUT_OF_REACH = 30.0
"""A limit exceeded by 1 % weighs as much as a turn that is off by 30 %; a distance as large as
this is that of gaits that all drive the other way."""

_NEAR = 0.01
_OPPOSITE = {"forward": "backward", "backward": "forward"}


def nearest_turn(
    problem: Problem, box: Decisions, landscapes: list[Landscape], direction: str
) -> Nearest:
    """The nearest of all gaits that drive in this direction."""
    signs = {"forward": (1,), "backward": (-1,), "either": (1, -1)}[direction]
    rows = box.turn
    if rows is None:
        raise ValueError("the problem asks for no turn")
    off = Merit(rows.intervals, (1.0,) * len(rows.intervals))

    def look(cycles: Cycles, gaits: Array, sign: Array) -> Array:
        turned = np.array(rows.values(cycles.speed, cycles.turn, gaits[1]))
        distance = -off(np.concatenate([np.zeros((1, len(sign))), turned]))
        torque = cycles.peak_torque / problem.limits.torque
        return np.array([-distance, torque, sign * np.sign(cycles.speed)])

    kept = (Interval(-math.inf, 1.0), Interval(0.0, math.inf))
    found = [
        (search(landscape, box, look, Merit(kept, (OUT_OF_REACH, OUT_OF_REACH)), signs), landscape)
        for landscape in landscapes
    ]
    (point, _, merit), landscape = max(found, key=lambda pair: pair[0][2])
    gaits = box.physical(point[None])
    cycle = landscape.cycles(gaits, _NODES)
    amplitude, period, offset, share = (float(value) for value in gaits[:, 0])
    turn, speed = float(cycle.turn[0]), abs(float(cycle.speed[0]))
    return Nearest(
        gait=SineGait(amplitude, period, offset),
        share=share,
        curvature=turn / (period * speed),
        yaw_rate=turn / period,
        heading=turn,
        torque=float(cycle.peak_torque[0]),
        distance=-merit,
    )


def turn_clashes(problem: Problem, box: Decisions, landscapes: list[Landscape]) -> list[str]:
    """Why no gait that keeps the limits turns as asked; empty if some do, as far as is known."""
    turn, direction = problem.turn, problem.direction
    if turn is None:
        return []
    nearest = nearest_turn(problem, box, landscapes, direction)
    if nearest.distance <= SURE:
        return []
    sentences = [f"The requested turn, {asked_text(turn)}, is infeasible."]
    if nearest.distance >= OUT_OF_REACH:
        sentences.append(
            f"Every gait tried that satisfies the limits drives {_OPPOSITE[direction]}; others "
            "may not."
        )
    else:
        gait, held = nearest.gait, held_by(problem, box, nearest)
        listed = " and ".join([", ".join(held[:-1]), held[-1]] if len(held) > 1 else held)
        held_text = listed or "no limit: the robot itself turns no closer to it"
        sentences.append(
            f"The closest feasible one is {reached_text(turn, nearest)}, with amplitude "
            f"{gait.amplitude:.4g} rad, period {gait.period:.4g} s, offset {gait.offset:.4g} rad. "
            f"It is limited by {held_text}."
        )
    if direction != "either":
        other = nearest_turn(problem, box, landscapes, _OPPOSITE[direction])
        if other.distance <= SURE:
            sentences.append(f"A gait that drives {_OPPOSITE[direction]} achieves it.")
    return [" ".join([*sentences, "Ask for a feasible turn, or relax what limits it."])]


def held_by(problem: Problem, box: Decisions, nearest: Nearest) -> list[str]:
    """The limits and bounds at which a gait lies, in words."""
    gait, limits = nearest.gait, problem.limits
    free = reach_before_singularity(problem.robot, limits.singularity)
    held = [
        f"limit `{name}`"
        for name, value, limit in (
            ("rate", gait.peak_rate, limits.rate),
            ("angle", gait.peak_angle, limits.angle),
            ("singularity", gait.peak_angle, free),
            ("torque", nearest.torque, limits.torque),
        )
        if value >= limit * (1 - _NEAR)
    ]
    shares = Interval(0.0, 0.0) if box.ballast.fixed else Interval(0.0, 1.0)
    for name, value, bounds in (
        ("amplitude", gait.amplitude, problem.gait.amplitude),
        ("period", gait.period, problem.gait.period),
        ("offset", gait.offset, problem.gait.offset),
        ("inertia ratio", nearest.share, shares),
    ):
        near = _NEAR * (bounds.high - bounds.low)
        if bounds.fixed:
            continue
        if value - bounds.low <= near:
            held.append(f"the {name}'s lower bound")
        elif bounds.high - value <= near:
            held.append(f"the {name}'s upper bound")
    return held
