"""`rr-opt turn [PROBLEM]`: the gait that turns fastest round a circle or through an angle."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Literal

import typer

from rr_opt.cli.options import (
    Figures,
    ProblemFile,
    json_option,
    out_option,
    read_options,
    read_problem,
    results_folder,
)
from rr_opt.cli.show import show
from rr_opt.cli.steps import Steps

_RADIUS = "Radius of the circle in m, or with a unit; positive to the left."
_HEADING = "Change of heading in rad, or with a unit: '90 deg'; positive to the left."
_CYCLES = "whole: the change of heading takes a whole number of periods."


def turn(
    problem: ProblemFile = None,
    *,
    radius: Annotated[str | None, typer.Option(help=_RADIUS)] = None,
    heading: Annotated[str | None, typer.Option(help=_HEADING)] = None,
    within: Annotated[
        str | None, typer.Option(help="Longest time for the change of heading, s.")
    ] = None,
    length: Annotated[
        str | None, typer.Option(help="Longest path for the change of heading, m.")
    ] = None,
    cycles: Annotated[Literal["any", "whole"], typer.Option(help=_CYCLES)] = "any",
    out: Annotated[Path | None, out_option("out/NAME-turn-...")] = None,
    json: Annotated[bool, json_option("result.json")] = False,
    figures: Figures = True,
) -> None:
    """Find the fastest gait for a turn.

    Give --radius; or --heading with --radius, --within or --length. Left is positive, seen from
    above, whichever way the robot drives. The problem sets the direction of travel.
    """
    with Steps() as steps:
        asked = read_options(radius=radius, heading=heading, within=within, length=length)
        posed = read_problem(problem)
        folder = results_folder(out, f"{posed.name}-turn-{_asked(asked, cycles)}")
        from rr_opt.api import fastest

        turned = fastest.turn(posed, **asked, whole=cycles == "whole", progress=steps)
        files = turned.save(folder, figures=figures, progress=steps)
    show(turned, files, json=json)


def _asked(asked: dict[str, float], cycles: str) -> str:
    """`heading-90deg-radius-0.5m-whole`, so that another turn has another folder."""
    parts = [
        f"{name}-{math.degrees(value):.6g}deg" if name == "heading" else f"{name}-{value:g}{unit}"
        for name, unit in (("heading", ""), ("radius", "m"), ("within", "s"), ("length", "m"))
        if (value := asked.get(name)) is not None
    ]
    return "-".join([*parts, *(["whole"] if cycles == "whole" else [])])
