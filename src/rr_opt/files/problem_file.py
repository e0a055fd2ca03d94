"""A problem file to a `Problem`, and the fingerprint of what was read."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path

from rr_opt.files.document import Document
from rr_opt.files.gait_bounds_model import OWN_SHAPE, GaitModel
from rr_opt.files.gait_sense import gait_findings
from rr_opt.files.issue import InvalidFileError, Issue, has_errors, shown
from rr_opt.files.model_issues import validate
from rr_opt.files.problem_model import LimitsModel, ProblemModel
from rr_opt.files.problem_sources import Sources, problem_sources
from rr_opt.files.ratio_sense import ratio_findings, reachable
from rr_opt.files.robot_file import robot_from
from rr_opt.files.source import read_content
from rr_opt.problem import GaitBounds, Limits, Problem, RatioChoice
from rr_opt.robot.ballast import Loads
from rr_opt.robot.parameters import Robot, Servo


def read_problem(path: str | Path | None = None) -> Problem:
    """The problem of a file, of a folder with problem.yaml, or (None) the shipped one.

    A robot file stands for the shipped problem with that robot and its servo's limits.
    Raises InvalidFileError with everything that is wrong in the problem and its robot.
    """
    problem, issues = problem_from(problem_sources(path))
    if problem is None:
        raise InvalidFileError(issues)
    return problem


def input_sha256(path: str | Path | None = None) -> str:
    """SHA-256, in hex, over the bytes of the problem file and of the robot file it names.

    Each file is preceded by its length in bytes. Raises InvalidFileError if one is unreadable.
    """
    digest = hashlib.sha256()
    for file in problem_sources(path).paths:
        content = read_content(file)
        digest.update(f"{len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()


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
    ratio = _ratio(model)
    issues += _contradictions(model, ratio, robot, document)
    if has_errors(issues):
        return None, issues
    problem = Problem(
        robot=robot,
        limits=_limits(model.limits, robot.servo),
        gait=_gait(model.gait),
        inertia_ratio=reachable(ratio, robot) if ratio else None,
        direction=model.direction,
    )
    return problem, issues


def _gait(given: GaitModel) -> GaitBounds:
    counts = {key: getattr(given, key) for key in OWN_SHAPE}
    return GaitBounds(
        amplitude=given.amplitude,
        period=given.period,
        offset=given.offset,
        shape=given.shape,
        **{key: count for key, count in counts.items() if count is not None},
    )


def _ratio(model: ProblemModel) -> RatioChoice | None:
    given = model.inertia_ratio
    if given is None:
        return None
    return RatioChoice(given.bounds, given.about, given.by, Loads(**given.loads.model_dump()))


def _limits(given: LimitsModel, servo: Servo) -> Limits:
    return Limits(
        angle=servo.angle_limit if given.angle is None else given.angle,
        rate=servo.rate_limit if given.rate is None else given.rate,
        torque=servo.torque_limit if given.torque is None else given.torque,
        singularity=given.singularity,
    )


def _contradictions(
    model: ProblemModel, ratio: RatioChoice | None, robot: Robot, document: Document
) -> Iterator[Issue]:
    """What the problem asks for and its robot cannot do."""
    yield from gait_findings(model.gait, document)
    if robot.k1 == robot.k2 == 0 and not robot.physics:
        message = (
            "Read kappa = 0 (or k = 0) on both platforms, and no `physics`. Without friction no "
            "gait settles to a steady speed. Give at least one platform a kappa above 0."
        )
        yield document.issue("error", ("robot",), message)
    if ratio:
        for level, key, message in ratio_findings(ratio, robot):
            yield document.issue(level, ("inertia_ratio", key), message)
        written = document.data["inertia_ratio"]
        if ratio.by == "inertia" and isinstance(written, dict) and "loads" in written:
            message = "Loads are given and not used. Write `by: loads`, or delete them."
            yield document.issue("warning", ("inertia_ratio", "loads"), message)
    servo = robot.servo
    for key, given, able, unit in (
        ("angle", model.limits.angle, servo.angle_limit, "rad"),
        ("rate", model.limits.rate, servo.rate_limit, "rad/s"),
        ("torque", model.limits.torque, servo.torque_limit, "N m"),
    ):
        if given is not None and given > able * (1 + 1e-9):
            message = (
                f"Read {shown(document.data['limits'][key])}, beyond what the robot's servo can "
                f"do, {able:.4g} {unit}. Lower it, or raise `servo.{key}_limit` of the robot."
            )
            yield document.issue("warning", ("limits", key), message)
