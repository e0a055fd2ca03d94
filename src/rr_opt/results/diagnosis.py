"""The diagnosis of an experiment."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from rr_opt.documents.report import Progress, quiet
from rr_opt.effects import CATALOGUE
from rr_opt.model.experiment import Experiment
from rr_opt.model.robot import Robot
from rr_opt.results.corrected_robot import corrected_robot
from rr_opt.results.loss import Loss, LossUnknown, loss_of, unknown
from rr_opt.results.result import Result
from rr_opt.sysid.diagnosis import Diagnosis, Finding, Stage

_PREDICTS = 1.2
"""An empirical term accounts for what is missing if it leaves no more than this, in sigma."""


@dataclass(frozen=True, repr=False)
class ExplainedExperiment(Result):
    """The diagnosis of an experiment.

    name, sha256     of the input
    verdict          `consistent`, `parameters`, `missing_physics` or `unexplained`
    effects          accepted, strongest first, each with `name`, `confidence` and `parameters`,
                     whose `value`, `low` and `high` (95 %) are in SI; for the verdict `parameters`
                     those
    corrected_robot  the nominal robot with all of them, which any other function takes
    loss             what the best gait of the nominal robot would lose, or why that is unknown
    found            the whole diagnosis
    left_out         sentences on the recordings that could not be used
    """

    REPORT = "rr_opt.report.diagnosis.document"

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
            return unknown("the corrected robot lacks the physics that has no name.")
        return loss_of(self.experiment, self.corrected_robot)

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

    def save(
        self, path: str | Path, *, figures: bool = True, progress: Progress = quiet
    ) -> list[Path]:
        """Write diagnosis.json, robot-corrected.yaml, the figures and the page."""
        progress("the best gait, as believed and as found")
        return super().save(path, figures=figures, progress=progress)
