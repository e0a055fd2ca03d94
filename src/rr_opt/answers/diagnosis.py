"""A diagnosis with the experiment that it is of, and what the wrong model would have cost.

What the wrong model would have cost: its best gait on the robot as it was found to be.

The best gait for the robot as believed is driven, in steady motion, by the robot as found, and
held against that one's own best gait. Both are sought within the limits of the robot's servo and
the bounds of the shipped problem, with the robot's inertias as they are.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from rr_opt.answers.corrected_robot import corrected_robot, servo_made
from rr_opt.effects import CATALOGUE
from rr_opt.effects.effect import Port
from rr_opt.files.problem_file import read_problem
from rr_opt.model.experiment import Experiment
from rr_opt.model.gait import Gait
from rr_opt.model.problem import Limits, Problem
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import passed_over
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import RollerRacerError
from rr_opt.sysid.diagnosis import Diagnosis, Misfit, Stage


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


_PREDICTS = 1.2
"""A term without a name accounts for what is missing if it leaves no more than this, in sigma."""


@dataclass(frozen=True)
class Diagnosed:
    """What there is to tell.

    name, sha256  of the input
    left_out      sentences on the recordings that could not be used
    """

    name: str
    sha256: str
    experiment: Experiment
    found: Diagnosis
    left_out: tuple[str, ...] = ()

    @cached_property
    def corrected(self) -> Robot:
        """The robot with what was found in it."""
        return corrected_robot(self.experiment, self.found)

    @cached_property
    def loss(self) -> Loss | NotTold | None:
        """What the best gait of the robot as believed loses; None where that robot is right."""
        if self.found.verdict == "consistent":
            return None
        curved = any(CATALOGUE[use.name].nameless for use in self.corrected.physics)
        predicts = curved and self.found.after < _PREDICTS
        if self.found.verdict == "unexplained" and not predicts:
            return NotTold(
                "What the best gait of the robot as believed would lose is not told: the robot as "
                "found lacks what has no name."
            )
        return loss(self.experiment, self.corrected)

    @property
    def doubts(self) -> tuple[str, ...]:
        """Sentences on the recordings that were used, each with its recording's name."""
        return tuple(
            f"{run.name}: {doubt}" for run in self.experiment.runs for doubt in run.recording.doubts
        )

    @property
    def guilty(self) -> tuple[Stage, ...]:
        """The stages in which a fault sits."""
        return tuple(stage for stage in self.found.stages if stage.guilty)

    @property
    def where(self) -> str:
        """Where the fault shows, in words; empty if nothing says."""
        return self.found.where or "; ".join(one.where for one in self.guilty if one.where)

    @property
    def marked(self) -> bool:
        """Whether the experiment keeps a recording apart from the fit."""
        return any(one.held_out for one in self.found.final)

    @property
    def proven_on(self) -> str:
        """What the misfits before and after are of, in words."""
        if self.marked:
            return "held-out recordings"
        several = len(self.found.final) > 1
        return "each recording, from the others" if several else "the one recording, fitted"

    @property
    def proof(self) -> tuple[int, ...]:
        """Places of the recordings that prove the fit: the held-out ones; all, if there are none.

        The worst explained by the nominal model come first.
        """
        nominal = self.found.nominal
        rows = [k for k, one in enumerate(nominal) if one.held_out] or range(len(nominal))
        return tuple(sorted(rows, key=lambda k: -nominal[k].rms))


def rms(misfits: Iterable[Misfit]) -> float:
    """Root mean square over all their values, in sigma; NaN of none."""
    squares: Sequence[np.ndarray] = [one.residuals.ravel() ** 2 for one in misfits]
    if not squares:
        return float("nan")
    return float(np.sqrt(np.nanmean(np.concatenate(squares))))
