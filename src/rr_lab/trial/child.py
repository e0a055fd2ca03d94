"""One case diagnosed by a separate process, which is given the case's folder and nothing else.

What this isolates: the program runs in a new process, in a temporary folder that is named alike for
every case and holds a copy of the recordings. Its arguments name that folder, its environment is a
short list of variables, and its Python takes no settings from outside. No argument, variable, file
or file name there reveals the case's number, its kind, the seed or where the answer is.

What it does not: the process belongs to the same user, who may read all files of the machine. A
program that went to look for the answer would find it. `rr-opt diagnose` does not look.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rr_lab.trial.case import Case, claim_from, claim_record, truth_from
from rr_lab.trial.lots import Lot, make
from rr_opt.outcome import NotConvergedError

COMMAND = (
    sys.executable,
    "-I",
    "-u",
    "-c",
    "from rr_opt.cli.entry import main; main()",
    "diagnose",
)
"""-I: neither the current folder nor the environment adds to what Python loads; -u: what was
printed before a crash is not lost."""

RECORDINGS, SAID = "recordings", "said"
KEPT = ("diagnosis.json", "report.html", "robot-corrected.yaml")
"""Files of a diagnosis that are kept; the page has the figures in it."""

TIME_LIMIT = 3600.0
"""s; a case that takes longer counts as one without an answer."""

_VARIABLES = ("PATH", "HOME", "LANG", "LC_ALL", "MPLCONFIGDIR", "SYSTEMROOT")
_LONGEST = 20_000
"""Characters of output that are kept."""


@dataclass(frozen=True)
class Task:
    """files of the folder by name; command: the program and its first words; limit in s."""

    files: Mapping[str, bytes]
    command: tuple[str, ...] = COMMAND
    limit: float = TIME_LIMIT


@dataclass(frozen=True)
class Said:
    """How the program ended: exit code (negative: a signal), files it wrote, all that it printed,
    wall and CPU time, s."""

    exit_code: int
    files: Mapping[str, bytes]
    output: str
    wall: float
    cpu: float
    timed_out: bool = False

    @property
    def everything(self) -> dict[str, bytes]:
        """Its files, and what it printed as one more."""
        return {**self.files, "output.txt": self.output.encode()}


def diagnose_apart(task: Task) -> Said:
    """Run the program on a copy of the folder; returns how it ended, and raises nothing."""
    with tempfile.TemporaryDirectory(prefix="rr-opt-", ignore_cleanup_errors=True) as place:
        top = Path(place)
        (top / RECORDINGS).mkdir()
        for name, content in task.files.items():
            (top / RECORDINGS / name).write_bytes(content)
        ended = _run(task, top)
        files = {
            name: (top / SAID / name).read_bytes() for name in KEPT if (top / SAID / name).is_file()
        }
        printed = (top / "output.txt").read_text(encoding="utf-8", errors="replace")
        printed = printed.replace(f"{top}{os.sep}", "")  # the folder is gone
    code, wall, cpu, late = ended
    return Said(code, files, printed[-_LONGEST:], wall, cpu, late)


def _run(task: Task, top: Path) -> tuple[int, float, float, bool]:
    """Exit code, wall and CPU time in s, and whether the time was up."""
    recordings, late = top / RECORDINGS, threading.Event()
    words = [*task.command, str(recordings), "--out", str(top / SAID)]
    began = time.perf_counter()
    with (top / "output.txt").open("wb") as output:
        process = subprocess.Popen(
            words,
            cwd=recordings,
            env=_environment(top),
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )

        def end() -> None:
            late.set()
            _kill(process)

        timer = threading.Timer(task.limit, end)
        timer.start()
        try:
            # wait4 and not Popen.wait: it returns the CPU time of this process alone.
            _, status, usage = os.wait4(process.pid, 0)
        except BaseException:
            _kill(process)
            process.wait()
            raise
        finally:
            timer.cancel()
    process.returncode = os.waitstatus_to_exitcode(status)
    cpu = usage.ru_utime + usage.ru_stime
    return process.returncode, time.perf_counter() - began, cpu, late.is_set()


def _kill(process: subprocess.Popen[bytes]) -> None:
    """End the program and all that it has started."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)


def _environment(top: Path) -> dict[str, str]:
    kept = {name: os.environ[name] for name in _VARIABLES if name in os.environ}
    return {**kept, "TMPDIR": str(top)}


def ended_row(said: Said | str) -> dict[str, Any]:
    """As plain data; a text: the process that had started the diagnosis died, and why."""
    if isinstance(said, str):
        said = Said(-1, {}, said, 0.0, 0.0)
    return {
        "exit_code": said.exit_code,
        "timed_out": said.timed_out,
        "wall": round(said.wall, 2),
        "cpu": round(said.cpu, 2),
        "claim": _claim(said),
    }


def ended_case(id: str, answer: Mapping[str, Any], row: Mapping[str, Any]) -> Case:
    """The case of an opened answer and such a row."""
    record = row["claim"]
    claim = claim_from(record) if record is not None else None
    why = "" if claim else _why(row)
    return Case(id, truth_from(answer), claim, row["wall"], row["cpu"], why)


def _claim(said: Said) -> dict[str, Any] | None:
    """What is scored of a diagnosis; None if the program failed or its answer cannot be read."""
    if said.exit_code != 0 or "diagnosis.json" not in said.files:
        return None
    try:
        return claim_record(json.loads(said.files["diagnosis.json"]))
    except (ValueError, KeyError, TypeError, AttributeError):
        return None


def _why(row: Mapping[str, Any]) -> str:
    """Why there is no answer."""
    if row["timed_out"]:
        return f"no answer after {row['wall']:.0f} s"
    if row["exit_code"]:
        return f"ended with exit code {row['exit_code']}"
    return "diagnosis.json is missing or cannot be read"


def one_case(
    lot: Lot, folder: Path, keep: Callable[[Path, bytes], object], steps: Callable[[str], None]
) -> Case:
    """Make the case of a lot and diagnose it; everything is kept in the folder, the answer too.

    Raises NotConvergedError if the laboratory cannot make it.
    """
    steps("making the case")
    made = make(lot)
    if made.failed:
        raise NotConvergedError(f"The laboratory could not make case {lot.id}: {made.failed}")
    steps("diagnosing")
    said = diagnose_apart(Task(made.files))
    for name, content in made.files.items():
        keep(folder / "recordings" / name, content)
    for name, content in said.everything.items():
        keep(folder / "said" / name, content)
    keep(folder / "answer.json", made.answer.encode())
    return ended_case(lot.id, json.loads(made.answer), ended_row(said))
