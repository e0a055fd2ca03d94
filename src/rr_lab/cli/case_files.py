"""The files that `record` writes: the folder of a case, and its sealed answer apart from it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rr_lab.case import Case, Delivery
from rr_lab.files import WRITTEN, folder_of, seal_of, sealed_text
from rr_opt.files.experiment_file import FILE_NAME
from rr_opt.outcome import InputError
from rr_opt.report.archive import file_for_result, write_bytes, write_text

HASH = "answer.sha256"
"""In the folder: the answer's SHA-256, as sha256sum writes and checks it."""


@dataclass(frozen=True)
class Written:
    """What was written; digest is that of the sealed answer, "" without one."""

    folder: Path
    files: tuple[str, ...]
    recordings: int
    seal: Path | None
    digest: str

    @property
    def record(self) -> dict[str, Any]:
        """As plain data."""
        told = {"folder": str(self.folder), "files": list(self.files)}
        return {**told, "seal": str(self.seal), "sha256": self.digest} if self.seal else told

    @property
    def summary(self) -> str:
        """For a person."""
        text = f"{self.folder}: {self.recordings} recordings, {len(self.files)} files\n"
        if self.seal is None:
            return text
        return f"{text}sealed answer  {self.seal}\nSHA-256        {self.digest}\n"


def require_apart(folder: Path, seal: Path | None) -> None:
    """Raise InputError if the answer could not be written, or would lie among the recordings."""
    if seal is not None and file_for_result(seal).resolve().is_relative_to(folder.resolve()):
        raise InputError(
            f"The seal {seal} lies in the folder of the recordings. Expected it apart from them. "
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
) -> Written:
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
    return Written(folder, tuple(files), len(case.plans), seal, digest)
