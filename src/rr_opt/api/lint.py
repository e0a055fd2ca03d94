"""Input files: what is wrong in them, and their schemas."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rr_opt.files import schemas
from rr_opt.files.issue import Issue
from rr_opt.files.lint import experiment_file, lint_file


def schema(kind: str, machine: str = "racer") -> dict[str, Any]:
    """The JSON Schema (2020-12) of a kind of file: robot, problem, study or experiment.

    machine  of an experiment: racer, pendulum, servo or car
    Every field carries a description with its unit. Raises InputError for any other kind.
    """
    if machine == "racer" or kind != "experiment":
        return schemas.schema(kind)
    from rr_opt.files.machine_file import model_of
    from rr_opt.machines.registry import machine_named

    return schemas.schema_of(model_of(machine_named(machine))[0], f"{machine} experiment")


def lint(path: str | Path) -> list[Issue]:
    """Everything that is wrong or looks wrong in an input file and the files that it names.

    A robot, problem, study or experiment file, or the folder of a problem or an experiment, whose
    recordings are read too. An Issue has `level` (`error` or `warning`), `message`, `file`, `line`
    and `path`, the key. Nothing is raised.
    """
    experiment = experiment_file(path)
    if experiment is None:
        return lint_file(path)
    from rr_opt.api.machine import lint_machine

    if (found := lint_machine(experiment)) is not None:
        return found
    from rr_opt.recordings.experiment import experiment_of
    from rr_opt.recordings.usable import checked

    read, issues = experiment_of(experiment)
    if read is not None:
        usable, place = checked(read), str(experiment)
        issues += [Issue("error", "", text, file=place) for text in usable.wrong]
        issues += [Issue("warning", "", text, file=place) for text in usable.left_out.values()]
    return issues
