"""Recordings of a virtual robot: the folder of a case, and its sealed answer apart from it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rr_lab.api.arguments import beyond_reach
from rr_lab.case import Case, stream
from rr_lab.files import WRITTEN, Delivery, Form, folder_of, seal_of, sealed_text
from rr_lab.formats import drawn_clock
from rr_lab.random_case import Request
from rr_opt.documents.archive import file_for_result, folder_for_results, write_bytes, write_text
from rr_opt.documents.report import Progress, quiet
from rr_opt.files.experiment_file import FILE_NAME
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

    seal       the file for the answer; needed if a kind of case draws what is hidden
    servo_log  add the servo's log, on its own clock; torque: add the servo's torque

    Raises InputError for what does not go together, and for a folder with other recordings.
    """
    if request.kind and (request.effects or seal is None):
        raise InputError(
            "--hide draws what is hidden and seals the answer. Expected --seal FILE with it, "
            "and no --effect. Add the one, or leave out the other."
        )
    for option, given, why in (
        ("--torque", torque, "which has no place for it"),
        ("--disturbance", request.disturbance, "whose markers it does not know"),
    ):
        if given and form != "csv":
            raise InputError(
                f"{option} came with --format {form}, {why}. Expected --format csv. Leave one of "
                "them out."
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
    """Raise InputError if the answer could not be written, or would lie among the recordings."""
    if seal is not None and file_for_result(seal).resolve().is_relative_to(folder.resolve()):
        raise InputError(
            f"The seal {seal} lies in the folder of the recordings. Expected a place outside it. "
            "Give another place with --seal."
        )


def _require_own(folder: Path) -> None:
    """Raise InputError if an experiment is there that `record` did not write."""
    file = folder / FILE_NAME
    if file.is_file() and not file.read_bytes().startswith(WRITTEN.encode()):
        raise InputError(
            f"{file} was not written by `rr-opt record`, which would write over it. Give another "
            "place with --out."
        )
