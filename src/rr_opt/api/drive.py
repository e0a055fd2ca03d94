"""A gait, driven: its motion, its circle, its set points for a controller."""

from pathlib import Path
from typing import Literal, Protocol

from rr_opt.api.load import PathLike, load_gait, read_arguments
from rr_opt.model.gait import Gait
from rr_opt.model.problem import Problem
from rr_opt.model.robot import Robot
from rr_opt.motion import setpoints
from rr_opt.motion.circle import circle_of, transient
from rr_opt.motion.dynamics import require_friction
from rr_opt.motion.rollout import measured, rollout
from rr_opt.motion.servo import servo_made
from rr_opt.motion.steady_cycle import require_regular, steady_cycle
from rr_opt.outcome import InputError
from rr_opt.results.motion import DrivenCircle, SimulatedMotion
from rr_opt.results.result import Progress, quiet
from rr_opt.results.setpoints import ExportedGait, Format, text_of


class HasGait(Protocol):
    """A result, or any other object with a robot and a gait."""

    @property
    def robot(self) -> Robot:
        """The robot."""
        ...

    @property
    def gait(self) -> Gait | None:
        """Its gait; None if none was found."""
        ...


def _driven(robot: Robot | HasGait | PathLike, gait: Gait | None) -> tuple[Robot, Gait, str | None]:
    """Robot, gait, and the status of the result that the gait is from."""
    if isinstance(robot, str | Path):
        robot = load_gait(robot)
    if isinstance(robot, Robot):
        if gait is None:
            raise InputError("Read a robot without a gait. Expected both. Give for example "
                             "`SineGait('30 deg', '1.2 s')`, or a result.")  # fmt: skip
        return robot, gait, None
    if gait is not None:
        return robot.robot, gait, None
    if robot.gait is None:
        raise InputError("Read a result without a gait. Expected the result of a problem that was "
                         "solved.")  # fmt: skip
    status = getattr(robot, "status", None)
    return robot.robot, robot.gait, None if status is None else str(status)


def simulate(
    robot: Robot | HasGait | PathLike,
    gait: Gait | None = None,
    seconds: float | str = 10.0,
    *,
    start: Literal["rest", "steady"] = "rest",
    rate: float | str = 100.0,
    progress: Progress = quiet,
) -> SimulatedMotion:
    """A gait driven for some time, from rest or from the speed that it settles to.

    robot  or a result or its file, whose own gait is then driven unless another is given
    rate   samples a second

    Numbers are SI, text has a unit. Raises InputError for a gait through a singular posture, and
    for the steady start of a robot without friction.
    """
    robot, gait, status = _driven(robot, gait)
    read = read_arguments({"seconds": seconds, "rate": rate})
    progress("simulate by CVODES")
    joint = servo_made(robot, gait)
    driven = rollout(robot, joint, read["seconds"], start, read["rate"])
    progress("measure")
    return SimulatedMotion(robot, gait, status, start, driven, measured(robot, joint, driven))


def circle(
    robot: Robot | HasGait | PathLike, gait: Gait | None = None, *, progress: Progress = quiet
) -> DrivenCircle:
    """The circle of a gait: radius, centre, speed, time for a full turn; left is positive.

    Raises InputError for a robot without friction, and for a gait through a singular posture.
    """
    robot, gait, status = _driven(robot, gait)
    require_friction(robot)
    joint = servo_made(robot, gait)
    require_regular(robot, joint)
    progress("steady cycle")
    steady = steady_cycle(robot, joint)
    return DrivenCircle(robot, gait, status, circle_of(steady.cycle), transient(robot, steady))


def export(
    robot: Robot | HasGait | PathLike,
    gait: Gait | None = None,
    *,
    format: Format = "csv",
    rate: float | str | None = None,
    keep_period: bool = False,
    within_limits: bool = True,
    progress: Progress = quiet,
) -> ExportedGait:
    """A gait as set points for a controller, and what they cost in speed.

    format       csv: time and angle; c-header: an array for C; servo: counts of the CDS5516
    rate         set points a second; None: 125 or, for the servo's counts, the highest rate
                 below that for which the rate limit is a whole number of counts per step
    keep_period  adjust the rate, not the period, to a whole number of set points per period
    within_limits  lower the amplitude until the gait and the steps between the set points, as
                     written, are within the limits

    Raises InputError for an angle beyond the servo's counts, and if no amplitude is within the
    limits.
    """
    source = load_gait(robot) if isinstance(robot, str | Path) else robot
    # The limits of the problem that the gait solves, if known.
    problem = getattr(source, "problem", None)
    limits = problem.limits if problem else getattr(source, "limits", None)
    robot, gait, status = _driven(source, gait)
    limits = limits or Problem(robot).limits
    if rate is None:
        each_second = setpoints.usual_rate(*([limits.rate] if format == "servo" else []))
    else:
        each_second = read_arguments({"rate": rate})["rate"]
    points = setpoints.set_points(gait, each_second, keep_period=keep_period)
    # Done first, as an angle may be beyond the counts.
    text_of(points, format)
    if within_limits:
        progress("limits")
        require_friction(robot)
        require_regular(robot, servo_made(robot, gait))
        points = setpoints.within_limits(robot, limits, points, rounded=format == "servo")
    progress("what the set points cost")
    lost = setpoints.cost(robot, points, rounded=format == "servo")
    return ExportedGait(robot, gait, status, points, lost, format)
