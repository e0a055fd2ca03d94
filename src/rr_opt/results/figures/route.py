"""A driven route: the path asked and driven; angle, rate, speed and torque over time."""

from __future__ import annotations

import numpy as np

from rr_opt.results.figures import style
from rr_opt.results.figures.motion import against_limit, draw_robot, instants, robot_length
from rr_opt.results.route import DrivenRoute


def draw_route(result: DrivenRoute) -> dict[str, str]:
    """The way seen from above, and the drive over time."""
    if result.replay is None or result.command is None:
        return {}
    return {"way": _way(result), "drive": _drive(result)}


def _way(result: DrivenRoute) -> str:
    assert result.replay
    driven, robot = result.replay.trajectory, result.robot
    poses = [leg.at(s) for leg in result.plan.legs for s in np.linspace(0, leg.length, 100)]
    with style.styled():
        drawn = style.figure(style.WIDTH, 5.0)
        ax = drawn.subplots()
        x, y = [pose.x for pose in poses], [pose.y for pose in poses]
        ax.plot(x, y, color="#b4bdc6", lw=5, label="path asked")
        ax.plot(driven.x, driven.y, color=style.INK, lw=1.2, label="path of P, driven")
        for i in (0, *instants(driven, robot_length(robot))):
            draw_robot(ax, robot, driven, i, alpha=0.7)
        ax.set_aspect("equal", adjustable="datalim")
        ax.set(xlabel="x, m", ylabel="y, m")
        ax.legend()
        return style.svg(drawn)


def _drive(result: DrivenRoute) -> str:
    assert result.replay
    assert result.command
    driven, limits = result.replay.trajectory, result.plan.problem.limits
    with style.styled():
        drawn = style.figure(style.WIDTH, 7.0)
        axes = drawn.subplots(4, 1, sharex=True)
        against_limit(axes[0], driven.t, driven.phi, limits.angle, "φ, rad")
        against_limit(
            axes[1], driven.t, result.command.at(driven.t)[1], limits.rate, "dφ/dt, rad/s"
        )
        axes[2].plot(driven.t, driven.v, color=style.INK)
        axes[2].set_ylabel("v, m/s")
        against_limit(axes[3], driven.t, driven.torque, limits.torque, "τ, N m")
        axes[3].set_xlabel("time, s")
        axes[3].set_xlim(driven.t[0], driven.t[-1])
        drawn.align_ylabels(list(axes))
        return style.svg(drawn)
