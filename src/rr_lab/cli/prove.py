"""`rr-opt prove`: random sealed cases, diagnosed blind, opened and scored."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from rr_opt.cli.options import Scheduler, Workers, out_option, show
from rr_opt.cli.steps import StepDisplay


def prove(
    *,
    cases: Annotated[int, typer.Option(help="Number of cases.", min=1, max=999)] = 100,
    seed: Annotated[
        str | None,
        typer.Option(
            metavar="HEX", help="Random seed, hexadecimal.", show_default="hash of the commit"
        ),
    ] = None,
    kinds: Annotated[
        str | None,
        typer.Option(
            help="Only these: null, single, pair, parameters, outside, disturbed; or "
            "single:EFFECT, pair:EFFECT+EFFECT, outside:EFFECT, disturbed:NAME.",
            show_default="all",
        ),
    ] = None,
    engine: Annotated[
        Literal["mujoco", "planar", "both"] | None,
        typer.Option(
            help="Physics engine: one of the two, or each for half of each kind.",
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
            help="Make and diagnose only this case, of the trial in --out if there is one, and "
            "print the answer with the diagnosis.",
            min=1,
        ),
    ] = None,
    make_only: Annotated[
        bool,
        typer.Option(
            "--make-only",
            help="Only make and seal the cases, as cases/ID and answers/ID.json; diagnose none.",
        ),
    ] = False,
    restart: Annotated[
        bool, typer.Option("--restart", help="Discard the cases of an earlier run.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print only proof.json on stdout.")] = False,
) -> None:
    """Count how often `diagnose` is right on sealed cases.

    The laboratory draws them. An interrupted run resumes when the same command is repeated.
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
