"""Routes: the drive along one, checked, and many of them as a study."""

import time
import warnings
from collections.abc import Mapping
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

from rr_opt.api.load import InputWarning, PathLike, fingerprint
from rr_opt.api.study import journal_in
from rr_opt.batch.run import pool_of, run
from rr_opt.design.study.case import portable
from rr_opt.files.issue import Issue
from rr_opt.files.route_file import RouteStudy, read_route, read_routes
from rr_opt.model.route import Route
from rr_opt.motion.servo import servo_limited
from rr_opt.outcome import RollerRacerError, Status
from rr_opt.results.result import Progress, quiet
from rr_opt.results.route import DrivenRoute
from rr_opt.results.study import DrivenRoutes
from rr_opt.routing.feedback import controller, with_reserve
from rr_opt.routing.plan import plan_route
from rr_opt.routing.replay import replay
from rr_opt.version import __version__

Read = TypeVar("Read")


def load_route(path: PathLike) -> Route:
    """The route of a file. Warns with InputWarning of suspicious values.

    Raises InputError with everything that is wrong in it and in its problem.
    """
    return _warned(*read_route(path))


def load_routes(path: PathLike) -> RouteStudy:
    """The routes that a study file names. Warns with InputWarning of suspicious values.

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
    sha256 = asked.sha256 or fingerprint(asked)
    asked = replace(asked, problem=servo_limited(asked.problem))
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
    return DrivenRoute(asked.name, sha256, plan, check, feedback=control)


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
    total = len(asked.routes)
    identity = {"input_sha256": asked.sha256, "version": __version__}
    with journal_in(folder, identity, _row, total, restart) as journal:
        rows = dict(journal.rows) if journal else {}
        left = {
            case: replace(route, problem=portable(route.problem))
            for case, route in enumerate(asked.routes)
            if case not in rows
        }
        if left:
            progress(f"route {len(rows) + 1} of {total}")
            with closing(pool_of(workers, scheduler)) as pool:
                for case, row in run(pool, _driven_case, left):
                    rows[case] = _lost(_DIED) if isinstance(row, str) else row
                    if journal:
                        journal.append(case, rows[case])
                    progress(f"route {min(len(rows) + 1, total)} of {total}")
    return DrivenRoutes(asked, tuple(rows[case] for case in range(total)))


_DIED = (
    "The process that drove this route died each time it was tried. Run it alone with `rr-opt "
    "route` to see why."
)


def _driven_case(asked: Route) -> dict[str, Any]:
    """The record of a route. Any failure is reported as a record."""
    begun = time.process_time()
    try:
        record = route(asked).record()
    except RollerRacerError as error:
        record = _lost(str(error))
    except Exception as error:  # one route must not end the others
        record = _lost(f"The route failed with an internal error: {error!r}.")
    return record | {"cpu_seconds": time.process_time() - begun}


def _lost(message: str) -> dict[str, Any]:
    return {"status": Status.NOT_CONVERGED.value, "message": message}


def _row(record: Mapping[str, Any]) -> dict[str, Any]:
    """A row of the journal. Raises KeyError or ValueError if it is not one."""
    Status(record["status"])
    return {**record, "message": str(record["message"])}
