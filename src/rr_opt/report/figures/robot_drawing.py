"""The robot seen from above: two platforms, their axles and wheels, and the joint P."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon
from numpy.typing import ArrayLike, NDArray

from rr_opt.motion.rollout import Trajectory
from rr_opt.report.figures.style import INK, PAPER, PLATFORM1, PLATFORM2, WHEEL
from rr_opt.robot.parameters import Platform, Robot

Array = NDArray[np.float64]


def robot_length(robot: Robot) -> float:
    """From the wheels of platform 1 to those of platform 2 when stretched, m."""
    return robot.platform1.c + robot.platform2.c + 2 * robot.h


def draw_robot(ax: Axes, robot: Robot, motion: Trajectory, i: int, *, alpha: float = 1.0) -> list:
    """Draw the robot at instant i of a motion, less opaque with a smaller alpha.

    Returns the artists, in order, so that an animation can take them away again.
    """
    x, y, psi, phi = (float(part[i]) for part in (motion.x, motion.y, motion.psi, motion.phi))
    joint = np.array([x, y])
    artists = []
    for platform, angle, way, colour in (
        (robot.platform1, psi, 1.0, PLATFORM1),
        (robot.platform2, psi + phi, -1.0, PLATFORM2),
    ):
        artists += _platform(
            ax, platform, robot.h, _Axis(joint, angle, way), colour=colour, alpha=alpha
        )
    size = 0.16 * min(robot.platform1.b, robot.platform2.b) + 0.003
    dot = Circle((x, y), size, facecolor=PAPER, edgecolor=INK, linewidth=1.1, alpha=alpha, zorder=6)
    return [*artists, ax.add_patch(dot)]


@dataclass(frozen=True)
class _Axis:
    """A platform's axis: it starts at the joint (m), at an angle (rad); `way` is +1 if the axle
    lies ahead of P on it, -1 if behind."""

    joint: Array
    angle: float
    way: float

    def place(self, along: ArrayLike, across: ArrayLike) -> Array:
        """Points (..., 2) at distances along the axis and to its left, m."""
        e = np.array([np.cos(self.angle), np.sin(self.angle)])
        n = np.array([-e[1], e[0]])
        return self.joint + np.multiply.outer(along, e) + np.multiply.outer(across, n)


def _platform(
    ax: Axes, platform: Platform, h: float, axis: _Axis, *, colour: str, alpha: float
) -> list:
    b, c, way, place = platform.b, platform.c, axis.way, axis.place
    end = way * (c + 0.35 * h)
    start = -way * 0.25 * b
    body = place([start, end, end, start], 0.72 * b * np.array([0.55, 1, -1, -0.55]))
    artists: list = [
        ax.add_patch(
            Polygon(body, facecolor=colour, edgecolor=colour, alpha=0.55 * alpha, zorder=4)
        ),
        ax.add_patch(
            Polygon(body, fill=False, edgecolor=colour, linewidth=1.2, alpha=alpha, zorder=5)
        ),
    ]
    axle = place([way * c, way * c], [-b, b])
    artists += ax.plot(axle[:, 0], axle[:, 1], color=WHEEL, lw=1.2, alpha=alpha, zorder=5)
    half = 0.16 * b + 0.001
    for side in (-b, b):
        along = way * c + h * np.array([-1, 1, 1, -1])
        wheel = place(along, side + half * np.array([-1, -1, 1, 1]))
        artists.append(
            ax.add_patch(Polygon(wheel, facecolor=WHEEL, edgecolor="none", alpha=alpha, zorder=5))
        )
    return artists
