"""The edges of what the limits allow, drawn over period and amplitude, each with its name."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke

from rr_opt.problem import Problem
from rr_opt.report.figures.map_data import MapData
from rr_opt.report.figures.style import LIMIT, PAPER
from rr_opt.report.quantities import number
from rr_opt.robot.parameters import Robot


def reach(problem: Problem, robot: Robot, offset: float) -> dict[str, float]:
    """The amplitude (rad) at which each limit on the angle is met, for gaits at an offset."""
    one, two = robot.platform1, robot.platform2
    cosine = (problem.limits.singularity - two.c) / one.c
    edge = math.acos(min(max(cosine, -1.0), 1.0)) if cosine > -1 else math.inf
    return {"singularity": edge - abs(offset), "angle": problem.limits.angle - abs(offset)}


def limit_lines(ax: Axes, data: MapData, problem: Problem, robot: Robot, offset: float) -> None:
    """The edges of what is allowed, each with its name."""
    period, limits = data.period, problem.limits
    bottom, top = data.amplitude[0], data.amplitude[-1]
    if math.isfinite(limits.rate):
        _rate_line(ax, data, limits.rate)
    lines = reach(problem, robot, offset)
    for name, line in lines.items():
        if line < top:
            ax.axhline(line, color=LIMIT, lw=1.4, zorder=3)
            text = (
                f"S1 = {number(1e3 * limits.singularity, 3)} mm: singular posture near"
                if name == "singularity"
                else f"|φ| = {number(limits.angle, 3)} rad"
            )
            place = period[0] + 0.97 * (period[-1] - period[0])
            _name(ax, place, line + 0.015 * (top - bottom), text, ha="right", va="bottom")
    _torque_line(ax, data, limits.torque, min(lines.values()))


def _rate_line(ax: Axes, data: MapData, limit: float) -> None:
    """alpha = rate T/(2 pi), named on the side where there is room."""
    (left, right), (bottom, top) = data.period[[0, -1]], data.amplitude[[0, -1]]
    slope = limit / (2 * math.pi)
    first, last = max(left, bottom / slope), min(right, top / slope)
    if first >= last:
        return
    ax.plot([first, last], [slope * first, slope * last], color=LIMIT, lw=1.4, zorder=3)
    at = first + 0.6 * (last - first)
    side = "right" if at - left > 0.3 * (right - left) else "left"
    _name(ax, at, slope * at, f" rate {number(limit * 30 / math.pi, 3)} rpm", ha=side)


def _torque_line(ax: Axes, data: MapData, limit: float, most: float) -> None:
    """Where the peak torque meets its limit, among gaits short of the limits on the angle."""
    rows = data.amplitude <= most
    torque = data.torque[rows]
    known = np.isfinite(torque)
    if not known.any() or not torque[known].min() < limit < torque[known].max():
        return
    drawn = ax.contour(
        data.period, data.amplitude[rows], torque, levels=[limit], colors=[LIMIT],
        linewidths=1.4, linestyles=[(0, (4, 2))], zorder=3,
    )  # fmt: skip
    line = max(
        (np.asarray(one) for one in drawn.get_paths()[0].to_polygons(closed_only=False)), key=len
    )
    x, y = line[len(line) // 2]
    _name(ax, float(x), float(y), f" torque {number(limit, 3)} N m", ha="left")


def _name(ax: Axes, x: float, y: float, text: str, *, ha: str, va: str = "center") -> None:
    halo = [withStroke(linewidth=3, foreground=PAPER, alpha=0.85)]
    ax.text(x, y, text + " ", color=LIMIT, fontsize=9, ha=ha, va=va, zorder=5, path_effects=halo)
