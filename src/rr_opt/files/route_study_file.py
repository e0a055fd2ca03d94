"""A study of routes: a file that names route files, each a case."""

from collections import Counter
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

from rr_opt.files.fields import validate
from rr_opt.files.issue import InvalidFileError, Issue, has_errors, required
from rr_opt.files.problem_file import read_as
from rr_opt.files.problem_model import StudyModel
from rr_opt.files.route_file import ROUTE_EXPECTED, route_from
from rr_opt.files.source import fingerprint
from rr_opt.files.yaml_text import FileData
from rr_opt.messages import listed
from rr_opt.model.route import Route


@dataclass(frozen=True)
class RouteStudy:
    """Routes that are driven each by itself; their names differ.

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
            message = f"Read `{key}` beside `routes`. Expected one or the other. Delete one."
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
    if model is None or has_errors(issues):
        return None, issues
    whole = "".join([fingerprint([file]), *(route.sha256 for route in routes)])
    return RouteStudy(file.stem, tuple(routes), sha256(whole.encode()).hexdigest()), issues
