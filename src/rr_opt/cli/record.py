"""`rr-opt record [ROBOT]`: recordings of a virtual robot, with known or sealed physics in it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from rr_opt.cli.options import out_option
from rr_opt.cli.place import place
from rr_opt.cli.steps import Steps
from rr_opt.outcome import InputError

if TYPE_CHECKING:
    from rr_opt.robot.parameters import Robot


def record(
    robot: Annotated[
        Path | None,
        typer.Argument(
            metavar="[ROBOT]",
            help="Robot file; the paper's prototype, or with --hide one drawn by lot, if left out.",
        ),
    ] = None,
    *,
    gait: Annotated[
        list[str] | None,
        typer.Option(
            metavar="RUN",
            help="A run: '30 deg, 1.2 s, 10 deg, rest, holdout' are amplitude, period, offset, "
            "start (rest, running) and use (fit, holdout). Once for each run; seven or eight are "
            "drawn if left out.",
        ),
    ] = None,
    effect: Annotated[
        list[str] | None,
        typer.Option(
            metavar="EFFECT",
            help="What the nominal robot does not have: 'coulomb_friction:force1=2 mN,force2=2 mN'."
            " May be given more than once.",
        ),
    ] = None,
    hide: Annotated[
        str | None,
        typer.Option(
            metavar="KIND",
            help="Draw what is hidden: random, null, parameters, single, pair, outside, or "
            "single:EFFECT. Needs --seal.",
        ),
    ] = None,
    seal: Annotated[
        Path | None,
        typer.Option(
            parser=place, metavar="FILE", help="Write the answer there, and its hash to the folder."
        ),
    ] = None,
    seed: Annotated[
        int | None, typer.Option(help="Of all that is drawn; with --hide by chance if left out.")
    ] = None,
    seconds: Annotated[str, typer.Option(help="Length of each run, s.")] = "30",
    noise: Annotated[
        str | None, typer.Option(help="One sigma of positions and angles.", show_default="drawn")
    ] = None,
    missing: Annotated[
        float, typer.Option(help="Fraction of the samples that are lost.", min=0, max=0.9)
    ] = 0.0,
    engine: Annotated[
        Literal["mujoco", "planar"],
        typer.Option(help="What drives the robot: MuJoCo, or two bodies in the plane."),
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
    json: Annotated[
        bool, typer.Option("--json", help="Print a machine-readable summary alone on stdout.")
    ] = False,
) -> None:
    """Record a virtual robot.

    Writes an experiment folder: experiment.yaml, and a recording for each run.
    """
    with Steps() as steps:
        steps("reading")
        from rr_opt.cli.motion_input import read_options  # noqa: PLC0415
        from rr_opt.cli.record_files import require_apart, require_own, write_case  # noqa: PLC0415
        from rr_opt.cli.record_options import (  # noqa: PLC0415
            beyond_reach,
            read_effects,
            read_noise,
            read_runs,
        )
        from rr_opt.lab.case_of import case_of  # noqa: PLC0415
        from rr_opt.lab.delivery import Delivery  # noqa: PLC0415
        from rr_opt.lab.servo_log import drawn_clock  # noqa: PLC0415
        from rr_opt.lab.streams import stream  # noqa: PLC0415
        from rr_opt.report.archive import folder_for_results, strict_json  # noqa: PLC0415

        if hide and (effect or seal is None):
            raise InputError(
                "--hide draws what is hidden and seals the answer. Expected --seal FILE with it, "
                "and no --effect. Add the one, or leave out the other."
            )
        if torque and form != "csv":
            raise InputError(
                f"--torque came with --format {form}, which has no place for it. Expected "
                "--format csv. Leave one of them out."
            )
        folder = folder_for_results(out or Path("out/recorded"))
        require_apart(folder, seal)
        require_own(folder)
        long = read_options(seconds=seconds)["seconds"]
        steps("drawing the case")
        case = case_of(
            robot=_robot(robot, bool(hide)),
            plans=read_runs(gait or (), long),
            effects=read_effects(effect or ()),
            noise=read_noise(noise) if noise else None,
            kind=hide,
            seed=seed,
            seconds=long,
            missing=missing,
            engine=engine,
        )
        delivery = Delivery(form, servo_log, drawn_clock(stream(case.seed, "servo")), torque=torque)
        written = write_case(case, folder, seal, delivery, steps)
    for warning in beyond_reach(case.nominal, case.plans):
        typer.echo(warning, err=True)
    typer.echo(strict_json(written.record) if json else written.summary, nl=False)


def _robot(path: Path | None, drawn: bool) -> Robot | None:
    from rr_opt.files import read_problem, read_robot  # noqa: PLC0415

    if path is not None:
        return read_robot(path)
    return None if drawn else read_problem(None).robot
