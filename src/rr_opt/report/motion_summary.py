"""A simulated motion in some lines of text, and what of it the servo could not do."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from rr_opt.motion.rollout import Trajectory
from rr_opt.report.quantities import QUANTITIES, number, speed_text
from rr_opt.report.text import columns, gait_lines
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import Robot


def motion_summary(gait: SineGait, driven: Trajectory, start: str, files: Iterable[Path]) -> str:
    """The gait, how far it went and how fast at the end, and the files."""
    seconds = float(driven.t[-1])
    last = driven.t >= max(seconds - gait.period, 0.0)
    distance = math.hypot(driven.x[-1] - driven.x[0], driven.y[-1] - driven.y[0])
    turned = math.degrees(driven.psi[-1] - driven.psi[0])
    rows = [
        ("gait", "phi(t) = amplitude sin(2 pi t/period) + offset"),
        *gait_lines(gait),
        ("time", f"{number(seconds)} s from {'rest' if start == 'rest' else 'the steady state'}"),
        ("moved", f"{number(distance)} m, turned by {number(turned)} deg"),
        ("speed v", f"{speed_text(float(np.mean(driven.v[last])))}, mean of the last period"),
        ("torque", f"{number(float(np.abs(driven.torque).max()))} N m at most"),
        *(("files" if not i else "", str(file)) for i, file in enumerate(files)),
    ]
    return "\n".join(columns(rows)) + "\n"


def beyond_servo(robot: Robot, gait: SineGait, driven: Trajectory) -> list[str]:
    """A warning for each limit of the servo that the motion passes; the model drives it anyway."""
    reached = {
        "angle": (gait.peak_angle, robot.servo.angle_limit),
        "rate": (gait.peak_rate, robot.servo.rate_limit),
        "torque": (float(np.abs(driven.torque).max()), robot.servo.torque_limit),
    }
    return [
        f"warning: the gait needs {QUANTITIES[name].both(value)}, and the servo's {name} limit is "
        f"{QUANTITIES[name].both(limit)}. It is simulated as if the servo could."
        for name, (value, limit) in reached.items()
        if value > limit * (1 + 1e-6)
    ]
