"""The path of P over some cycles, with the robot drawn at a few instants."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from rr_opt.motion.cycle import Cycle
from rr_opt.motion.rollout import Trajectory
from rr_opt.report.figures.robot_drawing import draw_robot, robot_length
from rr_opt.report.figures.style import colour_of
from rr_opt.robot.parameters import Robot

Array = NDArray[np.float64]


def cycles_to_show(robot: Robot, cycle: Cycle) -> int:
    """So many that the robot moves by some of its lengths, or once round its circle."""
    wanted = 3.0 * robot_length(robot)
    step = max(abs(cycle.speed) * cycle.period, 1e-9)
    count = math.ceil(wanted / step)
    if abs(cycle.dpsi) > 1e-6:
        count = min(count, math.ceil(2 * math.pi / abs(cycle.dpsi)))
    return min(max(count, 2), 24)


def path(ax: Axes, robot: Robot, motion: Trajectory, speed: float, period: float) -> Axes:
    """The path of P (m) and the robot at its last instant and at some before.

    motion: turned as it should be drawn; speed: signed, m/s, gives the colour; period: of the
    gait, s, over which the arrow takes its direction.
    """
    ax.plot(motion.x, motion.y, color=colour_of(speed), lw=1.6, zorder=3, label="path of P")
    chosen = instants(motion, robot_length(robot))
    for order, i in enumerate(chosen):
        alpha = 1.0 - 0.65 * (len(chosen) - 1 - order) / max(len(chosen) - 1, 1)
        draw_robot(ax, robot, motion, i, alpha=alpha)
    _arrow(ax, robot, motion, speed, period)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.06)
    ax.set_xlabel("x, m")
    ax.set_ylabel("y, m")
    return ax


def instants(motion: Trajectory, length: float) -> list[int]:
    """Indices of poses at least 1.3 robot lengths apart, the last among them."""
    last = len(motion.x) - 1
    chosen = [last]
    for i in range(last - 1, -1, -1):
        near = [math.hypot(motion.x[i] - motion.x[j], motion.y[i] - motion.y[j]) for j in chosen]
        if min(near) >= 1.3 * length:
            chosen.append(i)
    return chosen[::-1]


def along_travel(motion: Trajectory) -> Trajectory:
    """The motion turned so that it leads along x from the origin."""
    dx, dy = motion.x - motion.x[0], motion.y - motion.y[0]
    angle = math.atan2(dy[-1], dx[-1])
    cos, sin = math.cos(angle), math.sin(angle)
    return Trajectory(
        t=motion.t,
        x=cos * dx + sin * dy,
        y=cos * dy - sin * dx,
        psi=motion.psi - angle,
        phi=motion.phi,
        v=motion.v,
        torque=motion.torque,
    )


def _arrow(ax: Axes, robot: Robot, motion: Trajectory, speed: float, period: float) -> None:
    """Which way it goes, ahead of the last pose."""
    before = int(np.searchsorted(motion.t, motion.t[-1] - period * (1 + 1e-9)))
    last = np.array([motion.x[-1], motion.y[-1]])
    step = last - np.array([motion.x[before], motion.y[before]])
    size = math.hypot(*step)
    if size < 1e-6:
        return
    leading = robot.platform1 if speed > 0 else robot.platform2
    start = last + step / size * (leading.c + 3 * robot.h)
    end = start + step / size * 0.3 * robot_length(robot)
    style = {"arrowstyle": "-|>", "color": colour_of(speed), "lw": 2.0, "mutation_scale": 14}
    ax.annotate("", tuple(end), tuple(start), arrowprops=style)
    ax.update_datalim([tuple(end)])
