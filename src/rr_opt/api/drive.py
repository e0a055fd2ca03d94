"""A gait or a route, driven: motion, circle, set points for a controller, the drive itself."""

import warnings
from dataclasses import replace
from pathlib import Path
from typing import Literal, Protocol

from rr_opt.api.load import InputWarning, PathLike, fingerprint, load_gait, read_arguments
from rr_opt.files.route_file import read_route
from rr_opt.model.gait import Gait
from rr_opt.model.problem import LARGEST_EXCESS, Limits, Problem
from rr_opt.model.robot import Robot
from rr_opt.model.route import Route
from rr_opt.motion import setpoints
from rr_opt.motion.circle import circle_of, transient
from rr_opt.motion.dynamics import require_friction
from rr_opt.motion.rollout import measured, rollout
from rr_opt.motion.servo import servo_made
from rr_opt.motion.steady_cycle import require_regular, steady_cycle
from rr_opt.outcome import InputError
from rr_opt.results.motion import DrivenCircle, SimulatedMotion
from rr_opt.results.result import Progress, quiet
from rr_opt.results.route import DrivenRoute
from rr_opt.results.setpoints import ExportedGait, Format, text_of
from rr_opt.routing.feedback import controller, with_reserve
from rr_opt.routing.plan import plan_route
from rr_opt.routing.replay import replay


class HasGait(Protocol):
    """A result, or anything else that knows its robot and gait."""

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


def _limits_of(source: Robot | HasGait) -> Limits | None:
    """The limits that a gait was found within; None where none are known."""
    problem = getattr(source, "problem", None)
    return problem.limits if problem else getattr(source, "limits", None)


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
    rate: float | str = 125.0,
    keep_period: bool = False,
    within_limits: bool | None = None,
    progress: Progress = quiet,
) -> ExportedGait:
    """A gait as set points for a controller, and what they cost in speed.

    format       csv: time and angle; c-header: an array for C; servo: counts of the CDS5516
    rate         set points a second
    keep_period  change the rate and not the period, so that a whole number of them fits in
    within_limits  lower the amplitude until the steps between set points, as they are written,
                 are within the limits; None: where the changed period takes a gait beyond them;
                 False: never

    Raises InputError for an angle beyond the servo's counts.
    """
    source = load_gait(robot) if isinstance(robot, str | Path) else robot
    limits = _limits_of(source)
    robot, gait, status = _driven(source, gait)
    each_second = read_arguments({"rate": rate})["rate"]
    points = setpoints.set_points(gait, each_second, keep_period=keep_period)
    # Before the work, as an angle may be beyond the counts.
    text_of(points, format)
    if within_limits is not False:
        progress("limits")
        limits = limits or Problem(robot).limits
        require_friction(robot)
        require_regular(robot, servo_made(robot, gait))
        if within_limits or setpoints.excess(robot, limits, gait) <= LARGEST_EXCESS:
            strict = bool(within_limits) and format == "servo"
            points = setpoints.within_limits(robot, limits, points, rounded=strict)
    progress("what the set points cost")
    lost = setpoints.cost(robot, points, rounded=format == "servo")
    return ExportedGait(robot, gait, status, points, lost, format)


def load_route(path: PathLike) -> Route:
    """The route of a file. Warns with InputWarning of what looks wrong.

    Raises InputError with everything that is wrong in it and in its problem.
    """
    route, issues = read_route(path)
    for issue in issues:
        warnings.warn(str(issue), InputWarning, stacklevel=2)
    return route


def route(
    asked: Route | PathLike, *, feedback: bool = False, progress: Progress = quiet
) -> DrivenRoute:
    """The fastest drive found along a route, from rest, checked by simulation.

    feedback  also the controller that keeps the robot on it; the drive is a little slower, as
              corrections need room

    Raises InputError for a robot without friction, and for a route without pieces.
    """
    if isinstance(asked, str | Path):
        asked = load_route(asked)
    plan = plan_route(with_reserve(asked) if feedback else asked, progress)
    plan = replace(plan, route=asked)
    check = control = None
    if plan.drive:
        progress("replay by CVODES")
        command = plan.drive.command
        check = replay(plan.problem, command, asked.start, plan.legs, plan.turned, plan.heading)
        if feedback:
            progress("feedback")
            control = controller(plan, replace(plan.problem, limits=asked.problem.limits))
    return DrivenRoute(
        asked.name, asked.sha256 or fingerprint(asked), plan, check, feedback=control
    )
