"""What following set points costs in speed."""

from __future__ import annotations

import math
from dataclasses import dataclass

from rr_opt.motion.regular import require_regular
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.physics.dynamics import require_friction
from rr_opt.report.setpoints.setpoints import SetPoints, held
from rr_opt.robot.parameters import Robot


@dataclass(frozen=True)
class Cost:
    """Signed speeds, m/s: of the gait; with its period changed; with its set points held; and with
    them rounded to counts too (None if they are not)."""

    asked: float
    changed: float
    held: float
    rounded: float | None

    @property
    def left(self) -> float:
        """What is left of the speed in the end."""
        return self.held if self.rounded is None else self.rounded

    @property
    def steps(self) -> dict[str, float]:
        """What each step adds to the speed, m/s; below 0 where the robot gets slower."""
        sign = math.copysign(1.0, self.asked)
        steps = {
            "period": sign * (self.changed - self.asked),
            "holding": sign * (self.held - self.changed),
        }
        if self.rounded is not None:
            steps["rounding"] = sign * (self.rounded - self.held)
        return steps


def cost(robot: Robot, points: SetPoints, *, rounded: bool) -> Cost:
    """What each step from the gait to its set points does to the speed.

    Raises InputError for angles beyond the servo's counts, a robot without friction or a gait
    through the singular posture; NotConvergedError for a gait that does not settle.
    """
    require_friction(robot)
    require_regular(robot, points.gait)
    angles = [points.angles, *([points.rounded] if rounded else [])]
    driven = [points.gait, points.played, *(held(each, points.rate) for each in angles)]
    asked, changed, plain, *rest = (steady_cycle(robot, gait).speed for gait in driven)
    return Cost(asked, changed, plain, rest[0] if rest else None)
