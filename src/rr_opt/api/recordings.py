"""Recordings: checking them, and diagnosing why the machine differs from its simulation."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, NoReturn

import numpy as np

from rr_opt.api.load import identity, load_experiment
from rr_opt.documents.archive import file_for_result
from rr_opt.files.experiment_file import read_plan
from rr_opt.files.issue import InvalidFileError, Issue, has_errors
from rr_opt.files.machine_file import machine_plan, read_machine_plan
from rr_opt.files.source import experiment_path, fingerprint, read_document, recording_path
from rr_opt.machines.registry import RACER, machine_named
from rr_opt.messages import shown
from rr_opt.model.experiment import Experiment, Run, Start
from rr_opt.model.gait import Gait
from rr_opt.model.machine import Machine, MachineExperiment
from rr_opt.outcome import InputError, NotConvergedError
from rr_opt.recordings.clock_fit import at_commanded_rate
from rr_opt.recordings.experiment import inspect_experiment, is_experiment, usable
from rr_opt.recordings.inspection import Circumstances, inspected
from rr_opt.recordings.machine_run import machine_experiment
from rr_opt.recordings.readers import ReadOptions
from rr_opt.recordings.readers.plain_csv import columns_from
from rr_opt.results.inspection import InspectedMachine, InspectedRecordings
from rr_opt.results.result import Progress, quiet

if TYPE_CHECKING:
    from rr_opt.results.diagnosis import ExplainedExperiment
    from rr_opt.results.machine_diagnosis import ExplainedMachine
    from rr_opt.sysid.diagnosis import Diagnosis
    from rr_opt.sysid.machine import MachineModel


def inspect(
    source: str | Path,
    *,
    layout: str | Path | None = None,
    servo_log: str | Path | None = None,
    columns: Mapping[str, str] | None = None,
    gait: Gait | None = None,
    start: Start = "running",
    progress: Progress = quiet,
) -> InspectedRecordings | InspectedMachine:
    """A recording, or all of an experiment's folder, read and cleaned.

    Nothing is filled in or dropped: outliers are flagged, gaps stay gaps. For a single recording:

    layout     YAML file that says where each marker sits; None: estimated
    servo_log  the servo's log, on its own clock
    columns    by channel, the column of a text file that has it: `{"psi": "yaw [deg]"}`
    gait       the command
    start      `rest`: the robot stood still until t = 0

    Raises InputError for what cannot be read.
    """
    path = recording_path(Path(source))
    if is_experiment(path):
        given = {"layout": layout, "servo_log": servo_log, "columns": columns, "gait": gait}
        wrong = [name for name, value in given.items() if value is not None]
        if wrong:
            _refuse(wrong)
        if (machine := machine_of(path)) is not None:
            return InspectedMachine(load_machine(path, machine))
        found = inspect_experiment(path, progress)
        sha256 = read_plan(path)[0].sha256
    else:
        layout_file = None if layout is None else Path(layout)
        log = None if servo_log is None else recording_path(Path(servo_log))
        known = Circumstances(
            options=ReadOptions(columns=columns_from(columns or {})),
            gait=gait, start=start, servo_log=log,
        )  # fmt: skip
        found = [inspected(path, known, layout=layout_file)]
        sha256 = fingerprint([path])
    return InspectedRecordings(name_of(path), sha256, tuple(found))


def name_of(source: Path) -> str:
    """The name of an inspection: the experiment's folder, or the recording's file."""
    full = source.resolve()
    if source.is_dir() or full.name == "experiment.yaml":
        return full.name if source.is_dir() else full.parent.name
    return full.stem


def check_files(source: Path, netcdf: Path | None) -> None:
    """Raise InputError, before anything is read, for a netCDF file that cannot be made."""
    if netcdf is None:
        return
    file_for_result(netcdf)
    if is_experiment(source):
        _refuse(["netcdf"])


def _refuse(given: list[str]) -> NoReturn:
    """Raise InputError: an experiment file has these settings itself."""
    options = " and ".join(f"--{name.replace('_', '-')}" for name in given)
    raise InputError(
        f"Read {options} with an experiment. Expected a single recording: the experiment's file "
        "says how each was made. Name the file of a recording."
    )


def diagnose(
    experiment: Experiment | MachineExperiment | str | Path, *, progress: Progress = quiet
) -> ExplainedExperiment | ExplainedMachine:
    """The physics missing from a robot's simulation, with its size and confidence.

    experiment  or its folder

    Raises InputError for an unusable experiment, with all reasons, and NotConvergedError if no
    simulation comes close to the recordings.
    """
    if isinstance(experiment, str | Path):
        experiment = load_experiment(experiment)
    if isinstance(experiment, MachineExperiment):
        from rr_opt.machines.ode import OdeModel
        from rr_opt.results.machine_diagnosis import ExplainedMachine

        model, own = OdeModel(experiment), (experiment.name, experiment.sha256, experiment)
        return ExplainedMachine(*own, _identified(model, "machine", progress), model.horizon)
    name, sha256 = identity(experiment)
    trial, left_out = usable(_cleaned(experiment))
    trial = at_commanded_rate(trial)
    # Imported here: a wrong input is reported before a second of imports.
    from rr_opt.machines.racer.racer import RollerRacer
    from rr_opt.results.diagnosis import ExplainedExperiment

    found = _identified(RollerRacer(trial), "robot", progress)
    return ExplainedExperiment(name, sha256, trial, found, left_out)


def _cleaned(experiment: Experiment) -> Experiment:
    """The experiment with recordings from arrays cleaned like those from files."""
    from rr_opt.recordings.inspection import inspect

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


def machine_of(path: str | Path) -> Machine | None:
    """The machine of an experiment; None for a Roller Racer, and for a file that is not YAML.

    Raises InvalidFileError for an unknown machine.
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


def _identified(model: MachineModel, kind: str, progress: Progress) -> Diagnosis:
    """The diagnosis of a robot or another machine. Raises NotConvergedError if it diverged."""
    from rr_opt.sysid.diagnose import diagnose

    found = diagnose(model, progress)
    if not (found.before < math.inf and found.after < math.inf):
        raise NotConvergedError(
            "The fits did not converge: a simulation diverged. Expected motion close to that of "
            f"the nominal {kind}. Look at the recordings with `rr-opt inspect`, and check the "
            f"{kind}'s values."
        )
    return found
