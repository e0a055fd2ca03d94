"""Experiments with a machine other than the Roller Racer."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from rr_opt.files.issue import InvalidFileError, Issue, has_errors
from rr_opt.files.machine_file import machine_plan, read_machine_plan
from rr_opt.files.source import experiment_path, read_document
from rr_opt.machines.registry import RACER, machine_named
from rr_opt.messages import shown
from rr_opt.model.machine import Machine, MachineExperiment
from rr_opt.outcome import InputError, NotConvergedError
from rr_opt.recordings.machine_run import machine_experiment
from rr_opt.results.machine_diagnosis import ExplainedMachine
from rr_opt.results.machine_inspection import InspectedMachine
from rr_opt.results.result import Progress, quiet
from rr_opt.sysid.diagnosis import Diagnosis

if TYPE_CHECKING:
    from rr_opt.sysid import machine as sysid


def machine_of(path: str | Path) -> Machine | None:
    """The machine of an experiment; None for a Roller Racer's, and for a file that is no YAML.

    Raises InvalidFileError for a machine that there is not.
    """
    try:
        document = read_document(experiment_path(Path(path)))
    except InvalidFileError:
        return None
    word = document.data.get("machine", RACER)
    try:
        known = word if isinstance(word, str) else shown(word)
        return None if known == RACER else machine_named(known)
    except InputError as error:
        raise InvalidFileError([document.error(("machine",), str(error))]) from None


def load_machine(path: str | Path, machine: Machine) -> MachineExperiment:
    """The experiment with its recordings. Raises InvalidFileError with everything wrong."""
    experiment, issues = machine_experiment(read_machine_plan(path, machine))
    if has_errors(issues):
        raise InvalidFileError(issues)
    return experiment


def lint_machine(path: str | Path) -> list[Issue] | None:
    """All issues of an experiment with another machine; None for anything else."""
    try:
        machine = machine_of(path)
        if machine is None:
            return None
        plan, issues = machine_plan(path, machine)
        return [*issues, *(machine_experiment(plan)[1] if plan else ())]
    except InvalidFileError as error:
        return list(error.issues)


def inspect_machine(path: str | Path, machine: Machine) -> InspectedMachine:
    """What was read of an experiment. Raises InvalidFileError with everything wrong."""
    return InspectedMachine(load_machine(path, machine))


def diagnose_machine(experiment: MachineExperiment, progress: Progress = quiet) -> ExplainedMachine:
    """What a machine's model leaves out. Raises NotConvergedError if a simulation diverged."""
    from rr_opt.machines.ode import OdeModel

    model = OdeModel(experiment)
    found = identified(model, "machine", progress)
    return ExplainedMachine(experiment.name, experiment.sha256, experiment, found, model.horizon)


def identified(model: sysid.MachineModel, kind: str, progress: Progress) -> Diagnosis:
    """The diagnosis of a robot or another machine. Raises NotConvergedError likewise."""
    from rr_opt.sysid.diagnose import diagnose

    found = diagnose(model, progress)
    if not (found.before < math.inf and found.after < math.inf):
        raise NotConvergedError(
            "The fits did not converge: a simulation diverged. Expected motion near that of the "
            f"nominal {kind}. Look at the recordings with `rr-opt inspect`, and check the {kind}'s "
            "values."
        )
    return found
