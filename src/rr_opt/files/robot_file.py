"""A robot file, or the robot inside another file, to a `Robot`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rr_opt.files.document import Document
from rr_opt.files.issue import InvalidFileError, Issue, has_errors
from rr_opt.files.model_issues import validate
from rr_opt.files.provenance_section import read_provenance
from rr_opt.files.robot_model import DEFAULT_WHEEL_RADIUS, PlatformModel, RobotModel
from rr_opt.files.robot_sense import doubts, too_much_friction
from rr_opt.files.source import read_document
from rr_opt.robot.parameters import Platform, Robot, Servo


def read_robot(path: str | Path) -> Robot:
    """The robot of a file. Raises InvalidFileError with everything that is wrong in it."""
    robot, issues = robot_from(read_document(Path(path)))
    if robot is None:
        raise InvalidFileError(issues)
    return robot


def robot_from(document: Document) -> tuple[Robot | None, list[Issue]]:
    """The robot that a mapping describes (None if an issue is an error), and all issues."""
    model, issues = validate(RobotModel, document)
    issues += _friction_and_radius(document)
    beyond: dict[str, Any] = {}
    if "physics" in document.data:
        # Here and not above: the catalogue loads CasADi, and reading most files does not.
        from rr_opt.files.physics_section import read_effects  # noqa: PLC0415

        beyond["physics"], found = read_effects(document)
        issues += found
    if "provenance" in document.data:
        beyond["provenance"], found = read_provenance(document)
        issues += found
    if model is None or has_errors(issues):
        return None, issues
    h = model.h or DEFAULT_WHEEL_RADIUS
    robot = Robot(
        platform1=_platform(model.platform1, h),
        platform2=_platform(model.platform2, h),
        h=h,
        servo=Servo(**model.servo.model_dump()),
        name=model.name,
        **beyond,
    )
    issues += [document.issue("warning", path, message) for path, message in doubts(robot)]
    stuck = [document.issue("error", path, text) for path, text in too_much_friction(robot)]
    return (None if stuck else robot), issues + stuck


def _platform(model: PlatformModel, h: float) -> Platform:
    kappa = (model.kappa or 0.0) if model.k is None else model.k * (h * h)
    return Platform(m=model.m, I=model.I, c=model.c, a=model.a, b=model.b, kappa=kappa)


def _friction_and_radius(document: Document) -> list[Issue]:
    """Exactly one of kappa and k for each platform, and h where its value matters."""
    issues: list[Issue] = []
    reasons = ["`physics`"] if document.data.get("physics") else []
    for key in ("platform1", "platform2"):
        platform = document.data.get(key)
        if not isinstance(platform, dict):
            continue
        if "kappa" in platform and "k" in platform:
            message = "Both kappa and k are given, and k = kappa/h^2. Keep one of them."
            issues.append(document.issue("error", (key, "k"), message))
        elif "kappa" not in platform and "k" not in platform:
            message = (
                "The wheel friction is missing. Expected kappa (N m s) or k = kappa/h^2 (N s/m). "
                "Add one of them."
            )
            issues.append(document.issue("error", (key, "kappa"), message))
        if "kappa" in platform:
            reasons.append(f"{key}.kappa")
    if reasons and "h" not in document.data:
        message = (
            f"The wheel radius (m) is missing. {reasons[0]} needs it. Add for example h: 20 mm."
        )
        issues.append(document.issue("error", ("h",), message))
    return issues
