"""Speed over period and amplitude: where the limits leave room, and where the optimum lies."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.formatting import number
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import GaitBounds, Interval, Problem
from rr_opt.model.robot import Robot
from rr_opt.report.figures import style
from rr_opt.verify.sweep import speed_map as evaluated_map


@dataclass(frozen=True)
class MapData:
    """What the map shows, at one offset and inertia ratio.

    period (T,) s; amplitude (A,) rad; speed (A, T) m/s signed; torque (A, T) N m, the peak.
    Where the robot would pass its singular posture both are nan.
    """

    period: Array
    amplitude: Array
    speed: Array
    torque: Array


def map_data(problem: Problem, robot: Robot, best: SineGait) -> MapData:
    """Speed and peak torque around the optimum, over the problem's bounds.

    A quantity that the problem fixes is shown from half to one and a half times its value.
    """

    def opened(box: Interval) -> Interval:
        return Interval(0.5 * box.low, 1.5 * box.high) if box.fixed else box

    gait = problem.gait
    bounds = GaitBounds(opened(gait.amplitude), opened(gait.period), gait.offset)
    found = evaluated_map(replace(problem, gait=bounds), robot, best.offset)
    return MapData(found.periods, found.amplitudes, found.speed.T, found.peak_torque.T)


def reach(problem: Problem, robot: Robot, offset: float) -> dict[str, float]:
    """The amplitude (rad) at which each limit on the angle is met, for gaits at an offset."""
    one, two = robot.platform1, robot.platform2
    cosine = (problem.limits.singularity - two.c) / one.c
    edge = math.acos(min(max(cosine, -1.0), 1.0)) if cosine > -1 else math.inf
    return {"singularity": edge - abs(offset), "angle": problem.limits.angle - abs(offset)}


def allowed(data: MapData, problem: Problem, robot: Robot, offset: float) -> NDArray[np.bool_]:
    """Which gaits of the map respect every limit, (A, T)."""
    amplitude, period = data.amplitude[:, None], data.period[None, :]
    inside = amplitude <= min(reach(problem, robot, offset).values())
    inside = inside & (2 * math.pi * amplitude <= problem.limits.rate * period)
    with np.errstate(invalid="ignore"):
        return inside & (data.torque <= problem.limits.torque)


def speed_map(
    ax: Axes,
    data: MapData,
    problem: Problem,
    robot: Robot,
    best: SineGait,
    *,
    others: Sequence[SineGait] = (),
) -> Axes:
    """Filled contours of the speed where all limits are respected; hatched where one is not.

    best is marked with a star, others with rings.
    """
    inside = allowed(data, problem, robot, best.offset)
    kept = 1e3 * data.speed[inside]
    low, high = (min(kept.min(), 0.0), max(kept.max(), 0.0)) if kept.size else (-1.0, 1.0)
    top = max(-low, high, 1e-9)
    levels = np.linspace(low if low < 0 else -1e-3 * top, high if high > 0 else 1e-3 * top, 31)
    style.hatched(ax)
    # Colours beyond a limit are covered below, so the speed is only clipped there: a contour
    # that ended at the limit's line would end in steps.
    shown = np.clip(1e3 * data.speed, low, high)
    fill = ax.contourf(
        data.period,
        data.amplitude,
        shown,
        levels=levels,
        cmap=style.SIGNED,
        norm=style.signed(top),
        zorder=1,
    )
    # Each band gets an edge of its own colour: else thin white seams show between them.
    fill.set(edgecolor="face", linewidth=0.5)
    _cover(ax, data, problem, robot, best.offset)
    style.speed_bar(ax, fill)
    _limit_lines(ax, data, problem, robot, best.offset)
    for one in others:
        ax.plot(one.period, one.amplitude, "o", ms=9, mfc="none", mec=style.INK, mew=1.4, zorder=6)
    ax.plot(best.period, best.amplitude, ms=19, mew=1.2, zorder=7, label="optimum", **style.STAR)
    ax.set(xlim=(data.period[0], data.period[-1]), ylim=(data.amplitude[0], data.amplitude[-1]))
    ax.grid(visible=False)
    label(ax)
    return ax


def label(ax: Axes) -> None:
    """Label the axes of a map of sines."""
    ax.set(xlabel="period T, s", ylabel="amplitude α, rad")


def _cover(ax: Axes, data: MapData, problem: Problem, robot: Robot, offset: float) -> None:
    """Hatched grey over every gait that exceeds a limit."""
    amplitude, period = data.amplitude[:, None], data.period[None, :]
    most = min(reach(problem, robot, offset).values())
    excess = np.maximum(amplitude - most, amplitude - problem.limits.rate * period / 2 / math.pi)
    span = data.amplitude[-1]
    torque = np.where(np.isfinite(data.torque), data.torque, 2 * problem.limits.torque)
    if math.isfinite(problem.limits.torque):
        excess = np.maximum(excess, span * (torque / problem.limits.torque - 1))
    excess = np.clip(excess, -span, span)
    ax.contourf(
        data.period, data.amplitude, excess, levels=[0.0, 2 * span], colors=[style.GROUND],
        hatches=["////"], zorder=2,
    )  # fmt: skip


def _limit_lines(ax: Axes, data: MapData, problem: Problem, robot: Robot, offset: float) -> None:
    """The edges of what is allowed, each with its name."""
    period, limits = data.period, problem.limits
    bottom, top = data.amplitude[0], data.amplitude[-1]
    if math.isfinite(limits.rate):
        _rate_line(ax, data, limits.rate)
    lines = reach(problem, robot, offset)
    texts = {
        "singularity": f"S1 = {number(1e3 * limits.singularity, 3)} mm: singular posture near",
        "angle": f"|φ| = {number(limits.angle, 3)} rad",
    }
    for name, line in lines.items():
        if line < top:
            ax.axhline(line, color=style.LIMIT, lw=1.4, zorder=3)
            place = period[0] + 0.97 * (period[-1] - period[0])
            _name(ax, place, line + 0.015 * (top - bottom), texts[name], ha="right", va="bottom")
    _torque_line(ax, data, limits.torque, min(lines.values()))


def _rate_line(ax: Axes, data: MapData, limit: float) -> None:
    """alpha = rate T/(2 pi), named on the side where there is room."""
    (left, right), (bottom, top) = data.period[[0, -1]], data.amplitude[[0, -1]]
    slope = limit / (2 * math.pi)
    first, last = max(left, bottom / slope), min(right, top / slope)
    if first >= last:
        return
    ax.plot([first, last], [slope * first, slope * last], color=style.LIMIT, lw=1.4, zorder=3)
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
        data.period, data.amplitude[rows], torque, levels=[limit], colors=[style.LIMIT],
        linewidths=1.4, linestyles=[style.DASHED], zorder=3,
    )  # fmt: skip
    lines = drawn.get_paths()[0].to_polygons(closed_only=False)
    line = max((np.asarray(one) for one in lines), key=len)
    x, y = line[len(line) // 2]
    _name(ax, float(x), float(y), f" torque {number(limit, 3)} N m", ha="left")


def _name(ax: Axes, x: float, y: float, text: str, *, ha: str, va: str = "center") -> None:
    halo = [withStroke(linewidth=3, foreground=style.PAPER, alpha=0.85)]
    ax.text(
        x, y, text + " ", color=style.LIMIT, fontsize=9, ha=ha, va=va, zorder=5, path_effects=halo
    )
