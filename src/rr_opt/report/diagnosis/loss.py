"""What the wrong model would have cost: its best gait on the robot as it was found to be.

The best gait for the robot as believed is driven, in steady motion, by the robot as found, and
held against that one's own best gait. Both are sought within the limits of the robot's servo and
the bounds of the shipped problem, with the robot's inertias as they are.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from rr_opt.effects.effect import Port
from rr_opt.files.problem_file import read_problem
from rr_opt.model.experiment import Experiment
from rr_opt.model.gait import Gait
from rr_opt.model.problem import Limits, Problem
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import passed_over
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import RollerRacerError
from rr_opt.report.diagnosis.corrected import servo_made
from rr_opt.report.quantities import number, with_unit


@dataclass(frozen=True)
class Loss:
    """Speeds in m/s, signed.

    believed, promised  the best gait for the robot as believed, and what it would have made of it
    reached             what the robot as found makes of that gait
    best, speed         its own best gait; where its servo has a fault, an angle that the servo has
                        to be brought to make
    unseen              whether either gait asks for more than was recorded
    """

    believed: Gait
    promised: float
    reached: float
    best: Gait
    speed: float
    unseen: bool

    @property
    def share(self) -> float:
        """Of the speed of its own best gait, what is lost; more than 1 if the robot goes the other
        way."""
        return 1.0 - self.reached / math.copysign(self.speed, self.promised)


@dataclass(frozen=True)
class NotTold:
    """Why there is no loss to tell, in a sentence."""

    sentence: str


def loss(experiment: Experiment, corrected: Robot) -> Loss | NotTold:
    """The loss, where the effects of the robot as found have a place in steady motion.

    Takes a second or two.
    """
    # Only a robot found to be another one needs the optimiser.
    from rr_opt.design.maximize_speed import maximize_speed

    gone = [name for name in passed_over(corrected) if name not in _harmless(corrected)]
    if gone:
        names = " and ".join(name.replace("_", " ") for name in gone)
        return _not_told(f"{names} has no place in a steady motion.")
    robots = (experiment.robot, corrected)
    try:
        before, after = optima = [maximize_speed(_problem(robot)) for robot in robots]
        if before.best is None or after.best is None:
            return _not_told(next(one.message for one in optima if one.best is None))
        believed, best = before.best, after.best
        reached = steady_cycle(corrected, servo_made(corrected, believed.gait)).speed
    except RollerRacerError as error:
        return _not_told(str(error))
    asked = [run.gait for run in experiment.runs]
    unseen = any(
        one.gait.peak_angle > max(gait.peak_angle for gait in asked)
        or one.gait.peak_rate > max(gait.peak_rate for gait in asked)
        for one in (believed, best)
    )
    return Loss(believed.gait, believed.speed, reached, best.gait, best.speed, unseen)


def _harmless(robot: Robot) -> set[str]:
    """What steady motion passes over and the loss does not: what a servo does to its command is
    reckoned with, and what the capture system sees of the motion does not change it."""
    return {*passed_over(robot, Port.ACTUATION), *passed_over(robot, Port.MEASUREMENT)}


def _not_told(why: str) -> NotTold:
    return NotTold(f"What the best gait of the robot as believed would lose is not told: {why}")


def _problem(robot: Robot) -> Problem:
    """What `maximize-speed` is asked for a robot file, the inertias left as they are."""
    shipped, servo = read_problem(), robot.servo
    limits = Limits(
        servo.angle_limit, servo.rate_limit, servo.torque_limit, shipped.limits.singularity
    )
    return replace(shipped, robot=robot, limits=limits, inertia_ratio=None)


_NONE = 5e-4
"""A smaller share of the speed is not told as a loss."""


def share_lost(one: Loss) -> str:
    """`12 %`; `nothing` where it is less than a tenth of a per cent; `more than all` where the
    robot goes the other way."""
    if one.share > 1:
        return "more than all"
    return "nothing" if one.share < _NONE else f"{number(100 * one.share, 2)} %"


def pace(speed: float) -> str:
    """`298.3 mm/s forward`."""
    return f"{1e3 * abs(speed):.1f} mm/s {'forward' if speed > 0 else 'backward'}"


def loss_sentences(one: Loss | NotTold | None) -> str:
    """A few sentences; nothing where the robot as believed is right."""
    if one is None:
        return ""
    if isinstance(one, NotTold):
        return one.sentence
    said = (
        f"The best gait for the robot as believed ({gait_words(one.believed)}) promises "
        f"{pace(one.promised)}; the robot as found makes {pace(one.reached)} of it. Its own best "
        f"gait ({gait_words(one.best)}) makes {pace(one.speed)}. "
        f"Lost by the wrong model: {share_lost(one)}"
        f"{', as it drives the robot the other way' if one.share > 1 else ''}."
    )
    if one.unseen:
        said += " These gaits ask for more than was recorded: this is foretold, and not seen."
    return said


def loss_line(one: Loss | NotTold) -> str:
    """The same in a line."""
    if isinstance(one, NotTold):
        return one.sentence
    return (
        f"{share_lost(one)}: the best gait as believed promises {pace(one.promised)} and makes "
        f"{pace(one.reached)}; the best as found makes {pace(one.speed)}"
    )


def gait_words(gait: Gait) -> str:
    """`1.51 rad, 1.73 s`, and an offset if there is one."""
    said = f"{with_unit(gait.amplitude, 'rad', 3)}, {with_unit(gait.period, 's', 3)}"
    return f"{said}, offset {with_unit(gait.offset, 'rad', 3)}" if gait.offset else said


def loss_record(one: Loss | NotTold | None) -> dict[str, Any] | None:
    """diagnosis.json's `loss`: null where the robot as believed is right; SI."""
    if one is None:
        return None
    if isinstance(one, NotTold):
        return {"not_told": one.sentence}
    return {
        "gait_as_believed": _gait(one.believed),
        "speed_promised": one.promised,
        "speed_reached": one.reached,
        "gait_as_found": _gait(one.best),
        "speed_as_found": one.speed,
        "share_lost": one.share,
        "beyond_what_was_recorded": one.unseen,
    }


def _gait(gait: Gait) -> dict[str, float]:
    return {"amplitude": gait.amplitude, "period": gait.period, "offset": gait.offset}
