"""The motion as a film: both platforms, their wheels, and the path drawn behind them."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Literal

import matplotlib as mpl
import numpy as np
from matplotlib.animation import FFMpegWriter, PillowWriter

from rr_opt.motion.rollout import Trajectory
from rr_opt.outcome import InputError
from rr_opt.report.archive import whole
from rr_opt.report.figures.robot_drawing import draw_robot, robot_length
from rr_opt.report.figures.style import GREY, colour_of, figure, styled
from rr_opt.robot.parameters import Robot

Kind = Literal["gif", "mp4"]

FRAMES_A_SECOND = {"gif": 20, "mp4": 30}
MOST_FRAMES = 1200


def check_kind(kind: Kind) -> None:
    """Raise InputError if films of this kind cannot be made on this machine."""
    if kind == "mp4" and shutil.which("ffmpeg") is None:
        raise InputError(
            "MP4 films need the program ffmpeg, which was not found. Install ffmpeg, or make a "
            "GIF with --animate gif."
        )
    if kind == "gif" and not PillowWriter.isAvailable():
        raise InputError(
            "GIF films need pillow, which is not installed. Run `pip install 'rr-opt[animate]'`."
        )


def animate(
    path: Path,
    robot: Robot,
    trajectory: Trajectory,
    kind: Kind,
    progress: Callable[[str], None] = lambda _: None,
) -> Path:
    """Write the film, in real time; a motion of many minutes is shown faster."""
    check_kind(kind)
    rate = FRAMES_A_SECOND[kind]
    count = min(max(round(rate * float(trajectory.t[-1])), 1), MOST_FRAMES)
    frames = np.linspace(0, len(trajectory.t) - 1, count + 1).round().astype(int)
    writer = {"gif": PillowWriter, "mp4": FFMpegWriter}[kind](fps=rate)
    with styled(), whole(path) as temporary, mpl.rc_context({"savefig.bbox": None}):
        drawn = figure(7.2, _height(robot, trajectory))
        ax = drawn.add_subplot()
        _frame(ax, robot, trajectory)
        (trail,) = ax.plot([], [], color=colour_of(float(trajectory.v.mean())), lw=1.6, zorder=3)
        clock = ax.text(0.01, 0.97, "", transform=ax.transAxes, va="top", color=GREY)
        drawn.canvas.draw()
        drawn.set_layout_engine("none")
        with writer.saving(drawn, str(temporary), dpi=100):
            for number, i in enumerate(frames, 1):
                progress(f"film, frame {number} of {len(frames)}")
                trail.set_data(trajectory.x[: i + 1], trajectory.y[: i + 1])
                clock.set_text(f"t = {trajectory.t[i]:.2f} s   v = {trajectory.v[i]:+.3f} m/s")
                pose = (trajectory.x[i], trajectory.y[i], trajectory.psi[i], trajectory.phi[i])
                robot_parts = draw_robot(ax, robot, *map(float, pose))
                writer.grab_frame()
                for part in robot_parts:
                    part.remove()
    return path


def _frame(ax, robot: Robot, trajectory: Trajectory) -> None:  # noqa: ANN001
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
    return round(50 * min(max(6.4 * high / wide + 0.9, 2.6), 8.0)) / 50
