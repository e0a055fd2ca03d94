"""The verb that drives a route."""

from pathlib import Path
from typing import Annotated

import typer

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import StepDisplay


def route(
    route: Annotated[Path, typer.Argument(help="Route file: where to drive, and how exactly.")],
    out: Annotated[Path | None, options.out_option("out/NAME")] = None,
    json: Annotated[bool, options.json_option("route.json")] = False,
    figures: options.Figures = True,
    feedback: Annotated[
        bool,
        typer.Option(
            "--feedback", help="Also write the controller that keeps the robot on it: JSON and C."
        ),
    ] = False,
    animate: options.Film = None,
) -> None:
    """Drive a route from rest, as fast as the robot can.

    It consists of straights, arcs and waypoints. The drive is checked by simulation. `rr-opt init
    route` writes a file to start from.
    """
    with StepDisplay() as steps:
        asked = options.read(rr.load_route, route)
        folder = options.motion_folder(out, asked.name, animate)
        driven = rr.route(asked, feedback=feedback, progress=steps)
    show(driven, steps, folder, json=json, figures=figures, film=animate)
