"""What driving a given gait gives: a simulated motion, and the circle that it goes round."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

from rr_opt.documents.report import Progress, quiet
from rr_opt.formatting import QUANTITIES
from rr_opt.model.gait import Gait
from rr_opt.model.problem import LARGEST_EXCESS
from rr_opt.model.robot import Robot
from rr_opt.motion.circle import Circle, Transient
from rr_opt.motion.rollout import Measured, Trajectory
from rr_opt.motion.servo import servo_made
from rr_opt.results.ignored import ignored_effects
from rr_opt.results.result import Result

Format = Literal["csv", "netcdf"]
Film = Literal["gif", "mp4"]


@dataclass(frozen=True, repr=False)
class GaitResult(Result):
    """What comes of driving a gait.

    source_status  of the result that the gait was taken from; None if it was not taken from one
    """

    robot: Robot
    gait: Gait
    source_status: str | None

    @cached_property
    def joint(self) -> Gait:
        """What the servo makes of the gait."""
        return servo_made(self.robot, self.gait)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Which effects of the robot the motion ignores, and which servo limits it exceeds."""
        return (*ignored_effects(self.robot, told=True), *self.beyond_servo)

    @property
    def beyond_servo(self) -> tuple[str, ...]:
        """A sentence on each limit of the servo that the gait exceeds."""
        return ()


@dataclass(frozen=True, repr=False)
class SimulatedMotion(GaitResult):
    """A simulated motion.

    start       `rest` or `steady`
    trajectory  arrays at equal time steps: `t`, `x`, `y`, `psi`, `phi`, `v`, `torque`, SI
    measured    speed and peak torque over the last period
    """

    REPORT = "rr_opt.report.motion"

    start: str
    trajectory: Trajectory
    measured: Measured

    @property
    def beyond_servo(self) -> tuple[str, ...]:
        """A sentence on each limit of the servo that the motion exceeds; it is simulated anyway."""
        servo = self.robot.servo
        reached = {
            "angle": (self.joint.peak_angle, servo.angle_limit),
            "rate": (self.joint.peak_rate, servo.rate_limit),
            "torque": (self.measured.peak_torque, servo.torque_limit),
        }
        return tuple(
            f"The gait needs {QUANTITIES[name].both(value)}, but the servo's {name} limit is "
            f"{QUANTITIES[name].both(limit)}. The simulation ignores this limit."
            for name, (value, limit) in reached.items()
            if value > limit * (1 + LARGEST_EXCESS)
        )

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """Distance, turn, speed and torque, SI. Of the last period `last_speed` is the mean of v,
        and `last_circle_speed` the speed along its mean circle, null of a shorter motion."""
        return super().record() | {"files": [str(file) for file in files]}

    def save(
        self,
        path: str | Path,
        *,
        figures: bool = True,
        progress: Progress = quiet,
        format: Format = "csv",
        film: Film | None = None,
    ) -> list[Path]:
        """Write the trajectory, the figure and, if asked for, a film to a folder.

        Returns the files. Raises InputError for a file that cannot be made here.
        """
        options = {"figures": figures, "progress": progress, "format": format, "film": film}
        return self.report.save(self, path, **options)


@dataclass(frozen=True, repr=False)
class DrivenCircle(GaitResult):
    """The circle that a gait drives, and how a start from rest converges to it."""

    REPORT = "rr_opt.report.circle"

    circle: Circle
    transient: Transient
