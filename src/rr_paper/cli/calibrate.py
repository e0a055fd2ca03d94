"""`rr-opt calibrate`: what the paper's nine averages say about its prototype, and the models."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rr_opt.cli.options import json_option, out_option
from rr_opt.cli.steps import Steps


def calibrate(
    out: Annotated[Path | None, out_option("out/calibration")] = None,
    json: Annotated[bool, json_option("calibration.json")] = False,
) -> None:
    """Estimate the prototype's unpublished parameters, and compare models.

    Uses the nine averages of Tables 2 and 3, for both readings of their columns, and shows which
    unknowns they do not identify. Takes two to three minutes.
    """
    with Steps() as steps:
        steps("starting")
        from rr_opt.report.archive import folder_for_results, strict_json

        folder = folder_for_results(out or Path("out") / "calibration")
        from rr_opt.report.text import terminal
        from rr_paper.calibration.calibration import calibrate as compute
        from rr_paper.report.calibration import document, record, write_calibration

        found = compute(steps)
        steps("files")
        written = write_calibration(found, folder)
    if json:
        typer.echo(strict_json(record(found)), nl=False)
    else:
        typer.echo(terminal(document(found, {}), written), nl=False)
