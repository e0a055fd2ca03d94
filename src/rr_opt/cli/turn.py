"""`rr-opt turn [PROBLEM]`: the gait that turns fastest round a circle or through an angle."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import Steps


def turn(
    problem: options.ProblemFile = None,
    *,
    radius: options.Radius = None,
    heading: options.Heading = None,
    within: options.Within = None,
    length: options.Length = None,
    cycles: options.Cycles = "any",
    out: Annotated[Path | None, options.out_option("out/NAME-turn-...")] = None,
    json: Annotated[bool, options.json_option("result.json")] = False,
    figures: options.Figures = True,
) -> None:
    """Find the fastest gait for a turn.

    Give --radius; or --heading with --radius, --within or --length. Left is positive, seen from
    above, in either direction of travel. The problem sets the direction of travel.
    """
    with Steps() as steps:
        asked = options.read_options(radius=radius, heading=heading, within=within, length=length)
        posed = options.read_problem(problem)
        folder = options.turn_folder(out, posed.name, asked, cycles)
        turned = rr.turn(posed, **asked, whole=cycles == "whole", progress=steps)
        files = turned.save(folder, figures=figures, progress=steps)
    show(turned, files, json=json)
