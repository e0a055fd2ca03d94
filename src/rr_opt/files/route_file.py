"""From a route file to a `Route`: its problem, its pieces, and all their mistakes."""

from collections import Counter
from dataclasses import dataclass, field, replace
from hashlib import sha256
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, SkipValidation

from rr_opt.files.fields import FileModel, Keys, validate
from rr_opt.files.issue import InvalidFileError, Issue, has_errors, required
from rr_opt.files.problem_file import ProblemModel, base_sources, problem_from, read_as
from rr_opt.files.source import fingerprint
from rr_opt.files.study_axes import StudyModel
from rr_opt.files.yaml_text import FileData
from rr_opt.messages import listed, shown
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
        default_factory=Tolerance, description="How accurately the route is driven."
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


@dataclass(frozen=True)
class RouteStudy:
    """Routes that are driven separately; their names differ.

    sha256  over the study file and every file of the routes, in hex
    """

    name: str
    routes: tuple[Route, ...] = field(repr=False)
    sha256: str


def is_of_routes(document: FileData) -> bool:
    """Whether a study file names routes."""
    return "routes" in document.data


def read_routes(path: str | Path) -> tuple[RouteStudy, list[Issue]]:
    """The study of a file, and warnings. Raises InvalidFileError with all that is wrong."""
    file = Path(path)
    expected = "Read a file without `routes`. Expected the names of route files under this key."
    document = read_as("study", file, expected)
    if not is_of_routes(document):
        raise InvalidFileError([document.error((), expected)])
    study, issues = routes_from(document, file)
    return required(study, issues), issues


def routes_from(document: FileData, file: Path) -> tuple[RouteStudy | None, list[Issue]]:
    """The study (None if an issue is an error), and all issues of it and of every route."""
    model, issues = validate(StudyModel, document)
    for key in document.data:
        if key in ("problem", "vary", "together"):
            message = f"Read `{key}` as well as `routes`. Expected one or the other. Delete one."
            issues.append(document.error((key,), message))
    routes = list[Route]()
    for name in (model and model.routes) or ():
        try:
            place = file.parent / name
            route, found = route_from(read_as("route", place, ROUTE_EXPECTED), place)
        except InvalidFileError as error:
            issues += error.issues
            continue
        issues += found
        if route is not None:
            routes.append(route)
    twice = [name for name, count in Counter(one.name for one in routes).items() if count > 1]
    if twice:
        message = f"Read {listed(twice)} twice. Expected files of different names. Rename one."
        issues.append(document.error(("routes",), message))
    if any(one.name == "study" for one in routes):
        message = (
            "Read a route named study, whose result would replace study.json. Expected another "
            "name. Rename its file."
        )
        issues.append(document.error(("routes",), message))
    if model is None or has_errors(issues):
        return None, issues
    whole = "".join([fingerprint([file]), *(route.sha256 for route in routes)])
    return RouteStudy(file.stem, tuple(routes), sha256(whole.encode()).hexdigest()), issues
