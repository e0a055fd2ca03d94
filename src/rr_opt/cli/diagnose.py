"""`rr-opt diagnose FOLDER`: where the simulation goes wrong, what it leaves out, and how sure."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rr_opt.cli.options import json_option, out_option
from rr_opt.cli.steps import Steps
from rr_opt.outcome import NotConvergedError

if TYPE_CHECKING:
    from rr_opt.model.experiment import Experiment
    from rr_opt.sysid.diagnosis import Diagnosis


def diagnose(
    source: Annotated[
        Path,
        typer.Argument(metavar="FOLDER", help="Folder with an experiment.yaml and its recordings."),
    ],
    out: Annotated[Path | None, out_option("out/NAME-diagnosis")] = None,
    json: Annotated[bool, json_option("diagnosis.json")] = False,
    page: Annotated[
        bool, typer.Option("--page/--no-page", help="Draw figures and write report.html.")
    ] = True,
    workers: Annotated[
        int | None, typer.Option(help="Processes here.", min=1, show_default="two")
    ] = None,
) -> None:
    """Find where the simulation goes wrong, what it leaves out, how much of it, and how sure.

    Writes diagnosis.json, robot-corrected.yaml for the other verbs, and report.html.
    """
    with Steps() as steps:
        steps("reading")
        from rr_opt.cli.diagnose_input import read, usable
        from rr_opt.report.archive import folder_for_results, strict_json

        name, sha256, read_runs = read(source)
        folder = folder_for_results(out or Path("out") / f"{name}-diagnosis")
        experiment, left_out = usable(read_runs)
        found = _diagnosed(experiment, steps, workers)
        from rr_opt.answers.diagnosis import DiagnosisAnswer
        from rr_opt.report.diagnosis.files import summary, write_diagnosis
        from rr_opt.report.diagnosis.record import record

        told = DiagnosisAnswer(name, sha256, experiment, found, left_out)
        written = write_diagnosis(told, folder, page=page, progress=steps)
    for sentence in (*left_out, *told.doubts):
        typer.echo(sentence, err=True)
    if json:
        typer.echo(strict_json(record(told)), nl=False)
    else:
        typer.echo(summary(told, written), nl=False)


def _diagnosed(experiment: Experiment, steps: Steps, workers: int | None) -> Diagnosis:
    """The diagnosis, worked out in so many processes. Raises NotConvergedError."""
    from rr_opt.cli.shared_work import SharedWork

    with closing(SharedWork(workers)) as work:
        from rr_opt.machines.racer.diagnose import diagnose_racer
        from rr_opt.machines.racer.racer import RollerRacer
        from rr_opt.sysid.diagnose import Steps as Told

        racer = RollerRacer(experiment)
        found = diagnose_racer(racer, Told(say=steps, each=work))
    if not (found.before < float("inf") and found.after < float("inf")):
        raise NotConvergedError(
            "The fits did not converge: a simulation left the range of numbers. Expected motion "
            "near that of the nominal robot. Look at the recordings with `rr-opt inspect`, and "
            "check the robot's values."
        )
    return found
