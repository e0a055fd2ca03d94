"""`rr-opt reproduce`: the paper's tables and figures again, and its statements checked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rr_opt.cli.options import Figures, json_option, out_option
from rr_opt.cli.problem_input import read
from rr_opt.cli.steps import Steps

if TYPE_CHECKING:
    from rr_paper.reproduction import Reproduction


_SETTLED = 20.0
"""After so long, s, a run from rest is steady."""


def reproduce(
    out: Annotated[Path | None, out_option("out/paper")] = None,
    json: Annotated[bool, json_option("reproduce.json")] = False,
    figures: Figures = True,
) -> None:
    """Compute the paper's tables and figures again, and check what it says.

    Takes about a minute. The robot is the shipped prototype.
    """
    with Steps() as steps:
        steps("reading")
        problem, sha256 = read(None)
        from rr_opt.report.archive import folder_for_results, strict_json

        folder = folder_for_results(out or Path("out") / "paper")
        from rr_paper.report.page import record, reproduced, summary, write_reproduction
        from rr_paper.reproduction import reproduce as compute

        found = compute(problem, steps)
        steps("MuJoCo")
        result = reproduced(found, sha256, _by_mujoco(found))
        steps("files")
        written = write_reproduction(result, folder, figures=figures)
    if json:
        typer.echo(strict_json(record(result)), nl=False)
    else:
        typer.echo(summary(result, written), nl=False)


def _by_mujoco(found: Reproduction) -> float | None:
    """The mean speed of the gait of Fig. 3 by the virtual laboratory, m/s; None without MuJoCo."""
    from importlib.util import find_spec

    if find_spec("mujoco") is None:
        typer.echo(
            "MuJoCo is not installed. It is a further witness for the signs of equation (3). "
            "Install it with `pip install 'rr-opt[lab]'`, or do without.",
            err=True,
        )
        return None
    from rr_lab.engines import record
    from rr_paper.tables import last_period

    gait = found.start.gait
    seen = record(found.loaded, gait, _SETTLED, "rest")
    x, y, psi = (seen.values[name] for name in ("x", "y", "psi"))
    return last_period(seen.t, x, y, psi, gait.period)
