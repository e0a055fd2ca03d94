"""A driven route: the drive that was found, and its replay."""

from __future__ import annotations

import math
from dataclasses import dataclass

from rr_opt.formatting import with_unit
from rr_opt.model.command import Command
from rr_opt.model.problem import LARGEST_EXCESS
from rr_opt.model.robot import Robot
from rr_opt.outcome import Status
from rr_opt.results.ignored import ignored_effects
from rr_opt.results.result import Check, Result
from rr_opt.routing.plan import Plan
from rr_opt.routing.replay import Replay


@dataclass(frozen=True, repr=False)
class DrivenRoute(Result):
    """The fastest drive found along a route.

    plan    path, gaits and drive; `plan.drive.command` is the servo's angle over time
    replay  the drive by CVODES from rest; None if there is no drive
    """

    REPORT = "rr_opt.report.route"

    name: str
    sha256: str
    plan: Plan
    replay: Replay | None

    @property
    def robot(self) -> Robot:
        """The robot that drives."""
        return self.plan.problem.robot

    @property
    def command(self) -> Command | None:
        """The servo's angle over time; None if there is no drive."""
        return self.plan.drive.command if self.plan.drive else None

    @property
    def seconds(self) -> float | None:
        """Time of the drive, s."""
        return self.command.seconds if self.command else None

    @property
    def status(self) -> Status:
        """OPTIMAL if a drive was found that passes every check."""
        if self.plan.status is Status.OPTIMAL and not all(check.passed for check in self.checks):
            return Status.NOT_CONVERGED
        return self.plan.status

    @property
    def message(self) -> str:
        """The outcome in a sentence."""
        if self.plan.status is not Status.OPTIMAL or self.seconds is None:
            return self.plan.message
        failed = [check.sentence for check in self.checks if not check.passed]
        if failed:
            return "The drive failed a check: " + " ".join(failed)
        length = sum(leg.length for leg in self.plan.legs)
        return (
            f"The fastest drive found goes {self.plan.way} and takes "
            f"{with_unit(self.seconds, 's')} for {with_unit(length, 'm')}."
        )

    @property
    def checks(self) -> list[Check]:
        """Of the replay: the end, the way, and the limits."""
        replay, asked = self.replay, self.plan.route.tolerance
        if replay is None:
            return []
        end = replay.position <= asked.position and replay.heading <= asked.heading
        checks = [
            Check(
                end,
                f"End by CVODES: P is {1e3 * replay.position:.1f} mm from its place (at most "
                f"{1e3 * asked.position:.4g}), platform 1 {math.degrees(replay.heading):.2f} deg "
                f"from its heading (at most {math.degrees(asked.heading):.4g}).",
            ),
            Check(
                replay.path <= asked.path,
                f"Way by CVODES: P stays within {1e3 * replay.path:.1f} mm of the path (at most "
                f"{1e3 * asked.path:.4g}).",
            ),
            Check(
                replay.excess <= LARGEST_EXCESS,
                "Limits: rate, angle, torque and singularity are kept throughout "
                f"(worst {100 * replay.excess:+.2f} % of its limit).",
            ),
        ]
        if self.plan.route.end == "rest":
            speed = (
                f"Rest: the robot is slower than {1e3 * asked.speed:.4g} mm/s at the end "
                f"({1e3 * replay.speed:.2f})."
            )
            checks.append(Check(replay.speed <= asked.speed, speed))
        return checks

    @property
    def warnings(self) -> tuple[str, ...]:
        """Which effects of the robot the drive ignores."""
        return tuple(ignored_effects(self.robot))
