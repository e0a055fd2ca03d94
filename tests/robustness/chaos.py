"""Runs that are killed, starved and crossed: `python -m tests.robustness.chaos --kills 200`.

After every disturbance the same command is given again until it ends, and what it wrote is held
against that of an undisturbed run: no case lost, done twice or different. Of what a run has
started, nothing may outlive it. Writes the counts, with the seed, to --out. With --broken each
scene is played with its protection taken away, and has to notice that in every round.
"""

from __future__ import annotations

import argparse
import csv
import ctypes
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
SLOW = """
from select import select
from rr_opt.batch import journal
def slow(self, record):
    line = journal._text(record) + b"\\n"
    for piece in (line[:9], line[9:]):
        self._file.write(piece)
        self._file.flush()
        select([], [], [], 0.3)
journal.Journal._write = slow
"""
"""Slow motion: a line is torn for a while, and the next comes late. (faketime lets no sleep be.)"""
BROKEN = {
    "study killed": UNCUT,
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
import time
from rr_lab.trial import Journal, Trial
made, kept, waiting = Trial._made, Journal.append, []
def row(self, id, case):
    waiting.append((self, id, case))
    return {"seal": case.seal, "failed": "", "seconds": 1.0}
def append(self, case, record):
    kept(self, case, record)
    time.sleep(1.0)
    while waiting:
        made(*waiting.pop())
Trial._made, Journal.append = row, append
""",
}
"""By scene, what is run before the program so that its protection is gone; undisturbed, nothing
comes of it."""


def program(broken: str = "") -> tuple[str, ...]:
    """The command, after some code."""
    return sys.executable, "-c", f"{broken}\nfrom rr_opt.cli.entry import main; main()"


CASES = 13
STUDY_VERB = ("study", "study.yaml", "--out", "res", "--no-figures")
SHORT = """
from functools import partial
from rr_lab.trial import Trial, make
Trial.make.__defaults__ = (partial(make, seconds=4.0),)
"""
"""Recordings of 4 s."""
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
_SUBREAPER = 36
"""Of prctl: orphans become children of this process, whatever session they are in."""
BEGUN: set[int] = set()
"""Processes that this one has started itself."""


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
    running = subprocess.Popen(
        command, cwd=folder, env={**os.environ, "OPENBLAS_NUM_THREADS": "1", **more},
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, process_group=0,
    )  # fmt: skip
    BEGUN.add(running.pid)
    return running


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
    while (left := orphans()) and time.monotonic() < limit:
        time.sleep(0.05)
    log.done["ends after which no process was left"] += not left
    log.check(not left, f"{what}: left running: {left}")
    for process in left:
        os.kill(process, signal.SIGKILL)
    return Ended(running.returncode, text)


def orphans() -> dict[int, str]:
    """Commands by process, of those whose parents ended before them."""
    found = {}
    for place in Path("/proc").glob("[0-9]*"):
        try:
            state, parent = (place / "stat").read_text().rpartition(")")[2].split()[:2]
            command = (place / "cmdline").read_text().replace("\0", " ")
        except OSError:
            continue
        # Who is dead and not yet waited for does nothing any more.
        if int(parent) == os.getpid() and state != "Z" and int(place.name) not in BEGUN:
            found[int(place.name)] = command
    return found


def rows(journal: Path) -> dict[int, str]:
    """Whole lines of a journal by case. Raises ValueError for one that is there twice."""
    found: dict[int, str] = {}
    content = journal.read_bytes() if journal.exists() else b""
    heading, *lines = content[: content.rfind(b"\n") + 1].decode().splitlines() or ["{}"]
    json.loads(heading)
    for line in lines:
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

    words     of the command, as it is given each time
    written   what it wrote into a folder, to be held against that of an undisturbed run
    journals  files of rows that stay as they are
    always    code that is run before the program
    before    the same, which takes its protection away
    right     what an undisturbed run wrote, and seconds that it took
    """

    name: str
    words: Sequence[str]
    written: Callable[[Path], Any]
    journals: Sequence[str]
    rng: Random
    always: str = ""
    before: str = ""
    right: Any = None
    seconds: float = 0.0
    log: Log = field(default_factory=Log)

    def command(self, *before: str) -> tuple[str, ...]:
        """To be run; before: more code that is run before the program."""
        return *program("\n".join((self.always, self.before, *before))), *self.words

    def undisturbed(self) -> None:
        """Look what a run writes that nothing disturbs, and how long it takes."""
        folder, begin = fresh(), time.monotonic()
        end = ended(begun(self.command(), folder), self.log, f"{self.name}, undisturbed")
        self.log.check(end.code == 0, f"{self.name}, undisturbed: {end}")
        self.right, self.seconds = self.written(folder), time.monotonic() - begin
        shutil.rmtree(folder)

    def alone(self) -> None:
        """Note it if what is run before the program does damage by itself."""
        folder = fresh()
        self.ends_as(folder, ended(begun(self.command(), folder), self.log, self.name))
        shutil.rmtree(folder)

    def ends_as(self, folder: Path, end: Ended) -> None:
        """Note a run that did not end well, or wrote something else."""
        why = str(end)[-300:]
        if end.code == 0:
            try:
                why = same(self.written(folder), self.right)
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
        """Wait for the next, as long as the run lasts."""
        self._wait(lambda: len(self.rows(folder)), running)

    def wait_for_piece(self, folder: Path, running: subprocess.Popen[str]) -> None:
        """Wait for the next row, or a piece of it."""

        def size() -> int:
            texts = [folder / "res" / name for name in self.journals]
            return sum(len(one.read_bytes().partition(b"\n")[2]) for one in texts if one.exists())

        self._wait(size, running)

    def _wait(self, count: Callable[[], int], running: subprocess.Popen[str]) -> None:
        first, end = count(), time.monotonic() + PATIENCE
        while count() == first and running.poll() is None and time.monotonic() < end:
            time.sleep(0.01)


MOMENTS = ("any", "within a row", "after a row")
WORST = {"study killed": "within a row", "prove killed": "after a row"}
"""When a broken run is killed: what it leaves then is what its protection is for."""


def killed(scene: Scene, kills: int) -> None:
    """Kill runs at random moments, give the command again, and look at what it wrote at its end."""
    log, rng, name = scene.log, scene.rng, scene.name
    folder, before = fresh(), {}
    while kills:
        moment = WORST[name] if scene.before else str(rng.choice(MOMENTS))
        running = begun(scene.command(SLOW if moment == "within a row" else ""), folder)
        if not scene.before:
            time.sleep(rng.uniform(0.0, scene.seconds))
        if moment == "within a row":
            scene.wait_for_piece(folder, running)
        elif moment == "after a row":
            scene.wait_for_row(folder, running)
        number = SIGNALS[rng.integers(3)]
        lived, done = running.poll() is None, scene.rows(folder)
        if lived:
            # As Ctrl-C in a terminal, which goes to the whole group, or to the process alone.
            to_all = number == signal.SIGINT and rng.random() < 0.5
            (os.killpg if to_all else os.kill)(running.pid, number)
        end = ended(running, log, f"{name}, {number.name}")
        if lived:
            kills -= 1
            log.done[number.name] += 1
            log.done[moment] += 1
            log.done["with rows done"] += bool(done)
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
            log.done["finished"] += 1
            scene.ends_as(folder, end)
            shutil.rmtree(folder)
            folder, before = fresh(), {}
    scene.ends_as(folder, ended(begun(scene.command(), folder), log, f"{name}, at last"))
    shutil.rmtree(folder)


def two_runs(scene: Scene, rounds: int) -> None:
    """Two runs into one folder: one ends, the other is refused."""
    for _ in range(rounds):
        folder = fresh()
        both = [begun(scene.command(SLOW), folder) for _ in range(2)]
        ends = sorted((ended(one, scene.log, scene.name) for one in both), key=lambda e: e.code)
        scene.log.done["rounds"] += 1
        codes = [end.code for end in ends]
        scene.log.check(codes == [0, 2], f"two runs: exit {codes}")
        scene.ends_as(folder, ends[0])
        shutil.rmtree(folder)


PAGE = 4096
"""bytes that a disk gives at a time: of one, a journal fills the last with a piece of a row."""


def disk_full(scene: Scene, rounds: int) -> None:
    """A disk that is full in between."""
    log = scene.log
    for _ in range(rounds):
        folder = fresh()
        disk = folder / "res"
        disk.mkdir()
        mount = ("mount", "-t", "tmpfs", "-o", f"size={64 * PAGE}", "tmpfs", str(disk))
        if subprocess.run(mount, check=False, capture_output=True).returncode:
            log.done["no right to mount a disk"] += 1
            return
        try:
            ballast = disk / "ballast"
            free = 1 if scene.before else int(scene.rng.integers(0, 6))
            ballast.write_bytes(bytes(PAGE * (64 - free)))
            end = ended(begun(scene.command(), folder), log, "disk full")
            log.done["rounds"] += 1
            said = "No space left" in end.err or "full" in end.err
            log.check(end.code == 2 and said, f"disk full: exit {end.code}: {end.err[-300:]}")
            before = scene.rows(folder)
            ballast.unlink()
            end = ended(begun(scene.command(), folder), log, "disk with room again")
            now = scene.rows(folder)
            lost = [case for case, line in before.items() if now.get(case) != line]
            log.check(not lost, f"disk full: rows {lost} are lost or changed")
            scene.ends_as(folder, end)
        finally:
            subprocess.run(("umount", "--lazy", str(disk)), check=False)
        shutil.rmtree(folder)


def clock_back(scene: Scene, rounds: int) -> None:
    """The clock of the machine set back by a day during a run, and a run killed after that."""
    if shutil.which("faketime") is None:
        scene.log.done["faketime is not installed"] += 1
        return
    rng, log = scene.rng, scene.log
    for _ in range(rounds):
        folder = fresh()
        clock = folder / "clock"
        clock.write_text("+0")
        fake = {
            "FAKETIME_TIMESTAMP_FILE": str(clock), "FAKETIME_NO_CACHE": "1",
            "FAKETIME_DONT_FAKE_MONOTONIC": "1", "LD_PRELOAD": _faketime(),
        }  # fmt: skip
        running = begun(scene.command(SLOW), folder, **fake)
        scene.wait_for_row(folder, running)
        time.sleep(rng.uniform(0.0, 1.0))
        clock.write_text("-1d")
        log.done["rounds"] += running.poll() is None
        ends = []
        if rng.random() < 0.5:
            for _ in range(CASES // 4):  # a line is shown for each fifth of the cases
                scene.wait_for_row(folder, running)
            running.send_signal(signal.SIGKILL)
            ends.append(ended(running, log, "clock set back, killed"))
            running = begun(scene.command(), folder, **fake)
        ends.append(ended(running, log, "clock set back"))
        for end in ends:
            negative = re.search(r"^ *-\d", end.err, re.MULTILINE)
            log.check(not negative, f"clock set back: {end.err}")
        scene.ends_as(folder, ends[-1])
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
    from distributed import Client

    log = scene.log
    address = f"tcp://127.0.0.1:{free_port()}"
    cluster = [begun((sys.executable, *SCHEDULER, address), Path.cwd())]
    try:
        cluster.append(begun((sys.executable, *WORKER, address), Path.cwd()))
        with Client(address) as client:
            client.wait_for_workers(1)

            def given() -> dict[str, Any]:
                return client.processing()  # pyright: ignore[reportReturnType]

            while rounds:
                folder = fresh()
                others = given().keys()
                worker = begun((sys.executable, *WORKER, address), folder)
                cluster.append(worker)
                client.wait_for_workers(len(others) + 1)
                (new,) = given().keys() - others
                running = begun((*scene.command(), "--scheduler", address), folder)
                scene.wait_for_row(folder, running)
                time.sleep(scene.rng.uniform(0.0, 0.5))
                while not given()[new] and running.poll() is None:
                    time.sleep(0.01)
                lived = running.poll() is None
                worker.kill()
                end = ended(running, log, scene.name)
                scene.ends_as(folder, end)
                if lived:
                    rounds -= 1
                    log.done["rounds"] += 1
                shutil.rmtree(folder, ignore_errors=True)
    finally:
        for one in cluster:
            one.kill()
            one.communicate()


PLAYED: dict[str, Callable[[Scene, int], None]] = {
    "study killed": killed,
    "two runs": two_runs,
    "disk full": disk_full,
    "clock set back": clock_back,
    "worker killed": worker_killed,
    "prove killed": killed,
}


def scene_of(name: str, seed: int) -> Scene:
    """The scene, with random numbers of its own."""
    rng = np.random.default_rng([seed, list(PLAYED).index(name)])
    if name == "prove killed":
        return Scene(name, PROVE_VERB, trial_of, ["made.jsonl", "said.jsonl"], rng, SHORT)
    more = ("--cold",) if name == "worker killed" else ()
    return Scene(name, (*STUDY_VERB, *more), study_of, ["journal.jsonl"], rng)


def played(scene: Scene, rounds: int) -> Log:
    """What was done and what was wrong in so many rounds, or kills."""
    try:
        PLAYED[scene.name](scene, rounds)
    except ValueError as error:
        scene.log.check(False, f"{scene.name}: a journal cannot be read: {error}")
    return scene.log


def noticed(scene: Scene, rounds: int) -> int:
    """The rounds in which it sees that its protection is gone. Raises RuntimeError if that does
    damage by itself."""
    scene.before = BROKEN[scene.name]
    scene.alone()
    if scene.log.wrong:
        raise RuntimeError(f"{scene.name}: broken it is wrong without a disturbance too")
    seen = 0
    for _ in range(rounds):
        scene.log = Log()
        seen += bool(played(scene, 1).wrong)
    return seen


def main() -> None:
    """All scenes."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--rounds", type=int, default=5, help="of every other scene")
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--scenes", nargs="+", choices=PLAYED, default=list(PLAYED))
    parser.add_argument("--broken", action="store_true", help="each has to notice what is missing")
    parser.add_argument("--out", type=Path, help="a JSON file for the counts")
    given = parser.parse_args()
    print(f"seed {given.seed}", flush=True)
    # Runs in the background ignore it, and so would all that they start.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    ctypes.CDLL(None).prctl(_SUBREAPER, 1, 0, 0, 0)
    proves = given.kills // 4
    rounds = {"prove killed": proves, "study killed": given.kills - proves}
    record: dict[str, Any] = {"seed": given.seed}
    right = True
    for name in given.scenes:
        scene = scene_of(name, given.seed)
        scene.undisturbed()
        if given.broken:
            seen = noticed(scene, given.rounds)
            record[name] = f"noticed in {seen} of {given.rounds}"
            right &= seen == given.rounds
        else:
            log = played(scene, rounds.get(name, given.rounds))
            record[name] = {"done": log.done, "wrong": log.wrong}
            right &= not log.wrong
        print(name, record[name], flush=True)
        if given.out:
            write_json(given.out, record)
    sys.exit(not right)


if __name__ == "__main__":
    main()
