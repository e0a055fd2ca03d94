"""What a given gait does: a simulated motion, its circle, its set points and their cost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from rr_opt.answers.answer import Answer, ignored_effects
from rr_opt.answers.quantities import QUANTITIES
from rr_opt.model.gait import Gait
from rr_opt.model.problem import LARGEST_EXCESS
from rr_opt.model.robot import Robot
from rr_opt.motion.circle import Circle, Transient
from rr_opt.motion.rollout import Measured, Trajectory
from rr_opt.motion.setpoints import Cost, SetPoints, interpolated

Format = Literal["csv", "c-header", "servo"]


@dataclass(frozen=True)
class GaitAnswer(Answer):
    """What comes of driving a gait.

    source_status  of the result that the gait was taken from; None if it was not taken from one
    """

    robot: Robot
    gait: Gait
    source_status: str | None

    @property
    def warnings(self) -> tuple[str, ...]:
        """Which effects of the robot the motion ignores, and which servo limits it exceeds."""
        return (*ignored_effects(self.robot), *self.beyond_servo)

    @property
    def beyond_servo(self) -> tuple[str, ...]:
        """A sentence on each limit of the servo that the gait exceeds."""
        return ()


@dataclass(frozen=True)
class MotionAnswer(GaitAnswer):
    """A gait that was simulated.

    start       `rest` or `steady`
    trajectory  the motion at equal time steps
    measured    what it amounts to over its last period
    """

    start: str
    trajectory: Trajectory
    measured: Measured

    @property
    def beyond_servo(self) -> tuple[str, ...]:
        """A sentence on each limit of the servo that the motion exceeds; it is simulated anyway."""
        servo = self.robot.servo
        reached = {
            "angle": (self.gait.peak_angle, servo.angle_limit),
            "rate": (self.gait.peak_rate, servo.rate_limit),
            "torque": (self.measured.peak_torque, servo.torque_limit),
        }
        return tuple(
            f"The gait needs {QUANTITIES[name].both(value)}, and the servo's {name} limit is "
            f"{QUANTITIES[name].both(limit)}. It is simulated as if the servo could."
            for name, (value, limit) in reached.items()
            if value > limit * (1 + LARGEST_EXCESS)
        )


@dataclass(frozen=True)
class CircleAnswer(GaitAnswer):
    """The circle that a gait drives, and how a start from rest converges to it."""

    circle: Circle
    transient: Transient


@dataclass(frozen=True)
class SetPointsAnswer(GaitAnswer):
    """A gait as set points for a controller, and what they cost in speed."""

    points: SetPoints
    cost: Cost
    format: Format

    @property
    def beyond_servo(self) -> tuple[str, ...]:
        """A sentence if the servo is too slow for the steps between set points."""
        angles = self.points.rounded if self.format == "servo" else self.points.angles
        needed, limit = (
            interpolated(angles, self.points.rate).peak_rate,
            self.robot.servo.rate_limit,
        )
        if needed <= limit * (1 + LARGEST_EXCESS):
            return ()
        both = QUANTITIES["rate"].both
        return (
            f"A step between set points needs {both(needed)}, and the servo's rate limit is "
            f"{both(limit)}. The cost in speed is computed as if the servo could.",
        )
