"""What stays the same over the starts of one problem: the robot, its model, its ballast."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from rr_opt.design.decisions import Decisions
from rr_opt.design.landscape import Landscape
from rr_opt.physics.dynamics import Dynamics, dynamics_of
from rr_opt.problem import Interval, Problem
from rr_opt.robot.ballast import Loads, with_load_count
from rr_opt.robot.parameters import Robot


@dataclass(frozen=True)
class Setting:
    """A problem, ready to be solved from any start.

    ballast      range of I2 (kg m2) or of the number of loads
    fixed_share  where in it the ballast is fixed to a whole number of loads
    """

    problem: Problem
    dynamics: Dynamics
    landscape: Landscape
    ballast: Interval
    fixed_share: float | None = None


def settings_of(problem: Problem, box: Decisions) -> list[Setting]:
    """One setting, or one for each whole number of loads."""
    choice = problem.inertia_ratio
    by, loads = (choice.by, choice.loads) if choice else ("inertia", Loads())
    dynamics = dynamics_of(problem.robot)
    low, high = box.ballast.low, box.ballast.high
    landscape = Landscape(dynamics, problem.robot, by, loads, box.ballast)
    setting = Setting(problem, dynamics, landscape, box.ballast)
    if not (by == "loads" and loads.whole):
        return [setting]
    counts = range(math.ceil(low - 1e-9), math.floor(high + 1e-9) + 1)
    width = (high - low) or 1.0
    return [replace(setting, fixed_share=(count - low) / width) for count in counts]


def scanned(setting: Setting, box: Decisions) -> Decisions:
    """The box to scan: with a whole number of loads the ballast is not free."""
    if setting.fixed_share is None:
        return box
    count = box.ballast.low + setting.fixed_share * (box.ballast.high - box.ballast.low)
    return replace(box, ballast=Interval(count, count))


def robot_of(setting: Setting, share: float) -> Robot:
    """The problem's robot with the ballast at this share of its range."""
    robot, choice, ballast = setting.problem.robot, setting.problem.inertia_ratio, setting.ballast
    amount = ballast.low + share * (ballast.high - ballast.low)
    if choice and choice.by == "loads":
        return replace(robot, platform2=with_load_count(robot.platform2, choice.loads, amount))
    return replace(robot, platform2=replace(robot.platform2, I=amount))
