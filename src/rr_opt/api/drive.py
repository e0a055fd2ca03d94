"""A gait or a route, driven: motion, circle, set points for a controller, the drive itself."""

import time
import warnings
from collections.abc import Mapping
from contextlib import ExitStack, closing
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal, Protocol, TypeVar

from rr_opt.api.load import InputWarning, PathLike, fingerprint, load_gait, read_arguments
from rr_opt.batch.journal import JOURNAL, Journal
from rr_opt.batch.run import pool_of, run
from rr_opt.design.study.case import portable
from rr_opt.documents.archive import folder_for_results
from rr_opt.files.issue import Issue
from rr_opt.files.route_file import read_route
from rr_opt.files.route_study_file import RouteStudy, read_routes
from rr_opt.model.gait import Gait
from rr_opt.model.problem import Limits, Problem
from rr_opt.model.robot import Robot
from rr_opt.model.route import Route
from rr_opt.motion import setpoints
from rr_opt.motion.circle import circle_of, transient
from rr_opt.motion.dynamics import require_friction
from rr_opt.motion.rollout import measured, rollout
from rr_opt.motion.servo import servo_made
from rr_opt.motion.steady_cycle import require_regular, steady_cycle
from rr_opt.outcome import InputError, RollerRacerError, Status
from rr_opt.results.motion import DrivenCircle, SimulatedMotion
from rr_opt.results.result import Progress, quiet
from rr_opt.results.route import DrivenRoute
from rr_opt.results.routes import DrivenRoutes
from rr_opt.results.setpoints import ExportedGait, Format, text_of
from rr_opt.routing.feedback import controller, with_reserve
from rr_opt.routing.plan import plan_route
from rr_opt.routing.replay import replay
from rr_opt.version import __version__

Read = TypeVar("Read")


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
    rate: float | str | None = None,
    keep_period: bool = False,
    within_limits: bool = True,
    progress: Progress = quiet,
) -> ExportedGait:
    """A gait as set points for a controller, and what they cost in speed.

    format       csv: time and angle; c-header: an array for C; servo: counts of the CDS5516
    rate         set points a second; None: 125 or, for the servo's counts, the most below that at
                 which the largest step of a whole number of counts is the limit of the rate
    keep_period  change the rate and not the period, so that a whole number of them fits in
    within_limits  lower the amplitude until the gait and the steps between set points, as they
                 are written, are within the limits

    Raises InputError for an angle beyond the servo's counts, and where no amplitude is within the
    limits.
    """
    source = load_gait(robot) if isinstance(robot, str | Path) else robot
    limits = _limits_of(source)
    robot, gait, status = _driven(source, gait)
    limits = limits or Problem(robot).limits
    if rate is None:
        each_second = setpoints.usual_rate(*([limits.rate] if format == "servo" else []))
    else:
        each_second = read_arguments({"rate": rate})["rate"]
    points = setpoints.set_points(gait, each_second, keep_period=keep_period)
    # Before the work, as an angle may be beyond the counts.
    text_of(points, format)
    if within_limits:
        progress("limits")
        require_friction(robot)
        require_regular(robot, servo_made(robot, gait))
        points = setpoints.within_limits(robot, limits, points, rounded=format == "servo")
    progress("what the set points cost")
    lost = setpoints.cost(robot, points, rounded=format == "servo")
    return ExportedGait(robot, gait, status, points, lost, format)


def load_route(path: PathLike) -> Route:
    """The route of a file. Warns with InputWarning of what looks wrong.

    Raises InputError with everything that is wrong in it and in its problem.
    """
    return _warned(*read_route(path))


def load_routes(path: PathLike) -> RouteStudy:
    """The routes that a study file names. Warns with InputWarning of what looks wrong.

    Raises InputError with everything that is wrong in any of them.
    """
    return _warned(*read_routes(path))


def _warned(read: Read, issues: list[Issue]) -> Read:
    for issue in issues:
        warnings.warn(str(issue), InputWarning, stacklevel=3)
    return read


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
    plan = plan_route(with_reserve(asked) if feedback else asked, progress, creeps=feedback)
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


def routes(
    asked: RouteStudy | PathLike,
    *,
    folder: PathLike | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    restart: bool = False,
    progress: Progress = quiet,
) -> DrivenRoutes:
    """Drive every route of a study, or of a study file, each on a process of its own.

    Parameters as in `study`. Raises InputError for a folder with the rows of another study.
    """
    if not isinstance(asked, RouteStudy):
        asked = load_routes(asked)
    total, rows = len(asked.routes), dict[int, dict[str, Any]]()
    with ExitStack() as stack:
        journal = None
        if folder is not None:
            path = folder_for_results(Path(folder)) / JOURNAL
            identity = {"input_sha256": asked.sha256, "version": __version__}
            journal = Journal(path, identity, read=_row, cases=total, restart=restart)
            rows = dict(stack.enter_context(journal).rows)
        left = {case: route for case, route in enumerate(asked.routes) if case not in rows}
        if left:
            progress(f"route {len(rows) + 1} of {total}")
            pool = stack.enter_context(closing(pool_of(workers, scheduler)))
            sent = {k: replace(one, problem=portable(one.problem)) for k, one in left.items()}
            for case, row in run(pool, _driven_case, sent):
                rows[case] = _lost(_DIED) if isinstance(row, str) else row
                if journal:
                    journal.append(case, rows[case])
                progress(f"route {min(len(rows) + 1, total)} of {total}")
    return DrivenRoutes(asked, tuple(rows[case] for case in range(total)))


_DIED = (
    "The process that drove this route died each time it was tried. Drive it by itself with "
    "`rr-opt route` to see why."
)


def _driven_case(asked: Route) -> dict[str, Any]:
    """The record of a route. Whatever goes wrong is a record that says so."""
    begun = time.process_time()
    try:
        record = route(asked).record()
    except RollerRacerError as error:
        record = _lost(str(error))
    except Exception as error:  # one route shall not end the others
        record = _lost(f"The route ended in an error that is a defect: {error!r}.")
    return record | {"cpu_seconds": time.process_time() - begun}


def _lost(message: str) -> dict[str, Any]:
    return {"status": Status.NOT_CONVERGED.value, "message": message}


def _row(record: Mapping[str, Any]) -> dict[str, Any]:
    """A row of the journal. Raises KeyError or ValueError if it is none."""
    Status(record["status"])
    return {**record, "message": str(record["message"])}
