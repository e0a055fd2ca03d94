"""Runs that are killed, starved and crossed: `python -m tests.robustness.chaos --kills 200`.

After every disturbance the same command is given again until it ends, and what it wrote is held
against that of an undisturbed run: no case lost, done twice or different. Writes the counts, with
the seed, to --out. With --broken each scene is played once with its protection taken away, and has
to notice that.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.documents.archive import write_json
from tests.cluster import SCHEDULER, WORKER, free_port

STUDY = """
problem:
  gait: {amplitude: [0.1, 1.0], period: 1 s, offset: 0.0}
  limits: {angle: 2.6, torque: 1.37}
vary:
  limits.rate: {from: 10 rpm, to: 60 rpm, count: 13}
"""
UNCUT = """
from rr_opt.batch.journal import Journal
class Uncut:
    def __init__(self, file):
        self.file = file
    def __getattr__(self, name):
        return getattr(self.file, name)
    def truncate(self, size):
        pass
lock = Journal._lock
def locked(self):
    lock(self)
    self._file = Uncut(self._file)
Journal._lock = locked
"""
"""A torn last line of a journal stays."""
TORN = """
import json, time
def slow(self, record):
    line = json.dumps(record).encode() + b"\\n"
    for piece in (line[:9], line[9:]):
        self._file.write(piece)
        self._file.flush()
        time.sleep(0.3)
Journal._write = slow
"""
"""Lines are torn more often."""
BROKEN = {
    "study killed": UNCUT + TORN,
    "two runs": """
from rr_opt.batch.journal import Journal
Journal._lock = lambda self: None
""",
    "disk full": UNCUT,
    "clock set back": """
import time
time.monotonic = time.time
""",
    "worker killed": """
from rr_opt.batch.pools import ClusterPool
check = ClusterPool._check_versions
def frail(self):
    check(self)
    give_up = lambda dask_scheduler: setattr(dask_scheduler, "allowed_failures", 0)
    self._client.run_on_scheduler(give_up)
ClusterPool._check_versions = frail
""",
    "prove killed": """
import threading
from rr_lab.trial.trial import Trial
files = Trial._made
def later(self, id, made):
    threading.Timer(3.0, files, (self, id, made)).start()
    return {"seal": made.seal, "failed": "", "seconds": 1.0}
Trial._made = later
""",
}
"""By scene, what is run before the program so that its protection is gone."""


def program(broken: str = "") -> tuple[str, ...]:
    """The command, after some code."""
    return sys.executable, "-c", f"{broken}\nfrom rr_opt.cli.entry import main; main()"


CASES = 13
STUDY_VERB = ("study", "study.yaml", "--out", "res", "--no-figures")
PROVE_VERB = (
    "prove", "--cases", "2", "--seed", "5eed", "--kinds", "null", "--engine", "planar",
    "--workers", "1", "--out", "res",
)  # fmt: skip
Random = np.random.Generator
SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
CLOSE = 1e-6
"""Relative difference of a number from that of the undisturbed run: a neighbour that is not there
to start from leads to the same optimum by another way."""
PATIENCE = 300.0
ENDS = 5.0
"""s after which no process of a run that ended is left."""


@dataclass
class Log:
    """What was done, and what was wrong."""

    done: Counter[str] = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)

    def check(self, right: bool, what: str) -> None:
        """Note what is not right."""
        if not right:
            self.wrong.append(what)
            print("wrong:", what, flush=True)


@dataclass(frozen=True)
class Ended:
    """code: negative for a signal."""

    code: int
    err: str


def begun(command: Sequence[str], folder: Path, **more: str) -> subprocess.Popen[str]:
    """The command under way in a process group of its own."""
    return subprocess.Popen(
        command, cwd=folder, env={**os.environ, "OPENBLAS_NUM_THREADS": "1", **more},
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, process_group=0,
    )  # fmt: skip


def ended(running: subprocess.Popen[str], log: Log, what: str) -> Ended:
    """Its end; no traceback, and nothing is left running.

    Of a run that is killed outright, a process that it had just begun may complain.
    """
    try:
        text = running.communicate(timeout=PATIENCE)[0]
    except subprocess.TimeoutExpired:
        os.killpg(running.pid, signal.SIGKILL)
        text = running.communicate()[0]
        log.check(False, f"{what}: does not end")
    shown = "Traceback" in text and running.returncode != -signal.SIGKILL
    log.check(not shown, f"{what}: {text[-600:]}")
    limit = time.monotonic() + ENDS
    while _alive(running.pid) and time.monotonic() < limit:
        time.sleep(0.05)
    log.check(not _alive(running.pid), f"{what}: a process is left")
    return Ended(running.returncode, text)


def _alive(group: int) -> bool:
    try:
        os.killpg(group, 0)
    except OSError:
        return False
    # Who is dead and not yet waited for by its new parent does nothing any more.
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, its_group = stat.read_text().rpartition(")")[2].split()[:3]
        except OSError:
            continue
        if int(its_group) == group and state != "Z":
            return True
    return False


def rows(journal: Path) -> dict[int, str]:
    """Whole lines of a journal by case. Raises ValueError for one that is there twice."""
    found: dict[int, str] = {}
    content = journal.read_bytes() if journal.exists() else b""
    for line in content[: content.rfind(b"\n") + 1].decode().splitlines()[1:]:
        case = json.loads(line)["case"]
        if case in found:
            raise ValueError(f"case {case} is there twice")
        found[case] = line
    return found


def study_of(folder: Path) -> Any:
    """The rows of study.csv, and of the journal their number."""
    place = folder / "res"
    with (place / "study.csv").open() as file:
        return {"rows": list(csv.DictReader(file)), "kept": sorted(rows(place / "journal.jsonl"))}


def trial_of(folder: Path) -> Any:
    """What a trial wrote: the answers, each that of its seal, and what was said of the cases."""
    place = folder / "res"
    check = ("sha256sum", "--check", "--status", "seals.txt")
    answers = sorted((place / "answers").glob("*.json"))
    return {
        "sealed": not subprocess.run(check, cwd=place, check=False).returncode,
        "answers": {one.name: json.loads(one.read_text()) for one in answers},
        "made": sorted(rows(place / "made.jsonl")),
        "said": {n: json.loads(line)["claim"] for n, line in rows(place / "said.jsonl").items()},
        "cases": (place / "cases.csv").exists(),
    }


def same(one: Any, two: Any, where: str = "") -> str:
    """How two results differ, times and salts apart; empty if they do not."""
    if isinstance(one, Mapping) and isinstance(two, Mapping) and one.keys() == two.keys():
        pairs = [(key, one[key], two[key]) for key in one if not ANYTHING.search(str(key))]
    elif isinstance(one, list) and isinstance(two, list) and len(one) == len(two):
        pairs = [(key, *pair) for key, pair in enumerate(zip(one, two, strict=True))]
    elif _close(one, two):
        return ""
    else:
        return f"{where}: {str(one)[:80]} and {str(two)[:80]}"
    return next(filter(None, (same(a, b, f"{where}.{key}") for key, a, b in pairs)), "")


ANYTHING = re.compile("seconds|started|wall|cpu|salt")
"""Keys whose values differ from run to run."""


def _close(one: Any, two: Any) -> bool:
    try:
        a, b = float(one), float(two)
    except (TypeError, ValueError):
        return one == two
    return abs(a - b) <= CLOSE * max(abs(a), abs(b), 1e-3)


def fresh() -> Path:
    """A folder with the study."""
    folder = Path(tempfile.mkdtemp(prefix="chaos-"))
    (folder / "study.yaml").write_text(STUDY)
    return folder


@dataclass
class Scene:
    """A command that is disturbed.

    command   as it is given each time
    written   what it wrote into a folder, to be held against that of an undisturbed run
    journals  files of rows that stay as they are
    """

    name: str
    command: Sequence[str]
    written: Callable[[Path], Any]
    journals: Sequence[str]
    rng: Random
    log: Log

    def undisturbed(self, *more: str) -> Any:
        """What a run writes that nothing disturbs."""
        folder = fresh()
        end = ended(begun((*self.command, *more), folder), self.log, f"{self.name}, undisturbed")
        self.log.check(end.code == 0, f"{self.name}, undisturbed: {end}")
        found = self.written(folder)
        shutil.rmtree(folder)
        return found

    def ends_as(self, right: Any, folder: Path, end: Ended) -> None:
        """Note a run that did not end well, or wrote something else."""
        why = str(end)[-300:]
        if end.code == 0:
            try:
                why = same(self.written(folder), right)
            except (OSError, ValueError, KeyError) as error:
                why = repr(error)
        self.log.check(not why, f"{self.name}: {why}")

    def rows(self, folder: Path) -> dict[tuple[str, int], str]:
        """Of all journals."""
        found = {}
        for name in self.journals:
            for case, line in rows(folder / "res" / name).items():
                found[name, case] = line
        return found

    def wait_for_row(self, folder: Path, running: subprocess.Popen[str]) -> None:
        """Wait for the first, as long as the run lasts."""
        end = time.monotonic() + PATIENCE
        while not self.rows(folder) and running.poll() is None and time.monotonic() < end:
            time.sleep(0.02)


def killed(scene: Scene, kills: int) -> None:
    """Kill runs at random moments, give the command again, and look at what it wrote at its end."""
    log, rng, name = scene.log, scene.rng, scene.name
    begin = time.monotonic()
    right = scene.undisturbed()
    longest = time.monotonic() - begin
    folder, before = fresh(), {}
    while kills:
        running = begun(scene.command, folder)
        time.sleep(rng.uniform(0.0, longest))
        number = SIGNALS[rng.integers(3)]
        lived, done = running.poll() is None, scene.rows(folder)
        if lived:
            # As Ctrl-C in a terminal, which goes to the whole group, or to the process alone.
            to_all = number == signal.SIGINT and rng.random() < 0.5
            (os.killpg if to_all else os.kill)(running.pid, number)
        end = ended(running, log, f"{name}, {number.name}")
        if lived:
            kills -= 1
            log.done[f"{name}, {number.name}"] += 1
            log.done[f"{name}, with rows done"] += bool(done)
            # A signal may come before the run has taken it over, or after its work is done.
            codes = {0, -number} if number == signal.SIGKILL else {0, 130, -number}
            log.check(end.code in codes, f"{name}, {number.name}: exit {str(end)[-300:]}")
        now = scene.rows(folder)
        lost = [case for case, line in (before | done).items() if now.get(case) != line]
        log.check(not lost, f"{name}, {number.name}: rows {lost} are lost or changed")
        before = now
        if not lived and end.code != 0:
            log.check(False, f"{name}: exit {str(end)[-300:]}")
            break
        if end.code == 0:
            log.done[f"{name}, finished"] += 1
            scene.ends_as(right, folder, end)
            shutil.rmtree(folder)
            folder, before = fresh(), {}
    scene.ends_as(right, folder, ended(begun(scene.command, folder), log, f"{name}, at last"))
    shutil.rmtree(folder)


def two_runs(scene: Scene, rounds: int) -> None:
    """Two runs into one folder: one ends, the other is refused."""
    right = scene.undisturbed()
    for _ in range(rounds):
        folder = fresh()
        both = [begun(scene.command, folder) for _ in range(2)]
        ends = sorted((ended(one, scene.log, scene.name) for one in both), key=lambda e: e.code)
        scene.log.done["two runs into one folder"] += 1
        codes = [end.code for end in ends]
        scene.log.check(codes in ([0, 2], [0, 0]), f"two runs: exit {codes}")
        scene.ends_as(right, folder, ends[0])
        shutil.rmtree(folder)


def disk_full(scene: Scene, rounds: int) -> None:
    """A disk that is full in between."""
    right, log = scene.undisturbed(), scene.log
    for _ in range(rounds):
        folder = fresh()
        disk = folder / "res"
        disk.mkdir()
        mount = ("mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", str(disk))
        if subprocess.run(mount, check=False, capture_output=True).returncode:
            log.done["disk full: no right to mount one"] += 1
            return
        try:
            ballast = disk / "ballast"
            with ballast.open("wb") as file:
                free = 256 * 1024 - 4096 * int(scene.rng.integers(0, 6))
                file.write(b"\0" * (free - 4096))
            end = ended(begun(scene.command, folder), log, "disk full")
            log.done["disk full"] += 1
            said = "No space left" in end.err or "full" in end.err
            log.check(end.code == 2 and said, f"disk full: exit {end.code}: {end.err[-300:]}")
            before = scene.rows(folder)
            ballast.unlink()
            end = ended(begun(scene.command, folder), log, "disk with room again")
            now = scene.rows(folder)
            lost = [case for case, line in before.items() if now.get(case) != line]
            log.check(not lost, f"disk full: rows {lost} are lost or changed")
            scene.ends_as(right, folder, end)
        finally:
            subprocess.run(("umount", str(disk)), check=False)
        shutil.rmtree(folder)


def clock_back(scene: Scene, rounds: int) -> None:
    """The clock of the machine set back by a day during a run, and a run killed after that."""
    if shutil.which("faketime") is None:
        scene.log.done["clock set back: faketime is not installed"] += 1
        return
    right, rng, log = scene.undisturbed(), scene.rng, scene.log
    for _ in range(rounds):
        folder = fresh()
        clock = folder / "clock"
        clock.write_text("+0")
        fake = {
            "FAKETIME_TIMESTAMP_FILE": str(clock), "FAKETIME_NO_CACHE": "1",
            "FAKETIME_DONT_FAKE_MONOTONIC": "1", "LD_PRELOAD": _faketime(),
        }  # fmt: skip
        running = begun(scene.command, folder, **fake)
        scene.wait_for_row(folder, running)
        time.sleep(rng.uniform(0.0, 1.0))
        clock.write_text("-1d")
        log.done["clock set back"] += running.poll() is None
        if rng.random() < 0.5:
            time.sleep(rng.uniform(0.0, 1.0))
            running.send_signal(signal.SIGKILL)
            ended(running, log, "clock set back, killed")
            running = begun(scene.command, folder, **fake)
        end = ended(running, log, "clock set back")
        log.check(not re.search(r"^ *-\d", end.err, re.MULTILINE), f"clock set back: {end.err}")
        scene.ends_as(right, folder, end)
        shutil.rmtree(folder)


def _faketime() -> str:
    found = subprocess.run(
        ("faketime", "-f", "+0", "printenv", "LD_PRELOAD"),
        capture_output=True,
        text=True,
        check=True,
    )
    return found.stdout.strip()


def worker_killed(scene: Scene, rounds: int) -> None:
    """A worker of a dask cluster is killed in the midst of its cases."""
    right, log = scene.undisturbed(), scene.log
    address = f"tcp://127.0.0.1:{free_port()}"
    cluster = [begun((sys.executable, *SCHEDULER, address), Path.cwd())]
    try:
        cluster.append(begun((sys.executable, *WORKER, address), Path.cwd()))
        while rounds:
            folder = fresh()
            worker = begun((sys.executable, *WORKER, address), folder)
            cluster.append(worker)
            time.sleep(5.0)
            running = begun((*scene.command, "--scheduler", address), folder)
            scene.wait_for_row(folder, running)
            time.sleep(scene.rng.uniform(0.0, 1.0))
            lived, done = running.poll() is None, len(scene.rows(folder))
            worker.kill()
            end = ended(running, log, scene.name)
            scene.ends_as(right, folder, end)
            if lived and done < CASES:
                rounds -= 1
                log.done["worker of a cluster killed"] += 1
            shutil.rmtree(folder, ignore_errors=True)
    finally:
        for one in cluster:
            one.kill()
            one.communicate()


def played(names: Sequence[str], given: argparse.Namespace, log: Log, *, broken: bool) -> None:
    """Play scenes, each with random numbers of its own; broken: without its protection."""
    begin = time.monotonic()
    for name in names:
        rng = np.random.default_rng([given.seed, list(BROKEN).index(name)])
        command = program(BROKEN[name] if broken else "")
        more = ("--cold",) if name == "worker killed" else ()
        scene = Scene(name, (*command, *STUDY_VERB, *more), study_of, ["journal.jsonl"], rng, log)
        if name == "prove killed":
            verb = (*command, *PROVE_VERB)
            scene = Scene(name, verb, trial_of, ["made.jsonl", "said.jsonl"], rng, log)
            rounds, play = given.kills // 4, killed
        elif name == "study killed":
            rounds, play = given.kills - given.kills // 4, killed
        else:
            rounds, play = given.rounds, OTHERS[name]
        try:
            play(scene, rounds)
        except ValueError as error:
            log.check(False, f"{name}: a journal cannot be read: {error}")
        print(f"{time.monotonic() - begin:6.0f} s  {name}  {dict(log.done)}", flush=True)
        if given.out and not broken:
            write_json(given.out, {"seed": given.seed, "done": log.done, "wrong": log.wrong})


OTHERS = {
    "two runs": two_runs,
    "disk full": disk_full,
    "clock set back": clock_back,
    "worker killed": worker_killed,
}


def main() -> None:
    """All scenes."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--rounds", type=int, default=5, help="of every other scene")
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--scenes", nargs="+", choices=BROKEN, default=list(BROKEN))
    parser.add_argument("--broken", action="store_true", help="each has to notice what is missing")
    parser.add_argument("--out", type=Path, help="a JSON file for the counts")
    given = parser.parse_args()
    print(f"seed {given.seed}", flush=True)
    # Runs in the background ignore it, and so would all that they start.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    if not given.broken:
        log = Log()
        played(given.scenes, given, log, broken=False)
        sys.exit(bool(log.wrong))
    noticed = {}
    for name in given.scenes:
        log = Log()
        played([name], given, log, broken=True)
        noticed[name] = len(log.wrong)
    print(noticed)
    sys.exit(not all(noticed.values()))


if __name__ == "__main__":
    main()
