"""Speed over period and amplitude: where the limits leave room, and where the optimum lies."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.formatting import number
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import GaitBounds, Interval, Limits, Problem
from rr_opt.model.robot import Robot
from rr_opt.results.figures import style
from rr_opt.results.figures.readout import cells
from rr_opt.results.sweep import Sweep
from rr_opt.verify.sweep import SpeedMap
from rr_opt.verify.sweep import speed_map as evaluated_map


def map_data(problem: Problem, robot: Robot, best: SineGait) -> SpeedMap:
    """Speed and peak torque around the optimum, over the problem's bounds.

    A quantity that the problem fixes is shown from half to one and a half times its value.
    """

    def opened(box: Interval) -> Interval:
        return Interval(0.5 * box.low, 1.5 * box.high) if box.fixed else box

    gait = problem.gait
    bounds = GaitBounds(opened(gait.amplitude), opened(gait.period), gait.offset)
    return evaluated_map(replace(problem, gait=bounds), robot, best.offset)


def uses(data: SpeedMap, problem: Problem, robot: Robot, offset: float) -> dict[str, Array]:
    """How much of each limit every gait of the map uses, (A, T): more than 1 exceeds it."""
    one, two, limits = robot.platform1, robot.platform2, problem.limits
    cosine = (limits.singularity - two.c) / one.c
    posture = math.acos(min(max(cosine, -1.0), 1.0)) if cosine > -1 else math.inf
    amplitude, period = np.meshgrid(data.amplitude, data.period, indexing="ij")
    angle = amplitude + abs(offset)
    return {
        "rate": 2 * math.pi * amplitude / (limits.rate * period),
        # Past the singular posture there is no torque, and no gait.
        "torque": np.nan_to_num(data.torque / limits.torque, nan=2.0),
        "singularity": angle / posture,
        "angle": angle / limits.angle,
    }


def allowed(data: SpeedMap, problem: Problem, robot: Robot, offset: float) -> NDArray[np.bool_]:
    """Which gaits of the map respect every limit, (A, T)."""
    return np.max(list(uses(data, problem, robot, offset).values()), axis=0) <= 1


def speed_map(
    ax: Axes,
    data: SpeedMap,
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
    # Each band has an edge of its colour, or thin white seams would show between them.
    fill.set(edgecolor="face", linewidth=0.5)
    shares = uses(data, problem, robot, best.offset)
    worst = np.clip(np.max(list(shares.values()), axis=0), 0.0, 2.0)
    ax.contourf(data.period, data.amplitude, worst, levels=[1.0, 2.0], colors=[style.GROUND],
                hatches=["////"], zorder=2)  # fmt: skip
    style.speed_bar(ax, fill)
    cells(ax, data.period, data.amplitude, 1e3 * data.speed, "mean speed, mm/s")
    _edges(ax, data, shares, problem.limits)
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


def _edges(ax: Axes, data: SpeedMap, shares: dict[str, Array], limits: Limits) -> None:
    """The edges of what is allowed, each with its name."""
    texts = {
        "rate": f"rate {number(limits.rate * 30 / math.pi, 3)} rpm",
        "torque": f"torque {number(limits.torque, 3)} N m",
        "singularity": f"S1 = {number(1e3 * limits.singularity, 3)} mm: nearly singular",
        "angle": f"|φ| = {number(limits.angle, 3)} rad",
    }
    halo = [withStroke(linewidth=3, foreground=style.PAPER, alpha=0.85)]
    regular = np.maximum(shares["singularity"], shares["angle"]) <= 1
    for name, share in shares.items():
        # The torque is known among gaits short of the limits on the angle.
        known = np.where(regular, share, np.nan) if name == "torque" else share
        if not np.nanmin(known, initial=2.0) < 1 < np.nanmax(known, initial=0.0):
            continue
        edge = ax.contour(
            data.period, data.amplitude, known, levels=[1.0], colors=[style.LIMIT], zorder=3,
            linewidths=1.4, linestyles=[style.DASHED if name == "torque" else "-"],
        )  # fmt: skip
        pieces = edge.get_paths()[0].to_polygons(closed_only=False)
        line = max(map(np.asarray, pieces), key=len)
        line = line[line[:, 0].argsort()]
        # Near the right end of a long line, beside the middle of a short one; at the left of a flat
        # one, which a rising one may meet at its right.
        if np.ptp(line[:, 1]) < 0.02 * np.ptp(data.amplitude):
            at, side = 0.03, "left"
        elif np.ptp(line[:, 0]) > 0.5 * np.ptp(data.period):
            at, side = 0.85, "right"
        else:
            at, side = 0.5, "left"
        x = float(np.quantile(line[[0, -1], 0], at))
        y = float(np.interp(x, *line.T))
        ax.text(x, y, f" {texts[name]} ", color=style.LIMIT, fontsize=9, zorder=5, va="bottom",
                ha=side, path_effects=halo)  # fmt: skip


_MANY = 2000


def draw_sweep(result: Sweep) -> dict[str, str]:
    """A dot for each gait that respects every limit, the fastest on top; a faint cross for any
    other. Many dots become one picture inside the SVG, to keep it small.

    Gaits of several offsets and inertia ratios share a place: what is seen is the fastest.
    """
    found, best = result.found.found, result.best
    amplitude, period = found.decisions[:2]
    speed, kept = 1e3 * found.speed, found.feasible
    order = np.flatnonzero(kept)
    order = order[np.argsort(np.abs(speed[order]))]
    top = float(np.abs(speed[order[-1]])) if len(order) else 1.0
    with style.styled():
        drawn = style.figure(style.WIDTH, 4.4)
        drawn.set_dpi(160)
        ax = drawn.add_subplot()
        ax.plot(period[~kept], amplitude[~kept], "x", color=style.GREY, ms=2.5, mew=0.5, alpha=0.3)
        dots = ax.scatter(
            period[order], amplitude[order], c=speed[order], cmap=style.SIGNED,
            norm=style.signed(top), s=26, edgecolors=style.GREY, linewidths=0.25, zorder=3,
        )  # fmt: skip
        for part in (*ax.collections, *ax.lines):
            part.set_rasterized(len(speed) > _MANY)
        ends = speed[order].min(initial=0.0), speed[order].max(initial=0.0)
        style.speed_bar(ax, dots).set_ylim(min(ends[0], -1e-9), max(ends[1], 1e-9))
        if best:
            ax.plot(best.gait.period, best.gait.amplitude, ms=19, mew=1.2, zorder=5, **style.STAR)
        ax.set_title(f"{len(speed)} gaits: dots keep every limit, crosses do not", weight="normal")
        label(ax)
        return {"sweep": style.svg(drawn)}
