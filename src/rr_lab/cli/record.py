"""`rr-opt record [ROBOT]`: recordings of a virtual robot, with known or sealed physics in it."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from rr_opt.cli.options import out_option, place
from rr_opt.cli.steps import Steps
from rr_opt.outcome import InputError

if TYPE_CHECKING:
    from rr_lab.case import Plan
    from rr_opt.model.experiment import Noise
    from rr_opt.model.robot import EffectUse, Robot


STARTS, USES = ("rest", "running"), ("fit", "holdout")


def read_runs(texts: Iterable[str], seconds: float) -> tuple[Plan, ...]:
    """`30 deg, 1.2 s, 10 deg, rest, holdout`: amplitude, period, offset; words may be left out.

    Raises InputError with everything that is wrong.
    """
    from rr_lab.case import Plan
    from rr_opt.cli.options import read_options
    from rr_opt.model.gait import SineGait

    plans, wrong = [], []
    for n, text in enumerate(texts, 1):
        parts = [part.strip() for part in text.split(",")]
        words = [part for part in parts if part in (*STARTS, *USES)]
        sizes = [part for part in parts if part not in words]
        start: Any = next((word for word in words if word in STARTS), "running")
        use: Any = next((word for word in words if word in USES), "fit")
        if len(sizes) not in (2, 3):
            wrong.append(
                f"--gait: Read {text!r}. Expected amplitude, period and offset, and rest, running, "
                "fit or holdout. Write for example '30 deg, 1.2 s, 0, rest, holdout'."
            )
            continue
        named = zip(("amplitude", "period", "offset"), sizes, strict=False)
        try:
            values = read_options(**dict(named))
        except InputError as error:
            wrong.append(f"--gait {text!r}: {error}")
            continue
        gait = SineGait(values["amplitude"], values["period"], values.get("offset", 0.0))
        # Headings differ, as a floor's slope shows in no single one.
        pose = (0.0, 0.0, 2.4 * (n - 1))
        plans.append(Plan(f"run{n:02d}.csv", gait, seconds, start, use, pose))
    if wrong:
        raise InputError("\n".join(wrong))
    return tuple(plans)


def beyond_reach(robot: Robot, plans: Iterable[Plan]) -> list[str]:
    """A warning for each run that turns the joint further than its servo can."""
    from rr_opt.answers.quantities import QUANTITIES

    angle, limit = QUANTITIES["angle"], robot.servo.angle_limit
    return [
        f"warning: {plan.name} goes to {angle.both(plan.gait.peak_angle)}, and the servo's limit "
        f"is {angle.both(limit)}. It is recorded as if the servo could. Plain numbers are radians: "
        "write `30 deg` for degrees."
        for plan in plans
        if plan.gait.peak_angle > limit
    ]


def read_effects(texts: Iterable[str]) -> tuple[EffectUse, ...]:
    """`coulomb_friction:force1=0.02,force2=20 mN` each. Raises InputError with all mistakes."""
    from rr_lab.effects import effect_named
    from rr_opt.model.robot import EffectUse
    from rr_opt.units import Quantity

    uses, wrong = [], []
    for text in texts:
        name, _, rest = text.partition(":")
        effect = effect_named(name.strip())
        units = effect.accepted
        values = {}
        for part in filter(None, (part.strip() for part in rest.split(","))):
            key, _, value = (piece.strip() for piece in part.partition("="))
            if key not in units:
                wrong.append(
                    f"--effect {name}: Read {part!r}. Expected {' or '.join(units)}. "
                    f"Write for example `{effect.parameters[0].name}=VALUE`."
                )
                continue
            unit = "" if units[key].unit == "1" else units[key].unit
            one = units[key]
            example = f"{one.typical:g} {unit}".strip()
            least = None if one.signed or one.neutral is None else 0.0
            try:
                values[key] = Quantity(unit, example, at_least=least).read(value)
            except InputError as error:
                wrong.append(f"--effect {name}, {key}: {error}")
        if not rest.strip():
            first = effect.parameters[0]
            example = f"{first.typical:g} {first.unit}".removesuffix(" 1")
            wrong.append(
                f"--effect {name}: Read no value, and without one it does nothing. Write for "
                f"example `{effect.name}:{first.name}={example}`."
            )
        uses.append(EffectUse(effect.name, values))
    if wrong:
        raise InputError("\n".join(wrong))
    return tuple(uses)


def read_noise(text: str) -> Noise:
    """`1 mm, 3 mrad`: standard deviations of position and angle. Raises InputError."""
    from rr_opt.model.experiment import Noise
    from rr_opt.units import Quantity

    parts = text.split(",")
    if len(parts) != 2:
        raise InputError(
            f"--noise: Read {text!r}. Expected that of positions and that of angles. Write for "
            "example '1 mm, 3 mrad'."
        )
    sizes = [
        Quantity(unit, example, above=0).read(part.strip())
        for unit, example, part in zip(("m", "rad"), ("1 mm", "3 mrad"), parts, strict=True)
    ]
    return Noise(*sizes)


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
            parser=place, metavar="FILE", help="File for the answer; its hash goes to the folder."
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
    json: Annotated[
        bool, typer.Option("--json", help="Print only a machine-readable summary on stdout.")
    ] = False,
) -> None:
    """Record a virtual robot.

    Writes an experiment folder: experiment.yaml, and a recording for each run.
    """
    with Steps() as steps:
        steps("reading")
        from rr_lab.case import Delivery, stream
        from rr_lab.cli.case_files import require_apart, require_own, write_case
        from rr_lab.formats import drawn_clock
        from rr_lab.random_case import case_of
        from rr_opt.cli.options import read_options
        from rr_opt.report.archive import folder_for_results, strict_json

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
        if disturbance and form != "csv":
            raise InputError(
                f"--disturbance came with --format {form}, whose markers it does not know. "
                "Expected --format csv. Leave one of them out."
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
            disturbance=disturbance,
        )
        delivery = Delivery(form, servo_log, drawn_clock(stream(case.seed, "servo")), torque=torque)
        written = write_case(case, folder, seal, delivery, steps)
    for warning in beyond_reach(case.nominal, case.plans):
        typer.echo(warning, err=True)
    typer.echo(strict_json(written.record) if json else written.summary, nl=False)


def _robot(path: Path | None, drawn: bool) -> Robot | None:
    from rr_opt.files.problem_file import read_problem
    from rr_opt.files.robot_file import read_robot

    if path is not None:
        return read_robot(path)
    return None if drawn else read_problem(None).robot
