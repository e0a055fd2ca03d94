"""The journal of a batch: one line for each finished row, so that a stopped run can continue.

A line is written, flushed and synced before the next row is taken. A run that is killed while it
writes leaves at most a torn last line, which the next run cuts off. Any other line that is not a
row of the batch, or was changed since, is rejected, with its line number.
"""

import fcntl
import json
import os
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Generic, Self, TypeVar

from rr_opt.files.source import require_regular
from rr_opt.outcome import InputError

JOURNAL = "journal.jsonl"
"""Its name in the folder of a study."""
SUM = "crc32"
"""The key of a row's checksum, the last in the row."""

_CHANGES = {
    "input_sha256": "the study file or a file that it names",
    "version": "the version of rr-opt",
    "cold": "--cold",
    "seed": "the seed",
    "kinds": "--kinds",
    "code": "the code of rr-opt",
}

Row = TypeVar("Row")


class Journal(Generic[Row]):
    """The journal of one batch, open for appending; no other run can open it meanwhile.

    rows  finished rows by case
    """

    def __init__(
        self,
        path: Path,
        identity: Mapping[str, Any],
        *,
        read: Callable[[Mapping[str, Any]], Row] = dict,
        cases: int | None = None,
        restart: bool = False,
    ):
        """Open or create the journal of the batch that `identity` describes.

        read     a row from its record; raises KeyError, TypeError or ValueError if it is not one
        cases    how many there are, if known
        restart  discard the rows of earlier runs

        Raises InputError if the journal is of another batch, damaged, in use, or not a regular
        file.
        """
        self._path, self._read, self._cases = path, read, cases
        self.rows: dict[int, Row] = {}
        require_regular(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        self._file = path.open("a+b")
        try:
            self._lock()
            if restart:
                self._file.truncate(0)
            self._load(dict(identity))
        except BaseException:
            self._file.close()
            raise

    def append(self, case: int, record: Mapping[str, Any]) -> None:
        """Keep a finished row: it is on disk when this returns."""
        row = {"case": case, **record}
        self._write({**row, SUM: _sum(row)})
        self.rows[case] = self._read(record)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    def _lock(self) -> None:
        try:
            # The system releases it when the process ends, for whatever reason.
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise InputError(
                f"Another run is writing to {self._path}. Expected one run per folder. Wait for "
                "it, or give another folder with --out."
            ) from None

    def _load(self, identity: dict[str, Any]) -> None:
        self._file.seek(0)
        content = self._file.read()
        whole = content[: content.rfind(b"\n") + 1]
        if len(whole) < len(content):
            self._file.truncate(len(whole))
        if not whole:
            self._write(identity)
            return
        heading, *lines = whole.splitlines()
        try:
            known = _parsed(heading)
        except ValueError as error:
            raise self._damaged(1, str(error)) from None
        if known != identity:
            raise InputError(
                f"The rows in {self._path} belong to another study: "
                f"{_difference(known, identity)}. Expected the study they were started with. Start "
                "over with --restart, which discards those rows, or give another folder with --out."
            )
        for number, line in enumerate(lines, 2):
            try:
                case, row = self._row(_parsed(line))
            except KeyError as error:
                raise self._damaged(number, f"it has no {error}") from None
            except (TypeError, ValueError, RecursionError) as error:
                raise self._damaged(number, str(error)) from None
            self.rows[case] = row

    def _row(self, record: dict[str, Any]) -> tuple[int, Row]:
        # Rows of earlier versions have no checksum.
        if SUM in record and record.pop(SUM) != (found := _sum(record)):
            raise ValueError(f"it was changed after it was written: its {SUM} would be {found}")
        case = record.pop("case")
        if type(case) is not int or case < 0:
            raise ValueError(f"its case is {case!r}, not a number from 0 on")
        if self._cases is not None and case >= self._cases:
            raise ValueError(f"its case is {case}, of {self._cases} from 0 on")
        if case in self.rows:
            raise ValueError(f"case {case} already has a row")
        return case, self._read(record)

    def _damaged(self, number: int, why: str) -> InputError:
        return InputError(
            f"The journal {self._path} is damaged in line {number}: {why}. Expected a JSON object "
            "for each case, as rr-opt wrote it. Delete the line to have its case solved again, or "
            "start over with --restart, which discards all rows."
        )

    def _write(self, record: Mapping[str, Any]) -> None:
        self._file.write(_text(record) + b"\n")
        self._file.flush()
        os.fsync(self._file.fileno())


def _text(record: Mapping[str, Any]) -> bytes:
    return json.dumps(record, allow_nan=False, ensure_ascii=False).encode()


def _sum(row: Mapping[str, Any]) -> str:
    """Detects a row that was changed by accident or by hand; it does not prevent forgery."""
    return f"{zlib.crc32(_text(row)):08x}"


def _parsed(line: bytes) -> dict[str, Any]:
    """The JSON object in a line. Raises ValueError."""

    def refuse(name: str) -> None:
        raise ValueError(f"{name} is not a JSON number")

    try:
        record = json.loads(line, parse_constant=refuse)
    except json.JSONDecodeError as error:
        raise ValueError(f"it is not JSON ({error.msg}, column {error.colno})") from None
    except UnicodeDecodeError:
        raise ValueError("it is not UTF-8") from None
    except RecursionError:
        raise ValueError("it is nested too deeply") from None
    if not isinstance(record, dict):
        raise ValueError("it is not a JSON object")
    return record


def _difference(known: dict[str, Any], identity: dict[str, Any]) -> str:
    """What changed, in words."""
    changed = [_CHANGES.get(key, key) for key in identity if known.get(key) != identity[key]]
    return f"{' and '.join(changed) or 'something'} changed since they were started"
