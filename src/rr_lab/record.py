"""Recordings of a virtual robot: the folder of a case, and its sealed answer, kept separately."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rr_lab.case import Case, Plan, stream
from rr_lab.effects import Parameter, effect_named
from rr_lab.files import Delivery, Form, folder_of, is_own, seal_of, sealed_text
from rr_lab.formats import drawn_clock
from rr_lab.random_case import Request
from rr_opt.api.load import load_robot, prototype, read_arguments
from rr_opt.documents.archive import file_for_result, folder_for_results, write_bytes, write_text
from rr_opt.files.source import EXPERIMENT
from rr_opt.formatting import QUANTITIES, counted
from rr_opt.model.experiment import Noise
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse, Robot
from rr_opt.outcome import InputError
from rr_opt.results.result import Progress, Result, quiet
from rr_opt.units import Number

STARTS, USES = ("rest", "running"), ("fit", "holdout")


def nominal_robot(file: Path | None, kind: str | None) -> Robot | None:
    """The robot of a file, or the paper's prototype; None, meaning a random one, for a kind of
    case."""
    return load_robot(file) if file else None if kind else prototype()


def read_runs(texts: Iterable[str], seconds: float) -> tuple[Plan, ...]:
    """`30 deg, 1.2 s, 10 deg, rest, holdout`: amplitude, period, offset; words may be left out.

    Raises InputError with everything that is wrong.
    """
    plans, wrong = [], []
    for n, text in enumerate(texts, 1):
        parts = [part.strip() for part in text.split(",")]
        words = [part for part in parts if part in (*STARTS, *USES)]
        sizes = [part for part in parts if part not in words]
        start: Any = next((word for word in words if word in STARTS), "running")
        use: Any = next((word for word in words if word in USES), "fit")
        if len(sizes) not in (2, 3):
            wrong.append(
                f"--gait: Read {text!r}. Expected an amplitude, a period, an optional offset, "
                "and any of rest, running, fit and holdout. Write, for example, "
                "'30 deg, 1.2 s, 0, rest, holdout'."
            )
            continue
        named = zip(("amplitude", "period", "offset"), sizes, strict=False)
        try:
            values = read_arguments(dict(named), prefix="--")
        except InputError as error:
            wrong.append(f"--gait {text!r}: {error}")
            continue
        gait = SineGait(values["amplitude"], values["period"], values.get("offset", 0.0))
        # Headings differ, as a floor's slope is not visible in a single one.
        pose = (0.0, 0.0, 2.4 * (n - 1))
        plans.append(Plan(f"run{n:02d}.csv", gait, seconds, start, use, pose))
    if wrong:
        raise InputError("\n".join(wrong))
    return tuple(plans)


def beyond_reach(robot: Robot, plans: Iterable[Plan]) -> tuple[str, ...]:
    """A warning for each run that turns the joint further than its servo can."""
    angle, limit = QUANTITIES["angle"], robot.servo.angle_limit
    return tuple(
        f"{plan.name} reaches {angle.both(plan.gait.peak_angle)}, beyond the servo's limit of "
        f"{angle.both(limit)}. It is recorded as if the servo could reach it. Plain numbers are "
        "radians; for degrees write `30 deg`."
        for plan in plans
        if plan.gait.peak_angle > limit
    )


def read_effects(texts: Iterable[str]) -> tuple[EffectUse, ...]:
    """`coulomb_friction:force1=0.02,force2=20 mN` each. Raises InputError with all mistakes."""
    uses, wrong = [], []
    for text in texts:
        name, _, rest = text.partition(":")
        effect = effect_named(name.strip())
        first, values = effect.parameters[0], {}
        for part in filter(None, (part.strip() for part in rest.split(","))):
            key, _, value = (piece.strip() for piece in part.partition("="))
            if key not in effect.accepted:
                wrong.append(
                    f"--effect {name}: Read {part!r}. Expected {' or '.join(effect.accepted)}. "
                    f"Write, for example, `{first.name}=VALUE`."
                )
                continue
            try:
                values[key] = _quantity(effect.accepted[key]).read(value)
            except InputError as error:
                wrong.append(f"--effect {name}, {key}: {error}")
        if not rest.strip():
            wrong.append(
                f"--effect {name}: Read no value; without one it does nothing. Write, for "
                f"example, `{effect.name}:{first.name}={_quantity(first).example}`."
            )
        uses.append(EffectUse(name.strip(), values))
    if wrong:
        raise InputError("\n".join(wrong))
    return tuple(uses)


def _quantity(one: Parameter) -> Number:
    """The parser of a parameter's value."""
    unit = "" if one.unit == "1" else one.unit
    least = None if one.signed or one.neutral is None else 0.0
    return Number(unit, f"{one.typical:g} {unit}".strip(), at_least=least)


def read_noise(text: str) -> Noise:
    """`1 mm, 3 mrad`: standard deviations of position and angle. Raises InputError."""
    parts = text.split(",")
    if len(parts) != 2:
        raise InputError(
            f"--noise: Read {text!r}. Expected one standard deviation for positions and one for "
            "angles. Write, for example, '1 mm, 3 mrad'."
        )
    return Noise(
        Number("m", "1 mm", above=0).read(parts[0].strip()),
        Number("rad", "3 mrad", above=0).read(parts[1].strip()),
    )


HASH = "answer.sha256"
"""The file in the folder with the answer's SHA-256, in the format of sha256sum."""


@dataclass(frozen=True, repr=False)
class Recorded(Result):
    """A recorded case; digest is that of the sealed answer, "" without one."""

    case: Case
    folder: Path
    files: tuple[str, ...]
    seal: Path | None
    digest: str

    @property
    def warnings(self) -> tuple[str, ...]:
        """Which runs turn the joint further than its servo can."""
        return beyond_reach(self.case.nominal, self.case.plans)

    def _record(self) -> dict[str, Any]:
        data = {"folder": str(self.folder), "files": list(self.files)}
        return {**data, "seal": str(self.seal), "sha256": self.digest} if self.seal else data

    def summary(self) -> str:
        """The text for a terminal."""
        recordings = counted(len(self.case.plans), "recording")
        text = f"{self.folder}: {recordings}, {counted(len(self.files), 'file')}\n"
        if self.seal is None:
            return text
        return f"{text}sealed answer  {self.seal}\nSHA-256        {self.digest}\n"


def record(
    folder: str | Path,
    request: Request,
    *,
    seal: Path | None = None,
    form: Form = "csv",
    servo_log: bool = False,
    torque: bool = False,
    progress: Progress = quiet,
) -> Recorded:
    """Record a virtual robot into an experiment folder.

    seal       the file for the answer; required if the hidden effects are drawn
    servo_log  add the servo's log, on its own clock; torque: add the servo's torque

    Raises InputError for contradictory arguments, and for a folder with other recordings.
    """
    if request.kind and (request.effects or seal is None):
        raise InputError(
            "--hide draws the hidden physics and seals the answer. Expected --seal FILE, and no "
            "--effect. Add --seal, and drop --effect."
        )
    for option, given, why in (
        ("--torque", torque, "which cannot store it"),
        ("--disturbance", request.disturbance, "which it does not support"),
    ):
        if given and form != "csv":
            raise InputError(
                f"{option} was given with --format {form}, {why}. Expected --format csv. Leave "
                "out one of the two."
            )
    folder = folder_for_results(Path(folder))
    _require_apart(folder, seal)
    _require_own(folder)
    progress("drawing the case")
    case = request.case()
    delivery = Delivery(form, servo_log, drawn_clock(stream(case.seed, "servo")), torque=torque)
    files = []
    for name, content in folder_of(case, delivery, progress):
        write_bytes(folder / name, content)
        files.append(name)
    digest = ""
    if seal is not None:
        text = sealed_text(case)
        digest = seal_of(text)
        write_text(seal, text)
        write_text(folder / HASH, f"{digest}  {seal.name}\n")
        files.append(HASH)
    return Recorded(case, folder, tuple(files), seal, digest)


def _require_apart(folder: Path, seal: Path | None) -> None:
    """Raise InputError if the answer cannot be written, or would be among the recordings."""
    if seal is not None and file_for_result(seal).resolve().is_relative_to(folder.resolve()):
        raise InputError(
            f"The seal {seal} is inside the folder of the recordings. Expected a file outside it. "
            "Give another one with --seal."
        )


def _require_own(folder: Path) -> None:
    """Raise InputError for an experiment there that `record` did not write, or since changed."""
    file = folder / EXPERIMENT
    if file.is_file() and not is_own(file.read_bytes()):
        raise InputError(
            f"{file} was not written by `rr-opt record`, or has been edited since, and would be "
            "overwritten. Give another folder with --out, or delete it."
        )
