"""Recordings of a virtual robot: the folder of a case, and its sealed answer apart from it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from rr_lab.api.arguments import beyond_reach
from rr_lab.case import Case, Delivery, Plan, stream
from rr_lab.engines import Engine
from rr_lab.files import WRITTEN, folder_of, seal_of, sealed_text
from rr_lab.formats import drawn_clock
from rr_lab.random_case import case_of
from rr_opt.api.load import load_robot, prototype
from rr_opt.documents.archive import file_for_result, folder_for_results, write_bytes, write_text
from rr_opt.files.experiment_file import FILE_NAME
from rr_opt.model.experiment import Noise
from rr_opt.model.robot import EffectUse
from rr_opt.outcome import InputError
from rr_opt.results.result import Result

HASH = "answer.sha256"
"""In the folder: the answer's SHA-256, as sha256sum writes and checks it."""


@dataclass(frozen=True, repr=False)
class Recorded(Result):
    """A case that was written; digest is that of the sealed answer, "" without one."""

    case: Case
    folder: Path
    files: tuple[str, ...]
    seal: Path | None
    digest: str

    @property
    def warnings(self) -> tuple[str, ...]:
        """Which runs turn the joint further than its servo can."""
        return beyond_reach(self.case.nominal, self.case.plans)

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:  # noqa: ARG002
        """As plain data."""
        data = {"folder": str(self.folder), "files": list(self.files)}
        return {**data, "seal": str(self.seal), "sha256": self.digest} if self.seal else data

    def summary(self, files: Sequence[Path] = ()) -> str:  # noqa: ARG002
        """For a person."""
        text = f"{self.folder}: {len(self.case.plans)} recordings, {len(self.files)} files\n"
        if self.seal is None:
            return text
        return f"{text}sealed answer  {self.seal}\nSHA-256        {self.digest}\n"


def require_apart(folder: Path, seal: Path | None) -> None:
    """Raise InputError if the answer could not be written, or would lie among the recordings."""
    if seal is not None and file_for_result(seal).resolve().is_relative_to(folder.resolve()):
        raise InputError(
            f"The seal {seal} lies in the folder of the recordings. Expected a place outside it. "
            "Give another place with --seal."
        )


def require_own(folder: Path) -> None:
    """Raise InputError if an experiment is there that `record` did not write."""
    file = folder / FILE_NAME
    if file.is_file() and not file.read_bytes().startswith(WRITTEN.encode()):
        raise InputError(
            f"{file} was not written by `rr-opt record`, which would write over it. Give another "
            "place with --out."
        )


def write_case(
    case: Case, folder: Path, seal: Path | None, delivery: Delivery, progress: Callable[[str], None]
) -> Recorded:
    """Write the folder, and the answer if there is a place for it."""
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


def record(
    folder: str | Path,
    *,
    robot: str | Path | None = None,
    plans: tuple[Plan, ...] = (),
    effects: tuple[EffectUse, ...] = (),
    noise: Noise | None = None,
    hide: str | None = None,
    seal: Path | None = None,
    seed: int | None = None,
    seconds: float = 30.0,
    missing: float = 0.0,
    disturbance: str = "",
    engine: Engine = "mujoco",
    form: Literal["csv", "vicon", "c3d"] = "csv",
    servo_log: bool = False,
    torque: bool = False,
    progress: Callable[[str], None] = lambda _: None,
) -> Recorded:
    """Record a virtual robot into an experiment folder.

    robot          a robot file; None: the paper's prototype, or with `hide` a random one
    plans, noise   random if left out
    effects        physics that the nominal robot lacks
    hide, seal     a kind of case whose physics is random, and the file for its answer
    seconds        of each run; of random runs, the longest
    missing        fraction of lost samples
    servo_log      add the servo's log, on its own clock; torque: add the servo's torque

    Raises InputError for what does not go together, and for a folder with other recordings.
    """
    if hide and (effects or seal is None):
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
    folder = folder_for_results(Path(folder))
    require_apart(folder, seal)
    require_own(folder)
    progress("drawing the case")
    nominal = load_robot(robot) if robot else None if hide else prototype()
    case = case_of(
        robot=nominal,
        plans=plans,
        effects=effects,
        noise=noise,
        kind=hide,
        seed=seed,
        seconds=seconds,
        missing=missing,
        engine=engine,
        disturbance=disturbance,
    )
    delivery = Delivery(form, servo_log, drawn_clock(stream(case.seed, "servo")), torque=torque)
    return write_case(case, folder, seal, delivery, progress)
