"""What the wrong model would have cost: its best gait on the robot as it was found to be.

The best gait for the robot as believed is driven, in steady motion, by the robot as found, and
held against that one's own best gait. Both are sought within the limits of the robot's servo and
the bounds of the shipped problem, with the robot's inertias as they are.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from rr_opt.experiment.experiment import Experiment
from rr_opt.files import read_problem
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import RollerRacerError
from rr_opt.physics.effects import Port
from rr_opt.physics.steady_effects import passed_over
from rr_opt.problem import Limits, Problem
from rr_opt.report.diagnosis.servo_made import servo_made
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import Robot


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
    from rr_opt.design.maximize_speed import maximize_speed  # noqa: PLC0415

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
