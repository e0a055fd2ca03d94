"""Why no gait turns as asked: the nearest turn that a gait can make, and what holds it there."""

from __future__ import annotations

import math

import numpy as np

from rr_opt.array import Array
from rr_opt.design.climb import Merit
from rr_opt.design.decisions import Decisions, reach_before_singularity
from rr_opt.design.landscape import Cycles, Landscape
from rr_opt.design.scan import search
from rr_opt.design.turn.target import SURE, Nearest, asked_text, reached_text
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Interval, Problem

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
