"""A diagnosis with its experiment, and the speed that the nominal model would have cost.

The nominal robot's best gait is driven, in steady motion, by the corrected robot and compared with
that robot's own best gait. Both are optimised within the limits of the robot's servo and the bounds
of the shipped problem, with the robot's inertias as they are.
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
from rr_opt.messages import listed
from rr_opt.model.experiment import Experiment
from rr_opt.model.gait import Gait
from rr_opt.model.problem import Limits, Problem
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import ignored_in_steady_cycle
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import RollerRacerError
from rr_opt.sysid.diagnosis import Diagnosis, Finding, Misfit, Stage
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


def loss(experiment: Experiment, corrected: Robot) -> Loss | LossUnknown:
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
        return _unknown(f"{names} has no place in a steady motion.")
    try:
        before, after = (maximize_speed(_problem(one)) for one in (experiment.robot, corrected))
        if before.best is None or after.best is None or after.ratio is None:
            return _unknown(next(one.message for one in (before, after) if one.best is None))
        believed, best = before.best, after.best
        if check_optimum(after.problem, best.gait, after.ratio, best.speed).gap < -TOLERATED:
            return _unknown("a plain sweep finds a faster gait of the corrected robot.")
        reached = steady_cycle(corrected, servo_made(corrected, believed.gait)).speed
    except RollerRacerError as error:
        return _unknown(str(error))
    recorded = [run.gait for run in experiment.runs]
    unseen = any(
        one.gait.peak_angle > max(gait.peak_angle for gait in recorded)
        or one.gait.peak_rate > max(gait.peak_rate for gait in recorded)
        for one in (believed, best)
    )
    return Loss(believed.gait, believed.speed, reached, best.gait, best.speed, unseen)


def _unknown(why: str) -> LossUnknown:
    return LossUnknown(f"The speed that the nominal model's best gait would lose is unknown: {why}")


def _problem(robot: Robot) -> Problem:
    """What `maximize-speed` solves for a robot file, with the inertias left as they are."""
    shipped, servo = read_problem(), robot.servo
    limits = Limits(
        servo.angle_limit, servo.rate_limit, servo.torque_limit, shipped.limits.singularity
    )
    return replace(shipped, robot=robot, limits=limits, inertia_ratio=None)


_PREDICTS = 1.2
"""An empirical term accounts for what is missing if it leaves no more than this, in sigma."""


@dataclass(frozen=True, repr=False)
class DiagnosisAnswer:
    """The diagnosis of an experiment.

    name, sha256  of the input
    left_out      sentences on the recordings that could not be used
    """

    name: str
    sha256: str
    experiment: Experiment
    found: Diagnosis
    left_out: tuple[str, ...] = ()

    @property
    def verdict(self) -> str:
        """`consistent`, `parameters`, `missing_physics` or `unexplained`."""
        return self.found.verdict

    @property
    def effects(self) -> tuple[Finding, ...]:
        """The accepted effects, strongest first; for the verdict `parameters`, the parameters."""
        return tuple(self.found.findings)

    @property
    def message(self) -> str:
        """The diagnosis in a paragraph."""
        return self.found.summary

    @cached_property
    def corrected_robot(self) -> Robot:
        """The nominal robot with the estimated values and the accepted effects."""
        return corrected_robot(self.experiment, self.found)

    @cached_property
    def loss(self) -> Loss | LossUnknown | None:
        """What the nominal robot's best gait loses; None where the nominal model is right."""
        if self.verdict == "consistent":
            return None
        empirical = any(not CATALOGUE[use.name].candidate for use in self.corrected_robot.physics)
        if self.verdict == "unexplained" and not (empirical and self.found.after < _PREDICTS):
            return _unknown("the corrected robot lacks the physics that has no name.")
        return loss(self.experiment, self.corrected_robot)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences on the recordings that could not be used, then on those that were."""
        return (*self.left_out, *self.doubts)

    @property
    def doubts(self) -> tuple[str, ...]:
        """Sentences on the recordings that were used, each with its recording's name."""
        return tuple(
            f"{run.name}: {doubt}" for run in self.experiment.runs for doubt in run.recording.doubts
        )

    @property
    def guilty(self) -> tuple[Stage, ...]:
        """The stages that show a fault."""
        return tuple(stage for stage in self.found.stages if stage.guilty)

    @property
    def where(self) -> str:
        """Where the fault shows, in words; empty if unknown."""
        return self.found.where or "; ".join(one.where for one in self.guilty if one.where)

    @property
    def marked(self) -> bool:
        """Whether the experiment holds out a recording."""
        return any(one.held_out for one in self.found.final)

    @property
    def proven_on(self) -> str:
        """Which recordings the misfits before and after refer to, in words."""
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
