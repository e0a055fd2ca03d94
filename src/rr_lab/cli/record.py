"""`rr-opt record [ROBOT]`: recordings of a virtual robot, with known or sealed physics in it."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from rr_opt.cli.options import Summary, out_option, place, read_options, show
from rr_opt.cli.steps import StepDisplay


def record(
    robot: Annotated[
        Path | None,
        typer.Argument(
            metavar="[ROBOT]",
            help="Robot file; default: the paper's prototype, or a random one with --hide.",
        ),
    ] = None,
    *,
    gait: Annotated[
        list[str] | None,
        typer.Option(
            metavar="RUN",
            help="A run: '30 deg, 1.2 s, 10 deg, rest, holdout' are amplitude, period, offset, "
            "start (rest, running) and use (fit, holdout). Repeat for more runs; default: seven "
            "or eight random ones.",
        ),
    ] = None,
    effect: Annotated[
        list[str] | None,
        typer.Option(
            metavar="EFFECT",
            help="Physics that the nominal robot lacks: 'coulomb_friction:force1=2 mN,force2=2 mN'."
            " Repeat for more effects.",
        ),
    ] = None,
    hide: Annotated[
        str | None,
        typer.Option(
            metavar="KIND",
            help="Hide random physics: random, null, parameters, single, pair, outside, or "
            "single:EFFECT. Needs --seal.",
        ),
    ] = None,
    seal: Annotated[
        Path | None,
        typer.Option(
            parser=place,
            metavar="FILE",
            help="File for the sealed answer; its hash is written to the folder.",
        ),
    ] = None,
    seed: Annotated[
        int | None, typer.Option(help="Random seed; default: 0, or with --hide a new one.")
    ] = None,
    seconds: Annotated[
        str, typer.Option(help="Length of each run in s; of random runs, the longest.")
    ] = "30",
    noise: Annotated[
        str | None,
        typer.Option(help="Standard deviations of positions and angles.", show_default="random"),
    ] = None,
    missing: Annotated[float, typer.Option(help="Fraction of lost samples.", min=0, max=0.9)] = 0.0,
    disturbance: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            help="Disturb the recordings (csv): lowpass_6hz, ar1_noise, outliers, dropouts ...; "
            "docs/lab.md lists them all.",
            show_default="none",
        ),
    ] = "",
    engine: Annotated[
        Literal["mujoco", "planar"],
        typer.Option(help="Physics engine: MuJoCo, or two bodies in the plane."),
    ] = "mujoco",
    form: Annotated[
        Literal["csv", "vicon", "c3d"],
        typer.Option("--format", help="Joint and angles, or markers."),
    ] = "csv",
    servo_log: Annotated[
        bool, typer.Option("--servo-log", help="Add the servo's log, on its own clock.")
    ] = False,
    torque: Annotated[bool, typer.Option("--torque", help="Add the servo's torque (csv).")] = False,
    out: Annotated[Path | None, out_option("out/recorded")] = None,
    json: Summary = False,
) -> None:
    """Record a virtual robot.

    Writes an experiment folder: experiment.yaml, and a recording for each run.
    """
    with StepDisplay() as steps:
        from rr_lab.random_case import Request
        from rr_lab.record import nominal_robot, read_effects, read_noise, read_runs
        from rr_lab.record import record as written

        long = read_options(seconds=seconds)["seconds"]
        request = Request(
            nominal_robot(robot, hide), read_runs(gait or (), long), read_effects(effect or ()),
            read_noise(noise) if noise else None, hide, seed, long, missing, engine, disturbance,
        )  # fmt: skip
        done = written(
            out or Path("out/recorded"), request, seal=seal, form=form, servo_log=servo_log,
            torque=torque, progress=steps,
        )  # fmt: skip
    show(done, json=json)
