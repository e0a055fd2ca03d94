"""From a problem file to a `Problem`, and the fingerprint of its sources."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, SkipValidation

from rr_opt.files.fields import FileModel, Keys, another_file, validate
from rr_opt.files.issue import InvalidFileError, Issue, has_errors, required
from rr_opt.files.robot_file import RobotModel, robot_from
from rr_opt.files.source import SHIPPED, fingerprint, is_result, linked, problem_path, read_document
from rr_opt.files.yaml_text import FileData
from rr_opt.messages import nearest, shown
from rr_opt.model.ballast import with_inertia_ratio
from rr_opt.model.problem import (
    Direction,
    GaitBounds,
    Limits,
    Objective,
    Problem,
    RatioChoice,
    Shape,
    Spreads,
    reachable,
)
from rr_opt.model.robot import Robot
from rr_opt.outcome import InputError

OWN_SHAPE: dict[str, Shape] = {"harmonics": "fourier", "intervals": "free"}
"""Keys of a gait that are specific to one shape."""


def _needs(key: str, shape: Shape) -> dict[str, Any]:
    """JSON Schema: if the key is present, the shape is this one."""
    then = {"properties": {"shape": {"const": shape}}, "required": ["shape"]}
    return {"if": {"required": [key]}, "then": then}


_GAIT = Keys(schema={"allOf": [_needs(key, shape) for key, shape in OWN_SHAPE.items()]})


class ProblemModel(FileModel):
    """Which gait drives the robot fastest? Plain numbers are SI; a text may carry a unit."""

    robot: Annotated[str | RobotModel | None, SkipValidation] = Field(
        default=None,
        description="A robot file, relative to this file, or the robot itself. "
        "Without it: the paper's prototype.",
    )
    gait: Annotated[GaitBounds, _GAIT] = Field(
        default_factory=GaitBounds, description="Which gaits are allowed."
    )
    inertia_ratio: Annotated[RatioChoice, Keys(alone="bounds")] | None = Field(
        default=None, description="J20/J10 as a choice. Without it: the robot as it is."
    )
    limits: Annotated[Limits, Keys()] = Field(
        default_factory=Limits,
        description="What a gait may demand of the robot. Limits not given are those of the "
        "robot's servo.",
    )
    direction: Direction = Field(default="either", description="Which way the robot is to drive.")
    objective: Objective = Field(
        default="speed",
        description="What to optimise: the highest speed or the lowest cost of transport.",
    )
    robust: Annotated[Spreads, Keys()] | None = Field(
        default=None,
        description="How well the robot is known. If given, also find a gait that is fast on 95 % "
        "of the robots within this uncertainty.",
    )


Kind = Literal["robot", "problem", "study", "experiment", "route", "result"]

_EXPERIMENT = ("recordings", "noise", "uncertainty", "machine")
_STUDY = ("vary", "together", "problem", "routes")


def kind_of(document: FileData) -> Kind:
    """The kind whose keys the file has most of, misspelt ones included; a tie is a problem."""
    if is_result(document.data):
        return "result"
    if any(key in document.data for key in _EXPERIMENT):
        return "experiment"
    if "route" in document.data:
        return "route"
    if any(key in document.data for key in _STUDY):
        return "study"
    robot, problem = list(RobotModel.model_fields), list(ProblemModel.model_fields)
    meant = [nearest(key, [*robot, *problem]) for key in document.data]
    of_robot = sum(key in robot for key in meant)
    return "robot" if of_robot > sum(key in problem for key in meant) else "problem"


def read_as(kind: Kind, file: Path, expected: str) -> FileData:
    """The data of a file. Raises InvalidFileError, naming the expected kind, if it is another."""
    document = read_document(file)
    if kind_of(document) != kind:
        raise InvalidFileError([document.error((), expected)])
    return document


_ROUNDING = 1e-9


def ratio_findings(choice: RatioChoice, robot: Robot, document: FileData) -> Iterator[Issue]:
    """Issues of a choice of ratios for this robot; the messages suggest a remedy."""
    loads = choice.loads
    if choice.by == "loads" and loads.distance == loads.spread == 0:
        message = (
            "Read loads at the joint itself, which do not change the inertia about it. "
            "Give `distance` or `spread` a value above 0."
        )
        yield document.error(("inertia_ratio", "loads"), message)
        return
    bounds = reachable(choice, robot).bounds
    for ratio in sorted({bounds.low, bounds.high}):
        try:
            with_inertia_ratio(robot, ratio, choice.about, choice.by, loads)
        except InputError as error:
            yield document.error(("inertia_ratio", "bounds"), str(error))
            return
    if bounds.low > choice.bounds.low * (1 + _ROUNDING):
        message = (
            f"The robot without loads has {bounds.low:.4g} already, and loads only add to it. "
            f"The ratios from {choice.bounds.low:.4g} up to there are left out."
        )
        yield document.warning(("inertia_ratio", "bounds"), message)


LONGEST_PERIOD = 60.0
"""Longer ones are assumed to be a wrong unit, s."""


def gait_findings(gait: GaitBounds, document: FileData) -> Iterator[Issue]:
    """Meaningless gaits, and gaits whose steady cycle is infeasible to compute."""
    for key, shape in OWN_SHAPE.items():
        if key in document.data.get("gait", {}) and gait.shape != shape:
            message = (
                f"Read {key} of a gait with the shape `{gait.shape}`. Only a `{shape}` gait "
                f"has {key}. Write `shape: {shape}`, or delete this key."
            )
            yield document.error(("gait", key), message)
    if gait.amplitude.high <= 0:
        message = (
            "Read an amplitude of at most 0. Expected an upper bound above 0: a gait that "
            "does not move the servo does not move the robot."
        )
        yield document.error(("gait", "amplitude"), message)
    elif gait.amplitude.low == 0 and gait.shape != "sine":
        message = (
            f"Read an amplitude from 0 of a `{gait.shape}` gait. Expected a lower bound above 0: "
            "it bounds the first harmonic, without which a gait repeats within its period, and "
            "the bounds of the period mean nothing. Write for example `amplitude: "
            f"[{min(0.05, gait.amplitude.high / 10):.2g}, {gait.amplitude.high:.4g}]`."
        )
        yield document.warning(("gait", "amplitude"), message)
    if gait.period.high > LONGEST_PERIOD:
        message = (
            f"Read a period of up to {gait.period.high:.4g} s. Expected at most "
            f"{LONGEST_PERIOD:.4g} s. Check the unit."
        )
        yield document.error(("gait", "period"), message)


@dataclass(frozen=True)
class Sources:
    """A problem as read, unchecked apart from its YAML.

    paths   the files it is made of
    robot   None if it could not be read; `issues` say why
    """

    paths: tuple[Path, ...]
    problem: FileData
    robot: FileData | None
    issues: tuple[Issue, ...] = ()


_READ_ELSEWHERE = {
    "experiment": "Read the keys of an experiment. Expected a problem or a robot. "
    "Experiments are read by `rr-opt diagnose`.",
    "study": "Read the keys of a study. Expected a problem or a robot. "
    "Studies are solved by `rr-opt study`.",
    "route": "Read the keys of a route. Expected a problem or a robot. "
    "Routes are driven by `rr-opt route`.",
    "result": "Read a result, which rr-opt has written. Expected an input file: a problem or a "
    "robot. Results are read by `rr-opt simulate` and `rr-opt export`.",
}


def problem_sources(path: str | Path | None) -> Sources:
    """The parts of a problem: a problem file, its folder, a robot file, or None (as shipped).

    A robot file stands for the shipped problem with that robot as it is and its servo's limits.
    Raises InvalidFileError if the file cannot be read, or is of another kind.
    """
    file = problem_path(SHIPPED if path is None else Path(path))
    document = read_document(file)
    kind = kind_of(document)
    if kind in _READ_ELSEWHERE:
        raise InvalidFileError([document.error((), _READ_ELSEWHERE[kind])])
    if wrong := another_file(RobotModel if kind == "robot" else ProblemModel, document):
        raise InvalidFileError(wrong)
    if kind == "robot":
        return _shipped_problem_with(document, file)
    return with_robot(document, file, (file,))


def _shipped_problem_with(robot: FileData, file: Path) -> Sources:
    problem = read_document(SHIPPED / "problem.yaml")
    limits = problem.section("limits").without("angle", "rate", "torque").data
    data = {**problem.without("robot", "inertia_ratio").data, "limits": limits}
    shipped = FileData(f"the shipped problem, with {file}", data, problem.lines)
    return Sources((SHIPPED / "problem.yaml", file), shipped, robot)


ROBOT = "the name of a robot file, or the robot itself"


def with_robot(problem: FileData, file: Path, paths: tuple[Path, ...] = ()) -> Sources:
    """The problem and the robot that it names, relative to `file`; by default, the shipped one."""
    if "robot" not in problem.data:
        named = SHIPPED / "robot.yaml"
        return Sources((*paths, named), problem, read_document(named))
    expected = f"{ROBOT}. Without this key the robot is the paper's prototype"
    robot, named, issues = linked(problem, "robot", file.parent, expected)
    if robot is not None and is_result(robot.data):
        message = (
            f"Read {shown(problem.data['robot'])}, a result. Expected a robot file. Write what the "
            "result has under `robot` to a file, and name that."
        )
        robot, issues = None, [problem.error(("robot",), message)]
    return Sources((*paths, *named), problem, robot, tuple(issues))


def base_sources(document: FileData, file: Path) -> Sources:
    """The problem of a study or a route file. Raises InvalidFileError if it cannot be read."""
    entry = document.data.get("problem")
    if isinstance(entry, dict):
        return with_robot(document.section("problem"), file)
    if "problem" not in document.data:
        return problem_sources(None)
    expected = "the name of a problem file, or the problem itself"
    expected += ". Without this key the problem is the paper's prototype"
    _, paths, issues = linked(document, "problem", file.parent, expected)
    if issues:
        raise InvalidFileError(issues)
    return problem_sources(paths[0])


def read_problem(path: str | Path | None = None) -> Problem:
    """The problem of a file, of a folder with problem.yaml, or (None) the shipped one.

    A robot file stands for the shipped problem with that robot as it is and its servo's limits.
    Raises InvalidFileError with everything that is wrong in the problem and its robot.
    """
    sources = problem_sources(path)
    problem = required(*problem_from(sources))
    return problem.read_from(name_of(path), fingerprint(sources.paths))


def name_of(path: str | Path | None) -> str:
    """The name of a problem: its folder if the file is a problem.yaml, else the file."""
    if path is None:
        return "prototype"
    full = problem_path(Path(path).resolve())
    return full.parent.name if full.name == "problem.yaml" else full.stem


def problem_from(sources: Sources) -> tuple[Problem | None, list[Issue]]:
    """The problem (None if an issue is an error), and all issues of its files."""
    issues = list(sources.issues)
    robot = None
    if sources.robot is not None:
        robot, found = robot_from(sources.robot)
        issues += found
    document = sources.problem
    model, found = validate(ProblemModel, document)
    issues += found
    if model is None or robot is None:
        return None, issues
    issues += _contradictions(model, robot, document)
    if has_errors(issues):
        return None, issues
    ratio = model.inertia_ratio
    problem = Problem(
        robot=robot,
        limits=model.limits,
        gait=model.gait,
        inertia_ratio=reachable(ratio, robot) if ratio else None,
        direction=model.direction,
        objective=model.objective,
        robust=model.robust,
    )
    return problem, issues


def _contradictions(model: ProblemModel, robot: Robot, document: FileData) -> Iterator[Issue]:
    """Requests of the problem that its robot cannot meet."""
    yield from gait_findings(model.gait, document)
    if robot.k1 == robot.k2 == 0 and not robot.physics:
        message = (
            "Read kappa = 0 (or k = 0) on both platforms, and no `physics`. Without friction no "
            "gait settles to a steady speed. Give at least one platform a kappa above 0."
        )
        yield document.error(("robot",), message)
    if (model.objective != "speed" or model.limits.economy) and model.gait.shape != "sine":
        message = (
            f"Read `{model.gait.shape}` with `objective: cost_of_transport` or one of the limits "
            "power, cost_of_transport and speed. Only sines are optimised with these. Write "
            "`shape: sine`, or leave them out."
        )
        yield document.error(("gait", "shape"), message)
    if model.robust and (model.gait.shape != "sine" or model.objective != "speed"):
        message = (
            "Read `robust` with a shape other than a sine or an objective other than the speed. "
            "Expected neither: robust gaits are fast sines. Leave one of them out."
        )
        yield document.error(("robust",), message)
    if ratio := model.inertia_ratio:
        yield from ratio_findings(ratio, robot, document)
        written = document.data["inertia_ratio"]
        if ratio.by == "inertia" and isinstance(written, dict) and "loads" in written:
            message = "Loads are given but not used. Write `by: loads`, or delete them."
            yield document.warning(("inertia_ratio", "loads"), message)
    servo, least = robot.servo, model.gait.amplitude.low
    largest = servo.angle_limit if model.limits.angle is None else model.limits.angle
    if least > largest:
        message = (
            f"Read amplitudes of {least:.4g} rad and more, above the largest joint angle, "
            f"{largest:.4g} rad. No gait has them. Lower the bound; degrees need their unit, as in "
            f"`{least:.4g} deg`."
        )
        yield document.warning(("gait", "amplitude"), message)
    for key, given, able, unit in (
        ("angle", model.limits.angle, servo.angle_limit, "rad"),
        ("rate", model.limits.rate, servo.rate_limit, "rad/s"),
        ("torque", model.limits.torque, servo.torque_limit, "N m"),
    ):
        if given is not None and given > able * (1 + 1e-9):
            message = (
                f"Read {shown(document.data['limits'][key])}, more than the robot's servo can do, "
                f"{able:.4g} {unit}. Lower it, or raise `servo.{key}_limit` of the robot."
            )
            yield document.warning(("limits", key), message)
