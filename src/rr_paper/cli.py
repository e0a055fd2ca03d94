"""The verbs of the paper: `rr-opt reproduce` and `rr-opt calibrate`."""

from pathlib import Path
from typing import Annotated

from rr_opt.cli.options import Figures, json_option, out_option, results_folder, show
from rr_opt.cli.steps import StepDisplay


def calibrate(
    out: Annotated[Path | None, out_option("out/calibration")] = None,
    json: Annotated[bool, json_option("calibration.json")] = False,
) -> None:
    """Estimate the prototype's unpublished parameters.

    Fits the nine averages of Tables 2 and 3 under both readings of their columns, compares models,
    and shows which unknowns the averages cannot identify. Takes two to three minutes.
    """
    with StepDisplay() as steps:
        steps("starting")
        folder = results_folder(out, "calibration")
        from rr_paper.calibration import calibrate as compute

        found = compute(steps)
    show(found, steps, folder, json=json)


def reproduce(
    out: Annotated[Path | None, out_option("out/paper")] = None,
    json: Annotated[bool, json_option("reproduce.json")] = False,
    figures: Figures = True,
) -> None:
    """Recompute the paper's tables and figures.

    Also checks its statements. Uses the shipped prototype, and takes about a minute.
    """
    with StepDisplay() as steps:
        steps("reading")
        from rr_opt.api.load import shipped

        problem, folder = shipped(), results_folder(out, "paper")
        from rr_paper import reproduction

        found = reproduction.reproduce(problem, steps)
    show(found, steps, folder, json=json, figures=figures)
