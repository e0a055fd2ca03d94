"""Why recordings of a robot differ from its simulation."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import numpy as np

from rr_opt.api.identity import identity
from rr_opt.api.load import load_experiment
from rr_opt.api.machine import diagnose_machine
from rr_opt.documents.report import Progress, quiet
from rr_opt.model.experiment import Experiment, Run
from rr_opt.model.machine import MachineExperiment
from rr_opt.outcome import NotConvergedError
from rr_opt.recordings.clock_fit import at_commanded_rate
from rr_opt.recordings.usable import usable
from rr_opt.results.diagnosis import ExplainedExperiment
from rr_opt.results.machine_diagnosis import ExplainedMachine


def diagnose(
    experiment: Experiment | MachineExperiment | str | Path, *, progress: Progress = quiet
) -> ExplainedExperiment | ExplainedMachine:
    """What the simulation of a robot leaves out, how strong it is, and how sure that is.

    experiment  or its folder

    Raises InputError for an experiment that cannot be used, with all reasons, and
    NotConvergedError if no simulation comes near the recordings.
    """
    if isinstance(experiment, str | Path):
        experiment = load_experiment(experiment)
    if isinstance(experiment, MachineExperiment):
        return diagnose_machine(experiment, progress)
    name, sha256 = identity(experiment)
    trial, left_out = usable(_cleaned(experiment))
    trial = at_commanded_rate(trial)
    # Here and not above: a wrong input is reported before a second of imports.
    from rr_opt.machines.racer.racer import RollerRacer
    from rr_opt.sysid.diagnose import diagnose as identify

    found = identify(RollerRacer(trial), progress)
    if not (found.before < float("inf") and found.after < float("inf")):
        raise NotConvergedError(
            "The fits did not converge: a simulation diverged. Expected motion "
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
