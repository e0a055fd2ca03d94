"""The figures of a turn: those of a fastest gait, with the circle that was asked for."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes

from rr_opt.motion.rollout import Trajectory, repeated
from rr_opt.report.figures import fastest, style
from rr_opt.report.figures.path import path
from rr_opt.results.turn import FastestTurn


def draw(turn: FastestTurn) -> dict[str, str]:
    """Draw all figures; none if there is no turn to show."""
    drawn = fastest.draw(turn)
    if drawn and turn.arc is not None and math.isfinite(turn.radius or math.inf):
        drawn["path"] = style.panel(4.8, lambda ax: arc(ax, turn))
    return drawn


def arc(ax: Axes, turn: FastestTurn) -> Axes:
    """The circle, dashed; the arc of the turn as a band with its ends marked; the path of P, m."""
    way, replay, radius = turn.arc, turn.replay, turn.radius
    if way is None or replay is None or radius is None:
        return ax
    steady = replay.steady
    motion = repeated(steady, max(1, math.ceil(way.periods - 1e-9)))
    centre = _centre(motion, len(steady.t) - 1)
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
    return ax


def _centre(motion: Trajectory, period: int) -> complex:
    """The point about which one period, of that many steps, rotates the robot."""
    first, last = (complex(motion.x[i], motion.y[i]) for i in (0, period))
    turned = np.exp(1j * (motion.psi[period] - motion.psi[0]))
    return complex((last - turned * first) / (1 - turned))
