"""Shapes of gait beside one another: the angle, its rate, and the speed that each gives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from rr_opt.answers.shapes import ShapesAnswer, family
from rr_opt.model.gait import Gait
from rr_opt.report.figures.style import BACKWARD, FORWARD, GREY, INK, LIMIT, figure, styled, svg

_SAMPLES = 1500
_SHADES = (0.35, 0.55, 0.75, 1.0)


@dataclass(frozen=True)
class Line:
    """A family: its name, its best gait, its signed speed (m/s) and that over the sine's."""

    label: str
    gait: Gait
    speed: float
    gain: float


def draw(compared: ShapesAnswer) -> str:
    """The figure as SVG text; empty if no family has an optimum."""
    lines = [
        Line(family(one), one.optimum.best.gait, one.speed or 0.0, compared.gain(one) or 0.0)
        for one in compared.solved
        if one.optimum.best
    ]
    if not lines:
        return ""
    with styled():
        drawn = figure(8.6, 4.2)
        axes = drawn.subplot_mosaic([["angle", "speed"], ["rate", "speed"]], width_ratios=[1.1, 1])
        in_order = [axes[name] for name in ("angle", "rate", "speed")]
        shapes(in_order, lines, compared.answers[0].optimum.problem.limits.rate)
        return svg(drawn)


def shapes(axes: Sequence[Axes], lines: Sequence[Line], rate_limit: float) -> Sequence[Axes]:
    """Fill three axes: phi (rad) and its rate (rad/s) over the phase, and a bar for each speed."""
    phase = np.linspace(0, 1, _SAMPLES)
    for line, shade in zip(lines, _SHADES[-len(lines) :], strict=True):
        colour = FORWARD if line.speed >= 0 else BACKWARD
        colour = GREY if line is lines[0] else colour
        style = {"color": colour, "alpha": shade if line is not lines[0] else 1.0}
        style |= {"ls": (0, (5, 2)) if line is lines[0] else "-"}
        t = phase * line.gait.period
        axes[0].plot(phase, line.gait.angle(t), **style)
        axes[1].plot(phase, line.gait.rate(t), **style)
    for sign in (1, -1):
        if np.isfinite(rate_limit):
            axes[1].axhline(sign * rate_limit, color=LIMIT, lw=1.2, ls=(0, (4, 2)))
    axes[0].set_ylabel("φ, rad")
    axes[1].set_ylabel("dφ/dt, rad/s")
    axes[1].set_xlabel("share of the period")
    for ax in axes[:2]:
        ax.set_xlim(0, 1)
    _bars(axes[2], lines)
    return axes


def _bars(ax: Axes, lines: Sequence[Line]) -> None:
    top = max(1e3 * abs(line.speed) for line in lines)
    for place, (line, shade) in enumerate(zip(lines, _SHADES[-len(lines) :], strict=True)):
        size = 1e3 * abs(line.speed)
        first = line is lines[0]
        colour = GREY if first else FORWARD if line.speed >= 0 else BACKWARD
        ax.barh(place, size, height=0.62, color=colour, alpha=1.0 if first else shade)
        gain = "" if first else f"  {100 * line.gain:+.0f} %"
        ax.text(size + 0.02 * top, place, f"{size:.0f} mm/s{gain}", va="center", color=INK)
    ax.set_yticks(range(len(lines)), [line.label for line in lines])
    ax.set_ylim(len(lines) - 0.4, -0.6)
    ax.set_xlim(0, 1.5 * top)
    ax.grid(axis="y", visible=False)
    ax.spines["left"].set_visible(False)
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("speed of the best gait, mm/s")
