"""A simulated motion in some lines of text, and what of it the servo could not do."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.files.gait_record import gait_record
from rr_opt.motion.rollout import Trajectory
from rr_opt.report.quantities import QUANTITIES, number, speed_text
from rr_opt.report.text import columns, gait_formula, gait_lines
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import Robot

EXCEEDED = 1e-4
"""By so much, relative, an optimum on a limit may be past it without a warning."""


def motion_summary(gait: Gait, driven: Trajectory, start: str, files: Iterable[Path]) -> str:
    """The gait, how far it went and how fast at the end, and the files."""
    record = motion_record(gait, driven, start, files)
    begun = "rest" if start == "rest" else "the steady state"
    degrees = math.degrees(record["turned"])
    rows = [
        ("gait", gait_formula(gait)),
        *gait_lines(gait),
        (
            "time",
            f"{number(record['seconds'])} s from {begun}",
        ),
        (
            "moved",
            f"{number(record['distance'])} m, turned by {number(degrees)} deg",
        ),
        ("speed v", f"{speed_text(record['last_speed'])}, mean of the last period"),
        ("torque", f"{number(record['peak_torque'])} N m at most"),
        *(("files" if not i else "", str(file)) for i, file in enumerate(files)),
    ]
    return "\n".join(columns(rows)) + "\n"


def motion_record(
    gait: Gait, driven: Trajectory, start: str, files: Iterable[Path]
) -> dict[str, Any]:
    """The same for scripts: SI; `last_speed` is the mean of v over the last period."""
    seconds = float(driven.t[-1])
    last = driven.t >= max(seconds - gait.period, 0.0)
    return {
        "gait": gait_record(gait),
        "start": start,
        "seconds": seconds,
        "distance": math.hypot(driven.x[-1] - driven.x[0], driven.y[-1] - driven.y[0]),
        "turned": float(driven.psi[-1] - driven.psi[0]),
        "last_speed": float(np.mean(driven.v[last])),
        "peak_torque": float(np.abs(driven.torque).max()),
        "files": [str(file) for file in files],
    }


def beyond_servo(robot: Robot, gait: Gait, driven: Trajectory) -> list[str]:
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
        if value > limit * (1 + EXCEEDED)
    ]
