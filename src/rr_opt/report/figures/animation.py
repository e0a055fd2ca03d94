"""The motion as pictures: both platforms, their wheels, and the path drawn behind them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from numpy.typing import NDArray

from rr_opt.motion.rollout import Trajectory
from rr_opt.report.figures.robot_drawing import draw_robot, robot_length
from rr_opt.report.figures.style import GREY, colour_of, figure, styled
from rr_opt.robot.parameters import Robot

_WIDTH, _DPI = 7.2, 100


def frames(robot: Robot, trajectory: Trajectory, chosen: NDArray[np.int_]) -> Iterator[NDArray]:
    """A picture (height, width, 3) of 8-bit colours for each of the chosen instants.

    Axes and grid are drawn once; only what moves is drawn again.
    """
    with styled():
        drawn = figure(_WIDTH, _height(robot, trajectory))
        drawn.set_dpi(_DPI)
        canvas = FigureCanvasAgg(drawn)
        ax = drawn.add_subplot()
        _view(ax, robot, trajectory)
        canvas.draw()
        drawn.set_layout_engine("none")
        still = canvas.copy_from_bbox(drawn.bbox)
        (trail,) = ax.plot([], [], color=colour_of(float(trajectory.v.mean())), lw=1.6)
        clock = ax.text(0.01, 0.97, "", transform=ax.transAxes, va="top", color=GREY)
        for i in chosen:
            trail.set_data(trajectory.x[: i + 1], trajectory.y[: i + 1])
            clock.set_text(f"t = {trajectory.t[i]:.2f} s   v = {trajectory.v[i]:+.3f} m/s")
            parts = draw_robot(ax, robot, trajectory, i)
            canvas.restore_region(still)
            for artist in (trail, *parts, clock):
                ax.draw_artist(artist)
            yield np.asarray(canvas.buffer_rgba())[..., :3].copy()
            for part in parts:
                part.remove()


def _view(ax: Axes, robot: Robot, trajectory: Trajectory) -> None:
    margin = 0.75 * robot_length(robot)
    ax.set_xlim(trajectory.x.min() - margin, trajectory.x.max() + margin)
    ax.set_ylim(trajectory.y.min() - margin, trajectory.y.max() + margin)
    ax.set_aspect("equal")
    ax.set_xlabel("x, m")
    ax.set_ylabel("y, m")


def _height(robot: Robot, trajectory: Trajectory) -> float:
    """Inches that suit the path's shape; an even number of pixels, as video needs."""
    margin = 1.5 * robot_length(robot)
    wide, high = np.ptp(trajectory.x) + margin, np.ptp(trajectory.y) + margin
    return round(_DPI / 2 * min(max((_WIDTH - 0.8) * high / wide + 0.9, 2.6), 8.0)) / (_DPI / 2)
