"""The laboratory's verbs.

`rr-opt prove`: random sealed cases, diagnosed blind, opened and scored. `rr-opt record [ROBOT]`:
recordings of a virtual robot, with known or sealed physics in it.
"""

from pathlib import Path
from typing import Annotated, Literal

import typer

from rr_opt.cli.options import Scheduler, Summary, Workers, out_option, place, read_options, show
from rr_opt.cli.steps import StepDisplay


def record(
    robot: Annotated[
        Path | None,
        typer.Argument(
            metavar="[ROBOT]",
            help="Robot file. Default: the paper's prototype, or with --hide a random robot.",
        ),
    ] = None,
    *,
    gait: Annotated[
        list[str] | None,
        typer.Option(
            metavar="RUN",
            help="One run: amplitude, period, offset, start (rest, running) and use (fit, "
            "holdout), as in '30 deg, 1.2 s, 10 deg, rest, holdout'. Repeat for more runs. "
            "Default: seven or eight random runs.",
        ),
    ] = None,
    effect: Annotated[
        list[str] | None,
        typer.Option(
            metavar="EFFECT",
            help="Physics missing from the nominal robot, such as "
            "'coulomb_friction:force1=2 mN,force2=2 mN'. Repeat for more effects.",
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
            help="Write the sealed answer to this file, and its hash to the folder.",
        ),
    ] = None,
    seed: Annotated[
        int | None, typer.Option(help="Random seed. Default: 0, or with --hide a new one.")
    ] = None,
    seconds: Annotated[
        str, typer.Option(help="Length of each run, s; of random runs, the maximum.")
    ] = "30",
    noise: Annotated[
        str | None,
        typer.Option(
            help="Standard deviations of position and angle: '1 mm, 3 mrad'.", show_default="random"
        ),
    ] = None,
    missing: Annotated[
        float, typer.Option(help="Fraction of samples to drop.", min=0, max=0.9)
    ] = 0.0,
    disturbance: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            help="Disturb the recordings (csv only): lowpass_6hz, ar1_noise, outliers, "
            "dropouts ...; docs/lab.md lists them all.",
            show_default="none",
        ),
    ] = "",
    engine: Annotated[
        Literal["mujoco", "planar"],
        typer.Option(help="Physics engine: MuJoCo (3D), or two bodies in the plane."),
    ] = "mujoco",
    form: Annotated[
        Literal["csv", "vicon", "c3d"],
        typer.Option("--format", help="Joint and angles (csv), or markers (vicon, c3d)."),
    ] = "csv",
    servo_log: Annotated[
        bool, typer.Option("--servo-log", help="Also write a servo log, on its own clock.")
    ] = False,
    torque: Annotated[
        bool, typer.Option("--torque", help="Also record the servo torque (csv only).")
    ] = False,
    out: Annotated[Path | None, out_option("out/recorded")] = None,
    json: Summary = False,
) -> None:
    """Record a virtual robot.

    Writes an experiment folder: experiment.yaml and one recording per run.
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


def prove(
    *,
    cases: Annotated[int, typer.Option(help="Number of cases.", min=1, max=999)] = 100,
    seed: Annotated[
        str | None,
        typer.Option(metavar="HEX", help="Random seed, in hex.", show_default="hash of the commit"),
    ] = None,
    kinds: Annotated[
        str | None,
        typer.Option(
            help="Only these kinds of case: null, single, pair, parameters, outside, disturbed; or "
            "single:EFFECT, pair:EFFECT+EFFECT, outside:EFFECT, disturbed:NAME.",
            show_default="all",
        ),
    ] = None,
    engine: Annotated[
        Literal["mujoco", "planar", "both"] | None,
        typer.Option(
            help="Physics engine; with both, each drives half of the cases of a kind.",
            show_default="both",
        ),
    ] = None,
    out: Annotated[Path | None, out_option("out/proof")] = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    case: Annotated[
        int | None,
        typer.Option(
            metavar="ID",
            help="Make and diagnose just this case (of the trial in --out, if there is one), and "
            "print the answer next to the diagnosis.",
            min=1,
        ),
    ] = None,
    make_only: Annotated[
        bool,
        typer.Option(
            "--make-only",
            help="Make and seal the cases (cases/ID, answers/ID.json), but do not diagnose them.",
        ),
    ] = False,
    restart: Annotated[
        bool, typer.Option("--restart", help="Start over, discarding the cases of an earlier run.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print only proof.json on stdout.")] = False,
) -> None:
    """Count how often `diagnose` gets sealed cases right.

    The laboratory draws the cases at random. To resume an interrupted run, repeat the command.
    """
    with StepDisplay() as steps:
        from rr_lab import prove as trial

        folder, basis = trial.basis(
            out or Path("out/proof"), seed=seed, kinds=kinds, engine=engine,
            resumed=case is not None,
        )  # fmt: skip
        if case is not None:
            found = trial.prove_case(folder, basis, case, progress=steps)
        else:
            found = trial.prove(
                folder, basis, cases, workers=workers, scheduler=scheduler, restart=restart,
                make_only=make_only, progress=steps,
            )  # fmt: skip
    show(found, steps, folder, json=json)
