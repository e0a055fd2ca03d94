"""Checking an optimum: by simulation, and against a plain sweep."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rr_opt.cli.steps import Steps
    from rr_opt.design.maximize_speed import Optimum
    from rr_opt.report.answer import Answer
    from rr_opt.verify.sweep import SweepResult


def checked(
    name: str, sha256: str, optimum: Optimum, steps: Steps, swept: SweepResult | None = None
) -> Answer:
    """The optimum with the evidence for it; swept: of the problem, where that is done."""
    from rr_opt.report.answer import Answer  # noqa: PLC0415
    from rr_opt.verify.replay import replay  # noqa: PLC0415
    from rr_opt.verify.sweep import check_optimum  # noqa: PLC0415

    best, robot, ratio = optimum.best, optimum.robot, optimum.ratio
    if best is None or robot is None or ratio is None:
        return Answer(name, sha256, optimum)
    steps("replay by CVODES")
    replayed = replay(robot, best.gait, optimum.problem.limits, best.speed)
    steps("check against a sweep")
    check = check_optimum(optimum.problem, best.gait, ratio, best.speed, everywhere=swept)
    return Answer(name, sha256, optimum, replayed, check)
