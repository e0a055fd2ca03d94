"""Routes: read, driven and checked."""

from __future__ import annotations

import warnings
from pathlib import Path

from rr_opt.api.load import InputWarning, PathLike, fingerprint
from rr_opt.files.route_file import read_route
from rr_opt.model.route import Route
from rr_opt.results.result import Progress, quiet
from rr_opt.results.route import DrivenRoute
from rr_opt.routing.plan import plan_route
from rr_opt.routing.replay import replay


def load_route(path: PathLike) -> Route:
    """The route of a file. Warns with InputWarning of what looks wrong.

    Raises InputError with everything that is wrong in it and in its problem.
    """
    route, issues = read_route(path)
    for issue in issues:
        warnings.warn(str(issue), InputWarning, stacklevel=2)
    return route


def route(asked: Route | PathLike, *, progress: Progress = quiet) -> DrivenRoute:
    """The fastest drive found along a route, from rest, checked by simulation.

    Raises InputError for a robot without friction, and for a route without pieces.
    """
    if isinstance(asked, str | Path):
        asked = load_route(asked)
    plan = plan_route(asked, progress)
    check = None
    if plan.drive:
        progress("replay by CVODES")
        command = plan.drive.command
        check = replay(plan.problem, command, asked.start, plan.legs, plan.turned, plan.heading)
    return DrivenRoute(asked.name, asked.sha256 or fingerprint(asked), plan, check)
