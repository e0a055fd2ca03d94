"""The journal of a study: each finished row a line, so that a run that was stopped can go on.

A line is written, flushed and synced before the next case counts as begun. A run that is killed
while it writes leaves at most a torn last line, which the next run cuts off.
"""

from __future__ import annotations

import fcntl
import json
import os
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from rr_opt.outcome import InputError

_CHANGES = {
    "input_sha256": "the study file or a file that it names",
    "version": "the version of rr-opt",
    "cold": "--cold",
    "seed": "the seed",
    "kinds": "--kinds",
    "code": "the code of rr-opt",
}


class Journal:
    """The journal of one study, open for more rows; no other run can open it meanwhile.

    rows  finished before, by their case
    """

    def __init__(self, path: Path, study: Mapping[str, Any], *, restart: bool = False):
        """Open or begin the journal of the study that a mapping identifies.

        restart: what an earlier run left is forgotten. Raises InputError if the journal is of
        another study, is damaged, or is in use.
        """
        self._path = path
        self.rows: dict[int, dict[str, Any]] = {}
        path.parent.mkdir(parents=True, exist_ok=True)
        self._file = path.open("a+b")
        try:
            self._lock()
            if restart:
                self._file.truncate(0)
            self._read(dict(study))
        except BaseException:
            self._file.close()
            raise

    def append(self, case: int, row: Mapping[str, Any]) -> None:
        """Keep a finished row: it is on the disk when this returns."""
        self._write({"case": case, **row})
        self.rows[case] = dict(row)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._file.close()

    def _lock(self) -> None:
        try:
            # The system lets go of it when the process ends, however it ends.
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise InputError(
                f"Another run is writing to {self._path}. Expected one run a folder. Wait for it, "
                "or give another folder with --out."
            ) from None

    def _read(self, study: dict[str, Any]) -> None:
        self._file.seek(0)
        content = self._file.read()
        whole = content[: content.rfind(b"\n") + 1]
        if len(whole) < len(content):
            self._file.truncate(len(whole))
        if not whole:
            self._write(study)
            return
        try:
            head, *rows = [json.loads(line) for line in whole.splitlines()]
            for row in rows:
                self.rows.setdefault(int(row.pop("case")), row)
        except (ValueError, KeyError, AttributeError, TypeError):
            raise InputError(
                f"The journal {self._path} is damaged. Expected a JSON object a line. "
                "Begin anew with --restart, which forgets the rows in it."
            ) from None
        if head != study:
            raise InputError(
                f"The rows in {self._path} are of another study: {_difference(head, study)}. "
                "Expected the one they were begun with, to go on with it. Begin anew with "
                "--restart, which forgets those rows, or give another folder with --out."
            )

    def _write(self, record: Mapping[str, Any]) -> None:
        line = json.dumps(record, allow_nan=False, ensure_ascii=False) + "\n"
        self._file.write(line.encode())
        self._file.flush()
        os.fsync(self._file.fileno())


def _difference(head: Any, study: dict[str, Any]) -> str:
    """In words what changed."""
    if not isinstance(head, dict):
        return "they have no heading"
    changed = [_CHANGES.get(key, key) for key in study if head.get(key) != study[key]]
    return f"{' and '.join(changed) or 'something'} changed since they were begun"
