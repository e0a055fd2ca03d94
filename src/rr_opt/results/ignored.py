"""Which effects of a robot its steady motion ignores, as a warning."""

from __future__ import annotations

from rr_opt.effects.effect import Port
from rr_opt.messages import listed
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import ignored_in_steady_cycle


def ignored_effects(robot: Robot, *, told: bool = False) -> tuple[str, ...]:
    """One sentence that names the robot's effects which steady motion ignores; empty if none.

    told  gaits are what the servo is told, so that its effects count
    """
    names, of_servo = ignored_in_steady_cycle(robot), ignored_in_steady_cycle(robot, Port.ACTUATION)
    if told:
        names, of_servo = tuple(name for name in names if name not in of_servo), ()
    if not names:
        return ()
    text = (
        f"{listed(names)} {'is' if len(names) == 1 else 'are'} ignored: the motion is "
        "computed for a level, uniform floor without side slip"
        f"{'' if told else ' and for the angle that the servo makes'}."
    )
    if of_servo:
        text += f" Command the servo so that it makes this angle despite {listed(of_servo)}."
    return (text,)
