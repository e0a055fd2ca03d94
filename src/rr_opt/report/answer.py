"""An optimum with the evidence for it: what the replay and the sweep say, and so how it ends."""

from __future__ import annotations

import math
from dataclasses import dataclass

from rr_opt.design.maximize_speed import Optimum
from rr_opt.outcome import Status
from rr_opt.problem import LARGEST_EXCESS
from rr_opt.report.quantities import direction_text, pace_text
from rr_opt.robot.gait import Gait
from rr_opt.verify.replay import Replay
from rr_opt.verify.sweep import TOLERATED, SweepCheck

LARGEST_REPLAY_ERROR = 1e-6


@dataclass(frozen=True)
class Check:
    """One check: whether it was passed, and what it found in a sentence."""

    passed: bool
    sentence: str


@dataclass(frozen=True)
class Answer:
    """What `maximize-speed` has to tell.

    name    of the problem
    sha256  fingerprint of its files
    replay, sweep   None where there is no optimum to check
    """

    name: str
    sha256: str
    optimum: Optimum
    replay: Replay | None = None
    sweep: SweepCheck | None = None

    @property
    def checks(self) -> list[Check]:
        """The checks that were made."""
        checks = []
        if self.replay:
            error, excess = self.replay.error, self.replay.excess
            checks.append(
                Check(
                    error <= LARGEST_REPLAY_ERROR,
                    f"Replay by CVODES: its speed is {1e3 * self.replay.speed:+.3f} mm/s, "
                    f"{error:.1e} from the optimiser's, relative "
                    f"(at most {LARGEST_REPLAY_ERROR:.0e} allowed).",
                )
            )
            tail = f"(at most {LARGEST_EXCESS:.0e} allowed)."
            found = (
                f"the worst limit is broken by {excess:.1e} of it {tail}"
                if excess > 0
                else "no limit is broken."
            )
            checks.append(Check(excess <= LARGEST_EXCESS, f"Limits over the whole cycle: {found}"))
        if self.sweep:
            found = _sweep_sentence(self.sweep, self.optimum.problem.gait.shape)
            checks.append(Check(self.sweep.gap >= -TOLERATED, found))
            if not math.isnan(self.sweep.error):
                checks.append(
                    Check(
                        self.sweep.error <= TOLERATED,
                        f"The sweep's own model gives the optimum {1e3 * self.sweep.speed:+.3f} "
                        f"mm/s, {self.sweep.error:.1e} from the optimiser's, relative "
                        f"(at most {TOLERATED:.0e} allowed).",
                    )
                )
        return checks

    @property
    def status(self) -> Status:
        """As the optimiser ended, unless a check failed."""
        if all(check.passed for check in self.checks):
            return self.optimum.status
        return Status.NOT_CONVERGED

    @property
    def headline(self) -> str:
        """What was found, for the head of a page; empty if nothing was confirmed."""
        best = self.optimum.best
        if self.status is not Status.OPTIMAL or best is None:
            return ""
        return (
            f"The fastest gait found drives {direction_text(best.speed)} at "
            f"{1e3 * abs(best.speed):.1f} mm/s"
        )

    @property
    def message(self) -> str:
        """The outcome in a paragraph; a failed check comes first."""
        failed = [check.sentence for check in self.checks if not check.passed]
        if failed:
            return "The optimum was not confirmed. " + " ".join(failed)
        best = self.optimum.best
        if best is None:
            return self.optimum.message
        text = (
            f"The fastest gait found drives {direction_text(best.speed)} at "
            f"{pace_text(best.speed)}, and every check confirms it."
        )
        ties = len(self.optimum.ties)
        if ties:
            text += f" {ties} other gait{'s are' if ties > 1 else ' is'} as fast: a tie."
        sine = self.optimum.sine
        if sine:
            gain = 100 * (abs(best.speed) / sine - 1)
            text += f" That is {gain:.1f} % faster than the fastest sine."
        text += self._servo_note(best.gait)
        if self.sweep and math.isnan(self.sweep.error):
            text += " The sweep's own model could not follow this shape and says nothing of it."
        if self.optimum.sideways:
            text += (
                " It sits where forward turns into backward: its mean velocity is at right angles "
                "to its mean heading, and which way it goes is a matter of definition."
            )
        return text

    def _servo_note(self, gait: Gait) -> str:
        """What the problem's limits allow beyond the servo of the robot file."""
        servo = self.optimum.problem.robot.servo
        beyond = [
            name
            for name, needed, able in (
                ("angle", gait.peak_angle, servo.angle_limit),
                ("rate", gait.peak_rate, servo.rate_limit),
                ("torque", self.replay.reached["torque"] if self.replay else 0, servo.torque_limit),
            )
            if needed > able * (1 + LARGEST_EXCESS)
        ]
        if not beyond:
            return ""
        return (
            f" But the problem allows more than the robot's servo: the gait goes beyond its "
            f"{' and '.join(beyond)} limit."
        )


def _sweep_sentence(sweep: SweepCheck, shape: str) -> str:
    gaits = "gaits" if shape == "sine" else "sines"
    if sweep.best_gait is None:
        return f"Sweep of {sweep.points} {gaits}: none of them keeps every limit."
    head = f"Sweep of {sweep.points} {gaits}: the best has {1e3 * sweep.best_speed:+.3f} mm/s, "
    if abs(sweep.gap) < 1e-6:
        return head + "as fast as the optimum to a millionth."
    if sweep.gap >= 0:
        return head + f"{100 * sweep.gap:.2g} % slower than the optimum."
    return (
        head + f"{-100 * sweep.gap:.2g} % faster than the optimum "
        f"(at most {100 * TOLERATED:g} % allowed)."
    )
