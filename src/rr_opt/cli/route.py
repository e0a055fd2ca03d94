"""`rr-opt route ROUTE`: the fastest drive from rest along straights, arcs and waypoints."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.steps import Steps


def route(
    route: Annotated[Path, typer.Argument(help="Route file: where to drive, and how exactly.")],
    out: Annotated[Path | None, options.out_option("out/NAME")] = None,
    json: Annotated[bool, options.json_option("route.json")] = False,
    figures: options.Figures = True,
) -> None:
    """Drive a route of straights, arcs and waypoints from rest, as fast as the robot can.

    The drive is checked by simulation. `rr-opt init route` writes a file to begin with.
    """
    with Steps() as steps:
        asked = options.read_route(route)
        folder = options.results_folder(out, asked.name)
        driven = rr.route(asked, progress=steps)
        files = driven.save(folder, figures=figures, progress=steps)
    options.show(driven, files, json=json)
