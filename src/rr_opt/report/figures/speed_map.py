"""Speed over period and amplitude: where the limits leave room, and where the optimum lies."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from rr_opt.problem import Problem
from rr_opt.report.figures.limit_lines import limit_lines, reach
from rr_opt.report.figures.map_data import MapData
from rr_opt.report.figures.style import INK, OPTIMUM, SIGNED
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import Robot


def allowed(data: MapData, problem: Problem, robot: Robot, offset: float) -> NDArray[np.bool_]:
    """Which gaits of the map keep every limit, (A, T)."""
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
    """Filled contours of the speed where all limits are kept; hatched where one is broken.

    best is marked with a star, others with rings.
    """
    inside = allowed(data, problem, robot, best.offset)
    kept = 1e3 * data.speed[inside]
    low, high = (min(kept.min(), 0.0), max(kept.max(), 0.0)) if kept.size else (-1.0, 1.0)
    top = max(-low, high, 1e-9)
    levels = np.linspace(low if low < 0 else -1e-3 * top, high if high > 0 else 1e-3 * top, 31)

    ax.set_facecolor("#eceff2")
    ax.fill_between(
        data.period, 0, 1, transform=ax.get_xaxis_transform(), facecolor="none", hatch="////",
        edgecolor=(0, 0, 0, 0), zorder=0,
    )  # fmt: skip
    # Colours beyond a limit are covered below, so the speed is only clipped there: a contour
    # that ended at the limit's line would end in steps.
    shown = np.clip(1e3 * data.speed, low, high)
    norm = TwoSlopeNorm(0.0, -top, top)
    fill = ax.contourf(
        data.period, data.amplitude, shown, levels=levels, cmap=SIGNED, norm=norm, zorder=1
    )
    # Each band gets an edge of its own colour: else thin white seams show between them.
    fill.set(edgecolor="face", linewidth=0.5)
    _cover(ax, data, problem, robot, best.offset)
    bar = ax.figure.colorbar(fill, ax=ax, pad=0.02, aspect=26, ticks=MaxNLocator(7))
    bar.set_label("mean speed, mm/s  (+ forward, − backward)")
    bar.outline.set_visible(False)  # type: ignore[operator]
    limit_lines(ax, data, problem, robot, best.offset)
    for one in others:
        ax.plot(one.period, one.amplitude, "o", ms=9, mfc="none", mec=INK, mew=1.4, zorder=6)
    ax.plot(
        best.period, best.amplitude, "*", ms=19, mfc=OPTIMUM, mec=INK, mew=1.2, zorder=7,
        clip_on=False, label="optimum",
    )  # fmt: skip
    ax.set_xlim(data.period[0], data.period[-1])
    ax.set_ylim(data.amplitude[0], data.amplitude[-1])
    ax.grid(False)
    ax.set_xlabel("period T, s")
    ax.set_ylabel("amplitude α, rad")
    return ax


def _cover(ax: Axes, data: MapData, problem: Problem, robot: Robot, offset: float) -> None:
    """Hatched grey over every gait that breaks a limit."""
    amplitude, period = data.amplitude[:, None], data.period[None, :]
    most = min(reach(problem, robot, offset).values())
    excess = np.maximum(amplitude - most, amplitude - problem.limits.rate * period / 2 / math.pi)
    span = data.amplitude[-1]
    torque = np.where(np.isfinite(data.torque), data.torque, 2 * problem.limits.torque)
    if math.isfinite(problem.limits.torque):
        excess = np.maximum(excess, span * (torque / problem.limits.torque - 1))
    excess = np.clip(excess, -span, span)
    ax.contourf(
        data.period, data.amplitude, excess, levels=[0.0, 2 * span], colors=["#eceff2"],
        hatches=["////"], zorder=2,
    )  # fmt: skip
