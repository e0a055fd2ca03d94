"""The figures of a turn: those of a fastest gait, with the requested circle."""

import math

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes

from rr_opt.formatting import with_unit
from rr_opt.motion.rollout import repeated
from rr_opt.motion.steady_cycle import SteadyCycle
from rr_opt.results.figures import fastest, style
from rr_opt.results.figures.motion import path
from rr_opt.results.turn import FastestTurn, TurnChart
from rr_opt.verify.turn_chart import TurnMap


def draw_turn(turn: FastestTurn) -> dict[str, str]:
    """Draw all figures; none if there is no turn to show."""
    drawn = fastest.draw(turn)
    if drawn and turn.arc is not None and math.isfinite(turn.radius or math.inf):
        drawn["path"] = style.panel(4.8, lambda ax: arc(ax, turn))
    return drawn


def arc(ax: Axes, turn: FastestTurn) -> None:
    """The circle, dashed; the arc of the turn as a band with its ends marked; the path of P, m."""
    way, replay, radius = turn.arc, turn.replay, turn.radius
    if way is None or replay is None or radius is None:
        return
    steady = replay.steady
    cycles = max(1, math.ceil(way.periods - 1e-9))
    motion = repeated(steady, cycles, every=math.ceil(cycles * len(steady.t) / _SAMPLES))
    centre = _centre(steady)
    start = np.angle(complex(motion.x[0], motion.y[0]) - centre)
    round_ = centre + radius * np.exp(1j * np.linspace(0, 2 * math.pi, 361))
    along = centre + radius * np.exp(1j * (start + np.linspace(0, way.heading, 181)))
    ax.plot(round_.real, round_.imag, color=style.GREY, lw=1.1, ls=style.DASHED, label="circle")
    ax.plot(along.real, along.imag, color=style.FAINT, lw=9, solid_capstyle="butt", label="turn")
    for end in (along[0], along[-1]):
        spoke = np.array([centre, end])
        ax.plot(np.real(spoke), np.imag(spoke), color=style.GREY, lw=0.8)
    ax.plot(centre.real, centre.imag, "+", color=style.GREY, ms=8)
    path(ax, turn.robot, motion, steady.speed, steady.gait.period)
    style.note(ax, f"radius {radius:.4g} m, {abs(math.degrees(way.heading)):.4g}°")
    ax.legend(loc="lower right")


def _centre(steady: SteadyCycle) -> complex:
    """The point about which a period rotates the robot."""
    first, last = (complex(steady.x[i], steady.y[i]) for i in (0, -1))
    turned = np.exp(1j * (steady.psi[-1] - steady.psi[0]))
    return complex((last - turned * first) / (1 - turned))


_SAMPLES = 200_000
"""Samples of a turn that is drawn."""
_WIDEST = 20.0
"""m; wider circles are not drawn."""


def draw_chart(chart: TurnChart) -> dict[str, str]:
    """The chart as SVG text by its name; offsets below 0 are the mirror image and not drawn."""
    seen, tight = chart.seen, chart.tight
    count = len(seen.period)
    columns = min(count, 2)
    drawn = style.figure(style.WIDTH, 1.0 + 2.3 * -(-count // columns))
    axes = drawn.subplots(-(-count // columns), columns, sharex=True, sharey=True, squeeze=False)
    for j, ax in enumerate(axes.flat):
        if j >= count:
            ax.set_visible(False)
            continue
        _panel(ax, seen, j)
        if tight:
            ax.axhline(tight.radius, color=style.LIMIT, lw=1.0)
    style.note(axes[0, 0], "solid: to the left, dashed: to the right")
    if tight:
        style.note(
            axes[0, 0], f"tightest: {with_unit(tight.radius, 'm')}", y=0.1, color=style.LIMIT
        )
    for ax in axes[-1]:
        ax.set_xlabel("offset φ0, rad")
    for ax in axes[:, 0]:
        ax.set_ylabel("radius, m")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside lower center", ncols=4, title="amplitude α")
    return {"turn-chart": style.svg(drawn)}


def _panel(ax: Axes, seen: TurnMap, j: int) -> None:
    """Solid lines turn left, dashed ones right; blank where a limit is exceeded."""
    colours = mpl.colormaps["viridis"](np.linspace(0.0, 0.85, len(seen.amplitude)))
    curvature = seen.curvature[:, j]
    kept = seen.keeps[:, j] & (np.abs(curvature) > 1 / _WIDEST)
    for i, alpha in enumerate(seen.amplitude):
        label = with_unit(float(alpha), "rad", 3)
        ax.plot([], [], color=colours[i], label=label)
        for side, line in ((1, "-"), (-1, "--")):
            there = kept[i] & (side * curvature[i] > 0)
            radius = np.full(len(seen.offset), np.nan)
            radius[there] = 1 / np.abs(curvature[i][there])
            ax.plot(seen.offset, radius, line, color=colours[i], lw=1.5)
    ax.set(yscale="log", title=f"T = {with_unit(float(seen.period[j]), 's', 3)}")
