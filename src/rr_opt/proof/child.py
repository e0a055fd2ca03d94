"""One case diagnosed by a program of its own, which is given the case's folder and nothing else.

What this isolates: the program runs in a new process, in a temporary folder that is named alike for
every case and holds a copy of the recordings. Its arguments name that folder, its environment is a
short list of variables, and its Python takes no settings from outside. No argument, variable, file
or file name there tells the case's number, its kind, the seed or where the answer is.

What it does not: the process belongs to the same user, who may read all files of the machine. A
program that went to look for the answer would find it. `rr-opt diagnose` does not look.
"""

from __future__ import annotations

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
    """Run the program on a copy of the folder; however it ends, that is told and nothing raised."""
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
        printed = printed.replace(f"{top}{os.sep}", "")  # the folder is gone, and tells nothing
    code, wall, cpu, late = ended
    return Said(code, files, printed[-_LONGEST:], wall, cpu, late)


def _run(task: Task, top: Path) -> tuple[int, float, float, bool]:
    """Exit code, wall and CPU time in s, and whether the time was up."""
    recordings, late = top / RECORDINGS, threading.Event()
    words = [*task.command, str(recordings), "--out", str(top / SAID), "--workers", "1"]
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
            # wait4 and not Popen.wait: it tells the CPU time of this process alone.
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
