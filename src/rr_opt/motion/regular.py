"""Gaits that keep clear of the singular posture."""

from __future__ import annotations

from rr_opt.outcome import InputError
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import Robot


def require_regular(robot: Robot, gait: Gait) -> None:
    """Raise InputError for a gait that reaches the singular posture."""
    if gait.peak_angle >= robot.singular_angle:
        raise InputError(
            f"The gait reaches |phi| = {gait.peak_angle:.4g} rad. The robot is singular at "
            f"{robot.singular_angle:.4g} rad, where both axles point at one centre and no motion "
            "without side slip exists. Lower the amplitude or the offset."
        )
