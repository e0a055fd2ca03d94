"""A diagnosis with the experiment that it is of."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rr_opt.diagnose.diagnosis import Diagnosis, Misfit, Stage
from rr_opt.experiment.experiment import Experiment
from rr_opt.physics.effects import CATALOGUE
from rr_opt.report.diagnosis.corrected import corrected_robot
from rr_opt.report.diagnosis.loss import Loss, NotTold, loss
from rr_opt.robot.parameters import Robot

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
