"""A route file to a `Route`: its problem, its pieces, and everything that is wrong with them."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, SkipValidation

from rr_opt.files.fields import FileModel, Keys, validate
from rr_opt.files.issue import InvalidFileError, Issue, has_errors, required
from rr_opt.files.problem_file import base_sources, problem_from, read_as
from rr_opt.files.problem_model import ProblemModel
from rr_opt.files.source import fingerprint
from rr_opt.files.yaml_text import FileData
from rr_opt.messages import shown
from rr_opt.model.problem import Direction
from rr_opt.model.route import Arc, Piece, Pose, Route, Straight, Tolerance, Waypoint


class PieceModel(FileModel):
    """A piece of the route: one of the three."""

    straight: Annotated[Straight, Keys(alone="length")] | None = Field(
        default=None, description="A straight line ahead, m."
    )
    arc: Annotated[Arc, Keys()] | None = Field(
        default=None, description="An arc that begins ahead: its radius and change of heading."
    )
    to: Annotated[Waypoint, Keys()] | None = Field(
        default=None, description="A pose to be reached over arcs and a straight line."
    )


ROUTE_EXPECTED = "Read a file without `route`. Expected the pieces of a route under this key."
_ONE = "`straight`, `arc` or `to`"
_EACH = f"one key, {_ONE}, such as `- straight: 1 m`"


class RouteModel(FileModel):
    """A route that the robot drives from rest, in as little time as it can."""

    problem: Annotated[str | ProblemModel | None, SkipValidation] = Field(
        default=None,
        description="A problem file, relative to this file, or the problem itself: robot, bounds "
        "and limits. Without it: the paper's prototype.",
    )
    start: Annotated[Pose, Keys()] = Field(
        default_factory=Pose, description="Where the path begins; the robot is at rest there."
    )
    route: Annotated[list[PieceModel], SkipValidation] = Field(
        min_length=1, description=f"The pieces, one after another: each is {_ONE}."
    )
    tolerance: Annotated[Tolerance, Keys()] = Field(
        default_factory=Tolerance, description="How exactly the route is driven."
    )
    direction: Direction = Field(
        default="either",
        description="forward: platform 1 leads, its axis along the path. backward: platform 2 "
        "leads. either: whichever is faster.",
    )
    end: Literal["rest", "running"] = Field(
        default="rest", description="rest: the robot stops at the end. running: it passes it."
    )


def read_route(path: str | Path) -> tuple[Route, list[Issue]]:
    """The route of a file, and warnings. Raises InvalidFileError with all that is wrong."""
    file = Path(path)
    route, issues = route_from(read_as("route", file, ROUTE_EXPECTED), file)
    return required(route, issues), issues


def route_from(document: FileData, file: Path) -> tuple[Route | None, list[Issue]]:
    """The route (None if an issue is an error), and all issues of it and of its problem."""
    model, issues = validate(RouteModel, document)
    pieces, found = _pieces(document)
    issues += found
    try:
        sources = base_sources(document, file)
        problem, found = problem_from(sources)
        issues += found
    except InvalidFileError as error:
        return None, [*issues, *error.issues]
    if model is None or problem is None or has_errors(issues):
        return None, issues
    paths = [file, *(path for path in sources.paths if path != file)]
    route = Route(
        replace(problem, direction=model.direction),
        tuple(pieces),
        model.start,
        model.tolerance,
        model.direction,
        model.end,
        file.stem,
        fingerprint(paths),
    )
    return route, issues


def _pieces(document: FileData) -> tuple[list[Piece], list[Issue]]:
    if "route" not in document.data:
        return [], []
    sections, issues = document.entries("route", f"a list of pieces, each {_ONE}", _EACH)
    pieces = list[Piece]()
    for section in sections:
        given = shown(section.data)
        if len(section.data) != 1:
            issues.append(section.error((), f"Read {given}. Expected {_EACH}. Write it so."))
            continue
        model, found = validate(PieceModel, section)
        issues += found
        piece = model and (model.straight or model.arc or model.to)
        if piece is not None:
            pieces.append(piece)
        elif not found:
            issues.append(section.error((), f"Read {given}. Expected values under the key."))
        if isinstance(piece, Arc) and piece.angle == 0:
            message = "Read an arc of 0 deg, which leads nowhere. Give its change of heading."
            issues.append(section.error(("arc",), message))
    return pieces, issues
