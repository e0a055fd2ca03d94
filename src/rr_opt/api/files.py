"""Input files: their mistakes, and new ones to fill in."""

from importlib.resources import files
from pathlib import Path
from typing import Any, Literal

import numpy as np

from rr_opt.documents.archive import file_for_result, write_text
from rr_opt.documents.document import csv_columns
from rr_opt.files import lint as of_files
from rr_opt.files.experiment_file import read_plan
from rr_opt.files.fields import schema_of
from rr_opt.files.issue import Issue
from rr_opt.files.lint import experiment_file, lint_file
from rr_opt.files.source import EXPERIMENT
from rr_opt.outcome import InputError


def schema(kind: str, machine: str = "racer") -> dict[str, Any]:
    """The JSON Schema (2020-12) of a kind of file: robot, problem, study or experiment.

    machine  of an experiment: racer, pendulum, servo or car
    Every field carries a description with its unit. Raises InputError for any other kind.
    """
    if machine == "racer" or kind != "experiment":
        return of_files.schema(kind)
    from rr_opt.files.machine_file import model_of
    from rr_opt.machines.registry import machine_named

    return schema_of(model_of(machine_named(machine))[0], f"{machine} experiment")


def lint(path: str | Path) -> list[Issue]:
    """Everything that is wrong or suspicious in an input file and the files that it names.

    A robot, problem, study or experiment file, or the folder of a problem or an experiment, whose
    recordings are read too. An Issue has `level` (`error` or `warning`), `message`, `file`, `line`
    and `path`, the key. Nothing is raised.
    """
    experiment = experiment_file(path)
    if experiment is None:
        return lint_file(path)
    from rr_opt.api.recordings import lint_machine

    if (found := lint_machine(experiment)) is not None:
        return found
    from rr_opt.recordings.experiment import checked, experiment_of

    read, issues = experiment_of(experiment)
    if read is not None:
        (left_out, wrong), place = checked(read), str(experiment)
        issues += [Issue("error", "", text, file=place) for text in wrong]
        issues += [Issue("warning", "", text, file=place) for text in left_out.values()]
    return issues


Kind = Literal["robot", "problem", "study", "experiment", "route"]


def init(kind: Kind, path: str | Path | None = None, *, force: bool = False) -> list[Path]:
    """Write a commented input file, which can be used as it is; returns the files.

    kind   an experiment is a folder with simulated recordings, to be replaced by real ones
    path   of the file, default KIND.yaml; for an experiment the folder, default `experiment`
    force  overwrite existing files

    Raises InputError for a file that exists, unless force.
    """
    text = (files("rr_opt") / "data" / "templates" / f"{kind}.yaml").read_text(encoding="utf-8")
    if kind != "experiment":
        place = Path(path or f"{kind}.yaml")
        _require_new([place], force)
        return [write_text(place, text)]
    folder = Path(path or kind)
    places = [folder / EXPERIMENT, *(folder / f"run{number}.csv" for number in (1, 2, 3))]
    _require_new(places, force)
    # The recordings are first: the experiment file names them.
    for place in places[1:]:
        write_text(place, "t,x,y,psi,phi\n")
    write_text(places[0], text)
    _record(folder)
    return places


def _require_new(places: list[Path], force: bool) -> None:
    for place in places:
        file_for_result(place)
        if place.exists() and not force:
            raise InputError(
                f"{place}: The file exists. Expected a new name. Choose one with --out, or "
                "overwrite it with --force."
            )


_SECONDS, _RATE = 12.0, 50.0


def _record(folder: Path) -> None:
    """Simulate the recordings of an experiment, with its noise."""
    from rr_opt.motion.rollout import rollout

    plan, _ = read_plan(folder)
    draw = np.random.default_rng(1)
    for run in plan.runs:
        driven = rollout(plan.robot, run.gait, _SECONDS, "steady", _RATE)
        columns = {"t": driven.t}
        for name in ("x", "y", "psi", "phi"):
            noise = plan.noise.of(name) * draw.normal(size=len(driven.t))
            columns[name] = getattr(driven, name) + noise
        write_text(run.file, csv_columns(list(columns), columns.values(), digits=6))
