"""What all answers have in common: how the work ended, what was checked, what to beware of."""

from __future__ import annotations

from dataclasses import dataclass

from rr_opt.effects.effect import Port
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import ignored_in_steady_cycle
from rr_opt.outcome import Status


@dataclass(frozen=True)
class Check:
    """One check of a result: whether it passed, and its finding in a sentence."""

    passed: bool
    sentence: str


class Answer:
    """Base of the answers.

    status    how the work ended
    message   the outcome in a sentence or two
    checks    the independent checks of the result; empty where there is nothing to check
    warnings  sentences on what the result leaves out, or what to beware of
    """

    @property
    def status(self) -> Status:
        """OPTIMAL, unless the kind of answer has another way to end."""
        return Status.OPTIMAL

    @property
    def message(self) -> str:
        """Empty for an answer that is all numbers."""
        return ""

    @property
    def checks(self) -> list[Check]:
        """None, unless the kind of answer has some."""
        return []

    @property
    def warnings(self) -> tuple[str, ...]:
        """None, unless the kind of answer has some."""
        return ()


def ignored_effects(robot: Robot) -> tuple[str, ...]:
    """One sentence that names the robot's effects which steady motion ignores; empty if none."""
    names, of_servo = ignored_in_steady_cycle(robot), ignored_in_steady_cycle(robot, Port.ACTUATION)
    if not names:
        return ()
    text = (
        f"{listed(names)} {'is' if len(names) == 1 else 'are'} ignored: the motion is that on a "
        "level, uniform floor without side slip, driven by the angle that the servo makes."
    )
    if of_servo:
        text += f" Command the servo such that it makes this angle despite {listed(of_servo)}."
    return (text,)


def listed(names: tuple[str, ...] | list[str]) -> str:
    """`rate`, `rate and torque`, `angle, rate and torque`."""
    return " and ".join(filter(None, [", ".join(names[:-1]), names[-1]]))
