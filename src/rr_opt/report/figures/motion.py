"""A simulated motion: its path, and angle, speed and torque over time."""

from __future__ import annotations

from rr_opt.report.figures import style
from rr_opt.report.figures.cycle import against_limit
from rr_opt.report.figures.path import path
from rr_opt.results.motion import SimulatedMotion


def draw(motion: SimulatedMotion) -> dict[str, str]:
    """Four axes, top to bottom: path (m), phi (rad), v (m/s), torque (N m)."""
    robot, trajectory = motion.robot, motion.trajectory
    with style.styled():
        drawn = style.figure(style.WIDTH, 8.0)
        axes = drawn.subplots(4, 1, gridspec_kw={"height_ratios": [2.4, 1, 1, 1]})
        path(axes[0], robot, trajectory, float(trajectory.v.mean()), motion.gait.period)
        axes[0].set_title("The path of P, and the robot at a few instants")
        t = trajectory.t
        against_limit(axes[1], t, trajectory.phi, robot.servo.angle_limit, "φ, rad")
        axes[2].plot(t, trajectory.v, color=style.INK)
        axes[2].set_ylabel("v, m/s")
        against_limit(axes[3], t, trajectory.torque, robot.servo.torque_limit, "τ, N m")
        for ax in axes[1:]:
            ax.set_xlim(t[0], t[-1])
        for ax in axes[1:3]:
            ax.sharex(axes[3])
            ax.tick_params(labelbottom=False)
        axes[3].set_xlabel("time, s")
        drawn.align_ylabels(list(axes[1:]))
        return {"motion": style.svg(drawn)}
