"""The speed that the nominal model would cost.

The nominal robot's best gait is driven, in steady motion, by the corrected robot and compared with
that robot's own best gait. Both are optimised within the limits of the robot's servo and the bounds
of the shipped problem, with the robot's inertias as they are.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from rr_opt.effects import CATALOGUE
from rr_opt.effects.effect import Port
from rr_opt.files.problem_file import read_problem
from rr_opt.messages import listed
from rr_opt.model.experiment import Experiment
from rr_opt.model.gait import Gait
from rr_opt.model.problem import Limits, Problem
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import ignored_in_steady_cycle
from rr_opt.motion.servo import servo_made
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import RollerRacerError
from rr_opt.verify.sweep import TOLERATED, check_optimum


@dataclass(frozen=True)
class Loss:
    """What the nominal model costs; speeds in m/s, signed.

    believed, promised  the best gait of the nominal robot, and the speed that its model predicts
    reached             the corrected robot's speed with that gait
    best, speed         the corrected robot's own best gait; where its servo has a fault, the angle
                        that the servo has to be brought to make
    unseen              whether either gait demands more than was recorded
    """

    believed: Gait
    promised: float
    reached: float
    best: Gait
    speed: float
    unseen: bool

    @property
    def share(self) -> float:
        """The fraction lost of the speed of its own best gait; above 1 if it drives the other
        way."""
        return 1.0 - self.reached / math.copysign(self.speed, self.promised)


@dataclass(frozen=True)
class LossUnknown:
    """Why no loss can be given, in a sentence."""

    sentence: str


def loss_of(experiment: Experiment, corrected: Robot) -> Loss | LossUnknown:
    """The loss, where the effects of the corrected robot have a place in steady motion.

    Takes a second or two.
    """
    # Only a robot that differs from its nominal values needs the optimiser.
    from rr_opt.design.maximize_speed import maximize_speed

    # Servo effects are accounted for here, and the capture system does not change the motion.
    harmless = (Port.ACTUATION, Port.MEASUREMENT)
    gone = [n for n in ignored_in_steady_cycle(corrected) if CATALOGUE[n].port not in harmless]
    if gone:
        names = listed([name.replace("_", " ") for name in gone])
        have = "has" if len(gone) == 1 else "have"
        return unknown(f"{names} {have} no place in a steady motion.")
    try:
        before, after = (maximize_speed(_problem(one)) for one in (experiment.robot, corrected))
        if before.best is None or after.best is None or after.ratio is None:
            return unknown(next(one.message for one in (before, after) if one.best is None))
        believed, best = before.best, after.best
        if check_optimum(after.problem, best.gait, after.ratio, best.speed).gap < -TOLERATED:
            return unknown("a plain sweep finds a faster gait for the corrected robot.")
        reached = steady_cycle(corrected, servo_made(corrected, believed.gait)).speed
    except RollerRacerError as error:
        return unknown(str(error))
    recorded = [run.gait for run in experiment.runs]
    unseen = any(
        one.gait.peak_angle > max(gait.peak_angle for gait in recorded)
        or one.gait.peak_rate > max(gait.peak_rate for gait in recorded)
        for one in (believed, best)
    )
    return Loss(believed.gait, believed.speed, reached, best.gait, best.speed, unseen)


def unknown(why: str) -> LossUnknown:
    """No loss, and why."""
    return LossUnknown(f"The speed that the nominal model's best gait would lose is unknown: {why}")


def _problem(robot: Robot) -> Problem:
    """What `maximize-speed` solves for a robot file, with the inertias left as they are."""
    shipped, servo = read_problem(), robot.servo
    limits = Limits(
        servo.angle_limit, servo.rate_limit, servo.torque_limit, shipped.limits.singularity
    )
    return replace(shipped, robot=robot, limits=limits, inertia_ratio=None)
