"""Why no gait satisfies all limits, and by how much each must change, in sentences.

Angle, rate and singularity bound the amplitude alone, so their conflicts with the gait's bounds
are known exactly. For the torque, the gait of least peak torque is searched for; for a turn, the
gait closest to it. Both searches are a scan, whose resolution is reported, followed by climbs.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from rr_opt.array import Array
from rr_opt.design.decisions import (
    Decisions,
    Setting,
    reach_before_singularity,
    scanned,
    settings_of,
)
from rr_opt.design.seeds import tops
from rr_opt.design.sines import FEWEST, WAYS, climbed
from rr_opt.design.terrain import STANDS, Aim, Terrain
from rr_opt.design.transcription import TURN
from rr_opt.messages import listed
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import ANY, Interval, Problem, Turn
from rr_opt.sqp import FEASIBLE

_ROUNDING = 1 + 1e-9
_ENOUGH = 1 + 1e-5
"""Factor applied to the least feasible value of a limit that was found."""
NODES = 768
_NEAR = 0.01
_OPPOSITE = {"forward": "backward", "backward": "forward"}


def posture_clashes(problem: Problem, box: Decisions) -> str:
    """Why no gait satisfies angle, rate and singularity; empty if some do."""
    return _told(_angle(problem) + _rate(problem) + _ballast(box))


@dataclass(frozen=True)
class Attempt:
    """The gait (4,) closest to the request in a setting; its violation; and how many gaits were
    scanned to find it."""

    setting: Setting
    gait: Array
    excess: float
    scanned: int


def attempt(
    settings: list[Setting], box: Decisions, rows: tuple[str, ...], aim: Aim, way: int
) -> Attempt:
    """The gait with the least violation, or the first that has none."""
    best, count = Attempt(settings[0], np.zeros(4), math.inf, 0), 0
    for setting in settings:
        terrain = Terrain(setting, scanned(setting, box), way, rows, aim)
        points, more = tops(terrain, thorough=True)
        count += more
        for start in terrain.box.physical(points).T:
            found = _climbed(terrain, start, FEWEST)
            if found.excess < best.excess:
                best = _climbed(terrain, found.gait, NODES)
            if best.excess <= FEASIBLE:
                return best
    return replace(best, scanned=count)


def _climbed(terrain: Terrain, start: Array, nodes: int) -> Attempt:
    ascent, gait = climbed(terrain, start, nodes)
    return Attempt(terrain.setting, gait, max(ascent.violation, -ascent.value), 0)


def clash(problem: Problem, box: Decisions, settings: list[Setting]) -> str | Attempt:
    """Why no gait within angle, rate and singularity satisfies the other limits and the turn; or a
    gait that does."""
    way, seek = WAYS[problem.direction], partial(attempt, settings, box)
    found = seek(("torque",), "rows", 0)
    if problem.limits.economy and found.excess <= FEASIBLE:
        found = seek(("torque", "economy"), "rows", 0)
    if found.excess > FEASIBLE:
        names = Terrain(found.setting, box, 0).clashing(found.gait, NODES, found.excess)
        words = _load(problem, names[0], found) if len(names) == 1 else _both(problem, names, found)
        return f"{_told([words])} {_evidence(found, box)}"
    if way:
        found = seek(("torque", "economy", "direction"), "rows", way)
        if found.excess > FEASIBLE:
            return f"{_told([_direction(problem)])} {_evidence(found, box)}"
    if problem.turn:
        rows = ("torque", "economy", "direction")
        found = seek(rows, "turn", way)
        if found.excess > FEASIBLE:
            other = seek(rows, "turn", -way) if way else found
            return " ".join([*_turn(problem, box, found, other), _evidence(found, box)])
    return found


SURE = 2e-3
"""Relative safety margin of reported values; the search is good to a few parts in 10 000."""


@dataclass(frozen=True)
class Nearest:
    """The gait closest to a turn within all limits, and its motion.

    speed    signed, m/s
    torque   largest, N m; share: of the ballast's range
    """

    gait: SineGait
    share: float
    speed: float
    curvature: float
    yaw_rate: float
    heading: float
    torque: float


def nearest_turn(problem: Problem, box: Decisions) -> Nearest:
    """The motion of the gait closest to the turn within all other limits."""
    way, rows = WAYS[problem.direction], ("torque", "economy", "direction")
    return _nearest(attempt(settings_of(problem, box), box, rows, "turn", way))


def _evidence(found: Attempt, box: Decisions) -> str:
    apart = found.scanned ** (-1 / max(len(box.free), 1))
    return (
        f"This is based on {found.scanned} gaits across the bounds, spaced {100 * apart:.2g} % of "
        "each range apart, and on local searches from the best of them."
    )


_UNITS = {"torque": " N m", "power": " W", "speed": " m/s"}


def _both(problem: Problem, names: list[str], found: Attempt) -> str:
    limits = [f"`{n}` ({getattr(problem.limits, n):.6g}{_UNITS.get(n, '')})" for n in names]
    return (
        f"Limits {listed(limits)} clash: the gait that comes closest to keeping all limits exceeds "
        f"each of these by {100 * found.excess:.2g} %."
    )


def _load(problem: Problem, name: str, found: Attempt) -> str:
    limit = getattr(problem.limits, name)
    unit = _UNITS.get(name, "")
    if name == "speed":
        return (
            f"Limit `speed` ({limit:.6g}{unit}) conflicts with the gait's bounds: the fastest of "
            f"the gaits that keep the other limits has "
            f"{_down(limit * (1 - found.excess) / _ENOUGH)}{unit}. Ask for that, or relax what "
            "limits it."
        )
    quantity = f"peak {name}" if name in ("torque", "grip") else name.replace("_", " ")
    return (
        f"Limit `{name}` ({limit:.6g}{unit}) conflicts with the gait's bounds: among the gaits "
        f"that keep the other limits, the least {quantity} is "
        f"{_up(limit * (1 + found.excess) * _ENOUGH)}{unit}. Raise the limit to that, "
        "or allow longer periods or smaller amplitudes."
    )


def _direction(problem: Problem) -> str:
    other = _OPPOSITE[problem.direction]
    return (
        f"`direction: {problem.direction}` conflicts with the bounds: every gait that respects the "
        f"other limits drives {other}. Allow `direction: {other}` or `either`, or widen the gait's "
        "bounds."
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
        S1, widest = (1e3 * float(robot.S1(phi)) for phi in (needed, 0.0))
        asked = f"Limit `singularity` (S1 = c1 cos phi + c2 >= {1e3 * limits.singularity:.6g} mm"
        if math.isinf(reach):
            less = f"With {of} it falls to {S1:.6g} mm: ask for a margin of at most that."
            clashes.append(
                f"{asked}) is more than the robot has: at phi = 0, S1 is {widest:.6g} mm. "
                + (less if S1 > 0 else "Ask for a smaller margin.")
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
    """Six digits, rounded up, so that the limit as printed is sufficient."""
    return _rounded(value, math.ceil)


def _down(value: float) -> str:
    """Six digits, rounded down."""
    return _rounded(value, math.floor)


def _rounded(value: float, towards: Callable[[float], int]) -> str:
    step = 10.0 ** (math.floor(math.log10(abs(value))) - 5) if value else 1.0
    # A value that is exact to within rounding is not rounded: 2.7 must not become 2.70001.
    nearest = round(value / step)
    exact = abs(value / step - nearest) < 1e-6
    return f"{(nearest if exact else towards(value / step)) * step:.6g}"


def _ballast(box: Decisions) -> list[str]:
    if box.ballast.low <= box.ballast.high:
        return []
    return ["The inertia ratio's bounds lie below what the robot has without loads."]


def _nearest(found: Attempt) -> Nearest:
    cycle = found.setting.landscape.cycles(found.gait[:, None], NODES)
    amplitude, period, offset, share = found.gait.tolist()
    turn, speed = float(cycle.turn[0]), float(cycle.speed[0])
    return Nearest(
        gait=SineGait(amplitude, period, offset),
        share=share,
        speed=speed,
        curvature=turn / (period * abs(speed)),
        yaw_rate=turn / period,
        heading=turn,
        torque=float(cycle.peak_torque[0]),
    )


def _turn(problem: Problem, box: Decisions, found: Attempt, other: Attempt) -> list[str]:
    """Why no gait makes the turn; other: the closest one that drives the other way."""
    turn, nearest = problem.turn or Turn(), _nearest(found)
    gait, held = nearest.gait, held_by(problem, box, nearest)
    held_text = listed(held) or "no limit: the robot itself can turn no closer to it"
    sentences = [
        f"The requested turn, {_asked_text(turn)}, is infeasible.",
        f"The closest feasible one is {_reached_text(turn, nearest)}, with amplitude "
        f"{gait.amplitude:.4g} rad, period {gait.period:.4g} s, offset {gait.offset:.4g} rad, at "
        f"{1e3 * abs(nearest.speed):.4g} mm/s. "
        f"It is limited by {held_text}.",
    ]
    if other.excess <= FEASIBLE:
        sentences.append(f"A gait that drives {_OPPOSITE[problem.direction]} achieves it.")
    return [*sentences, "Ask for a feasible turn, or relax what limits it."]


def held_by(problem: Problem, box: Decisions, nearest: Nearest) -> list[str]:
    """The active limits and bounds of a gait, in words."""
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
    if abs(nearest.speed) < STANDS * (1 + _NEAR):
        held.append(f"its speed: below {1e3 * STANDS:g} mm/s a robot counts as stationary")
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


def _asked_text(turn: Turn) -> str:
    """The request, in words."""
    bounds = {"curvature": "" if turn.curvature.fixed else "at most ", "yaw_rate": "at least "}
    asked = {name: getattr(turn, name) for name in TURN}
    return " with ".join(
        _turn_text(name, _binding(one), bounds.get(name, ""))
        for name, one in asked.items()
        if one != ANY
    )


def _reached_text(turn: Turn, nearest: Nearest) -> str:
    """The closest reachable value in words, rounded to the feasible side."""
    parts = []
    for name in TURN:
        asked, value = getattr(turn, name), getattr(nearest, name)
        if asked != ANY:
            # Rounding towards the request would be infeasible.
            value *= 1 - math.copysign(SURE, (asked.clip(value) - value) * value)
            parts.append(_turn_text(name, value))
    return " with ".join(parts)


def _turn_text(name: str, value: float, bound: str = "") -> str:
    """`a radius of 0.3 m to the left`; bound: such as `at most `."""
    side = "left" if value > 0 else "right"
    if name == "curvature":
        return f"a radius of {bound}{abs(1 / value):.4g} m to the {side}"
    unit = {"yaw_rate": "rad/s", "heading": "rad a period"}[name]
    return f"{bound}{abs(value):.4g} {unit} to the {side}"


def _binding(asked: Interval) -> float:
    """The binding end of an interval: a finite one, the nearest to straight."""
    ends = [end for end in (asked.low, asked.high) if math.isfinite(end)]
    return min(ends, key=abs)
