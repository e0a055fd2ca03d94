"""Why recordings of a robot differ from its simulation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from rr_opt.answers.diagnosis import DiagnosisAnswer
from rr_opt.api.identity import identity
from rr_opt.model.experiment import Experiment, Run
from rr_opt.outcome import NotConvergedError
from rr_opt.recordings.clock_fit import at_commanded_rate
from rr_opt.recordings.experiment import read_experiment
from rr_opt.recordings.usable import usable
from rr_opt.report.archive import folder_for_results
from rr_opt.report.result import Plots, Progress, Result, quiet


class ExplainedExperiment(DiagnosisAnswer, Result):
    """The diagnosis of an experiment.

    verdict          `consistent`, `parameters`, `missing_physics` or `unexplained`
    effects          accepted, strongest first, each with `name`, `confidence` and `parameters`,
                     whose `value`, `low` and `high` (95 %) are in SI; for the verdict `parameters`
                     those
    corrected_robot  the nominal robot with all of them, which any other function takes
    loss             what the best gait of the nominal robot would lose, or why that is unknown
    found            the whole diagnosis
    """

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """The content of diagnosis.json."""
        from rr_opt.report.diagnosis.record import record

        return record(self)

    def summary(self, files: Sequence[Path] = ()) -> str:
        """The verdict, what was found, and what to record next, as text."""
        from rr_opt.report.diagnosis.document import summary

        return summary(self, files)

    def plot(self) -> Plots:
        """Evidence, paths, misfit before and after, and the lost speed."""
        from rr_opt.report.figures.diagnosis import draw

        return Plots(draw(self)[0])

    def save(
        self, path: str | Path, *, figures: bool = True, progress: Progress = quiet
    ) -> list[Path]:
        """Write diagnosis.json, robot-corrected.yaml, the figures and the page."""
        from rr_opt.report.diagnosis.document import write_diagnosis

        return write_diagnosis(
            self, folder_for_results(Path(path)), page=figures, progress=progress
        )


def diagnose(
    experiment: Experiment | str | Path, *, progress: Progress = quiet
) -> ExplainedExperiment:
    """What the simulation of a robot leaves out, how strong it is, and how sure that is.

    experiment  or its folder

    Raises InputError for an experiment that cannot be used, with all reasons, and
    NotConvergedError if no simulation comes near the recordings.
    """
    if not isinstance(experiment, Experiment):
        experiment = read_experiment(experiment)
    name, sha256 = identity(experiment)
    trial, left_out = usable(_cleaned(experiment))
    trial = at_commanded_rate(trial)
    # Here and not above: a wrong input is reported before a second of imports.
    from rr_opt.machines.racer.racer import RollerRacer
    from rr_opt.sysid.diagnose import diagnose as identify

    found = identify(RollerRacer(trial), progress)
    if not (found.before < float("inf") and found.after < float("inf")):
        raise NotConvergedError(
            "The fits did not converge: a simulation left the range of numbers. Expected motion "
            "near that of the nominal robot. Look at the recordings with `rr-opt inspect`, and "
            "check the robot's values."
        )
    return ExplainedExperiment(name, sha256, trial, found, left_out)


def _cleaned(experiment: Experiment) -> Experiment:
    """With recordings that were made from arrays treated as those of files are."""
    from rr_opt.recordings.inspection import Circumstances, inspect

    def as_read(run: Run) -> Run:
        sigma = {
            channel: np.where(np.isfinite(known), known, experiment.noise.of(channel))
            for channel, known in run.recording.sigma.items()
        }
        stated = replace(run.recording, sigma=MappingProxyType(sigma))
        known = Circumstances(robot=experiment.robot, gait=run.gait, start=run.start)
        return replace(run, recording=inspect(stated, None, known).recording)

    runs = (run if run.recording.source else as_read(run) for run in experiment.runs)
    return replace(experiment, runs=tuple(runs))
