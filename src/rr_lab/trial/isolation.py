"""One case diagnosed by a separate process, given only the case's folder.

Isolated: the program runs in a new process, in a temporary folder that has the same name for every
case and holds a copy of the recordings. Its arguments name that folder, its environment is a short
list of variables, and its Python takes no settings from outside. No argument, variable, file or
file name there reveals the case's number, its kind, the seed or where the answer is.

Not isolated: the process belongs to the same user, who may read all files of the machine. A program
that searched for the answer would find it. `rr-opt diagnose` does not search.
"""

import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rr_lab.trial.outcome import Case, Claim, Truth, scored_part

_PROGRAM = """
import os, threading
def end():
    os.read(0, 1)
    os._exit(1)
threading.Thread(target=end, daemon=True).start()
from rr_opt.cli.entry import main
main()
"""
"""Ends when its standard input closes: with its parent process, however that ends."""

COMMAND = (sys.executable, "-I", "-u", "-c", _PROGRAM, "diagnose")
"""-I: neither the current folder nor the environment affects imports; -u: output printed before a
crash is not lost."""

RECORDINGS, SAID, OUTPUT = "recordings", "said", "output.txt"
KEPT = ("diagnosis.json", "report.html", "robot-corrected.yaml")
"""Files of a diagnosis that are kept; the page has the figures in it."""

TIME_LIMIT = 3600.0
"""s; a case that takes longer counts as one without an answer."""

_VARIABLES = ("PATH", "HOME", "LANG", "LC_ALL", "MPLCONFIGDIR", "SYSTEMROOT")
_LONGEST = 20_000
"""Most characters of output that are kept."""


@dataclass(frozen=True)
class Task:
    """files of the folder by name; command: the program and its first words; limit in s."""

    files: Mapping[str, bytes]
    command: tuple[str, ...] = COMMAND
    limit: float = TIME_LIMIT


@dataclass(frozen=True)
class Reply:
    """The outcome of the program: exit code (negative: a signal), the files it wrote and
    `output.txt`, wall and CPU time, s."""

    exit_code: int
    files: Mapping[str, bytes]
    wall: float = 0.0
    cpu: float = 0.0
    timed_out: bool = False

    @property
    def row(self) -> dict[str, Any]:
        """As plain data; `claim` is the scored part of the diagnosis, None if the program failed or
        its answer cannot be read."""
        claim = None
        if self.exit_code == 0 and "diagnosis.json" in self.files:
            with suppress(ValueError, KeyError, TypeError, AttributeError):
                claim = scored_part(json.loads(self.files["diagnosis.json"]))
        times = {"wall": round(self.wall, 2), "cpu": round(self.cpu, 2)}
        return {
            "exit_code": self.exit_code, "timed_out": self.timed_out, **times, "claim": claim,
        }  # fmt: skip


def opened_case(id: str, answer: Mapping[str, Any], row: Mapping[str, Any]) -> Case:
    """The case of an opened answer and such a row."""
    claim, why = None, ""
    if row["claim"] is not None:
        claim = Claim.of(row["claim"])
    elif row["timed_out"]:
        why = f"no answer after {row['wall']:.0f} s"
    elif row["exit_code"]:
        why = f"ended with exit code {row['exit_code']}"
    else:
        why = "diagnosis.json is missing or unreadable"
    return Case(id, Truth.of(answer), claim, row["wall"], row["cpu"], why)


def diagnose_apart(task: Task) -> Reply:
    """Run the program on a copy of the folder; returns its outcome, and raises nothing."""
    with tempfile.TemporaryDirectory(prefix="rr-opt-", ignore_cleanup_errors=True) as place:
        top = Path(place)
        (top / RECORDINGS).mkdir()
        for name, content in task.files.items():
            (top / RECORDINGS / name).write_bytes(content)
        code, wall, cpu, late = _run(task, top)
        written = [name for name in KEPT if (top / SAID / name).is_file()]
        files = {name: (top / SAID / name).read_bytes() for name in written}
        printed = (top / OUTPUT).read_text(encoding="utf-8", errors="replace")
        printed = printed.replace(f"{top}{os.sep}", "")  # the folder is gone
    return Reply(code, {**files, OUTPUT: printed[-_LONGEST:].encode()}, wall, cpu, late)


def _run(task: Task, top: Path) -> tuple[int, float, float, bool]:
    """Exit code, wall and CPU time in s, and whether it timed out."""
    recordings, late = top / RECORDINGS, threading.Event()
    kept = {name: os.environ[name] for name in _VARIABLES if name in os.environ}
    began = time.perf_counter()
    with (top / OUTPUT).open("wb") as output:
        process = subprocess.Popen(
            [*task.command, str(recordings), "--out", str(top / SAID)],
            cwd=recordings,
            env={**kept, "TMPDIR": str(top)},
            stdin=subprocess.PIPE,
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
            if process.stdin:
                process.stdin.close()
    process.returncode = os.waitstatus_to_exitcode(status)
    cpu = usage.ru_utime + usage.ru_stime
    return process.returncode, time.perf_counter() - began, cpu, late.is_set()


def _kill(process: subprocess.Popen[bytes]) -> None:
    """Kill the program and all its children."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
