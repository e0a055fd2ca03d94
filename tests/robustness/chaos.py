"""Runs that are killed, starved and crossed: `python -m tests.robustness.chaos --kills 200`.

After every disturbance the same command is given again until it ends, and what it wrote is held
against that of an undisturbed run: no case lost, done twice or different. Writes the counts, with
the seed, to --out.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

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
RR_OPT = (sys.executable, "-c", "from rr_opt.cli.entry import main; main()")
STUDY_RUN = (*RR_OPT, "study", "study.yaml", "--out", "res", "--no-figures")
MAKE_RUN = (
    *RR_OPT, "prove", "--cases", "4", "--seed", "5eed", "--kinds", "null", "--engine", "planar",
    "--make-only", "--workers", "1", "--out", "res",
)  # fmt: skip
Random = np.random.Generator
Study = list[dict[str, str]]
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
    """The command under way in a session of its own."""
    return subprocess.Popen(
        command, cwd=folder, env={**os.environ, "OPENBLAS_NUM_THREADS": "1", **more},
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True,
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


def study_of(folder: Path) -> Study:
    """The rows of study.csv."""
    with (folder / "res" / "study.csv").open() as file:
        return list(csv.DictReader(file))


def same(one: Study, two: Study) -> str:
    """How two studies differ; empty if they do not."""
    if [row["case"] for row in one] != [row["case"] for row in two]:
        return f"{len(one)} rows, and {len(two)}"
    for left, right in zip(one, two, strict=True):
        for key in left:
            if any(word in key for word in ("seconds", "started")):
                continue
            if not _close(left[key], right[key]):
                return f"case {left['case']}: {key} {left[key]} and {right[key]}"
    return ""


def _close(one: str, two: str) -> bool:
    if one == two:
        return True
    try:
        a, b = float(one), float(two)
    except ValueError:
        return False
    return abs(a - b) <= CLOSE * max(abs(a), abs(b), 1e-3)


def fresh() -> Path:
    """A folder with the study."""
    folder = Path(tempfile.mkdtemp(prefix="chaos-"))
    (folder / "study.yaml").write_text(STUDY)
    return folder


def undisturbed(command: Sequence[str], log: Log) -> Study:
    """The study that nothing disturbs."""
    folder = fresh()
    end = ended(begun(command, folder), log, "undisturbed")
    log.check(end.code == 0, f"undisturbed: {end}")
    found = study_of(folder)
    shutil.rmtree(folder)
    return found


def killed(
    name: str, command: Sequence[str], journal: str, kills: int, rng: Random, log: Log,
    finished: Callable[[Path], str],
) -> None:  # fmt: skip
    """Kill runs at random moments, give the command again, and look at what it wrote at its end.

    finished: what is wrong with the folder of a run that ended
    """
    begin = time.monotonic()
    folder = fresh()
    ended(begun(command, folder), log, f"{name}, undisturbed")
    longest = time.monotonic() - begin
    log.check(not finished(folder), f"{name}, undisturbed: {finished(folder)}")
    shutil.rmtree(folder)
    folder, before = fresh(), {}
    while kills:
        running = begun(command, folder)
        time.sleep(rng.uniform(0.0, longest))
        number = SIGNALS[rng.integers(3)]
        lived = running.poll() is None
        if lived:
            # As Ctrl-C in a terminal, which goes to the whole group, or to the process alone.
            to_all = number == signal.SIGINT and rng.random() < 0.5
            (os.killpg if to_all else os.kill)(running.pid, number)
        end = ended(running, log, f"{name}, {number.name}")
        if lived:
            kills -= 1
            log.done[f"{name}, {number.name}"] += 1
            # A signal may come before the run has taken it over, or after its work is done.
            codes = {0, -number} if number == signal.SIGKILL else {0, 130, -number}
            log.check(
                end.code in codes, f"{name}, {number.name}: exit {end.code}: {end.err[-300:]}"
            )
        now = rows(folder / "res" / journal)
        lost = [case for case, line in before.items() if now.get(case) != line]
        log.check(not lost, f"{name}, {number.name}: rows {lost} are lost or changed")
        before = now
        if end.code == 0:
            log.done[f"{name}, finished"] += 1
            log.check(not finished(folder), f"{name}: {finished(folder)}")
            shutil.rmtree(folder)
            folder, before = fresh(), {}
    end = ended(begun(command, folder), log, f"{name}, at last")
    log.check(end.code == 0 and not finished(folder), f"{name}, at last: {end} {finished(folder)}")
    shutil.rmtree(folder)


def two_runs(rounds: int, reference: Study, log: Log) -> None:
    """Two runs into one folder: one ends, the other is refused."""
    for _ in range(rounds):
        folder = fresh()
        both = [begun(STUDY_RUN, folder) for _ in range(2)]
        ends = [ended(one, log, "two runs") for one in both]
        codes = sorted(end.code for end in ends)
        log.done["two runs into one folder"] += 1
        log.check(codes in ([0, 2], [0, 0]), f"two runs: exit {codes}")
        log.check(not same(study_of(folder), reference), "two runs: another study")
        shutil.rmtree(folder)


def disk_full(rounds: int, reference: Study, rng: Random, log: Log) -> None:
    """A disk that is full in between."""
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
                free = 256 * 1024 - 4096 * int(rng.integers(0, 6))
                file.write(b"\0" * (free - 4096))
            end = ended(begun(STUDY_RUN, folder), log, "disk full")
            log.done["disk full"] += 1
            said = "No space left" in end.err or "full" in end.err
            log.check(end.code == 2 and said, f"disk full: exit {end.code}: {end.err[-300:]}")
            before = rows(disk / "journal.jsonl")
            ballast.unlink()
            end = ended(begun(STUDY_RUN, folder), log, "disk with room again")
            now = rows(disk / "journal.jsonl")
            log.check(
                all(now.get(case) == line for case, line in before.items()), "disk full: lost"
            )
            right = end.code == 0 and not same(study_of(folder), reference)
            log.check(right, f"disk with room again: exit {end.code}: {end.err[-300:]}")
        finally:
            subprocess.run(("umount", str(disk)), check=False)
        shutil.rmtree(folder)


def clock_back(rounds: int, reference: Study, rng: Random, log: Log) -> None:
    """The clock of the machine set back by a day during a run, and a run killed after that."""
    if shutil.which("faketime") is None:
        log.done["clock set back: faketime is not installed"] += 1
        return
    for _ in range(rounds):
        folder = fresh()
        clock = folder / "clock"
        clock.write_text("+0")
        fake = {
            "FAKETIME_TIMESTAMP_FILE": str(clock), "FAKETIME_NO_CACHE": "1",
            "FAKETIME_DONT_FAKE_MONOTONIC": "1", "LD_PRELOAD": _faketime(),
        }  # fmt: skip
        running = begun(STUDY_RUN, folder, **fake)
        time.sleep(rng.uniform(0.5, 4.0))
        clock.write_text("-1d")
        if rng.random() < 0.5:
            time.sleep(rng.uniform(0.5, 2.0))
            running.send_signal(signal.SIGKILL)
            ended(running, log, "clock set back, killed")
            running = begun(STUDY_RUN, folder, **fake)
        end = ended(running, log, "clock set back")
        log.done["clock set back"] += 1
        right = end.code == 0 and not same(study_of(folder), reference)
        log.check(right, f"clock set back: exit {end.code}: {end.err[-300:]}")
        shutil.rmtree(folder)


def _faketime() -> str:
    found = subprocess.run(
        ("faketime", "-f", "+0", "printenv", "LD_PRELOAD"),
        capture_output=True,
        text=True,
        check=True,
    )
    return found.stdout.strip()


def worker_killed(rounds: int, rng: Random, log: Log) -> None:
    """A worker of a dask cluster is killed at a random moment."""
    reference = undisturbed((*STUDY_RUN, "--cold"), log)
    address = f"tcp://127.0.0.1:{free_port()}"
    cluster = [begun((sys.executable, *SCHEDULER, address), Path.cwd())]
    try:
        spare = begun((sys.executable, *WORKER, address), Path.cwd())
        cluster.append(spare)
        for _ in range(rounds):
            folder = fresh()
            worker = begun((sys.executable, *WORKER, address), folder)
            cluster.append(worker)
            time.sleep(3.0)
            running = begun((*STUDY_RUN, "--scheduler", address, "--cold"), folder)
            end = time.monotonic() + PATIENCE
            while not rows(folder / "res" / "journal.jsonl") and time.monotonic() < end:
                time.sleep(0.05)
            time.sleep(rng.uniform(0.0, 2.0))
            worker.kill()
            found = ended(running, log, "worker killed")
            log.done["worker of a cluster killed"] += 1
            other = same(study_of(folder), reference) if found.code == 0 else found.err[-300:]
            log.check(not other, f"worker killed: exit {found.code}: {other}")
            shutil.rmtree(folder, ignore_errors=True)
    finally:
        for one in cluster:
            one.kill()
            one.communicate()


def sealed(folder: Path) -> str:
    """What is wrong with the cases that were made; empty if nothing is."""
    place = folder / "res"
    made = rows(place / "made.jsonl")
    answers = sorted(path.name for path in (place / "answers").glob("*.json"))
    if sorted(made) != [1, 2, 3, 4] or len(answers) != 4:
        return f"cases {sorted(made)}, answers {answers}"
    check = ("sha256sum", "--check", "--status", "seals.txt")
    if subprocess.run(check, cwd=place, check=False).returncode:
        return "an answer is not that of its seal"
    return ""


def main() -> None:
    """All scenes."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--rounds", type=int, default=5, help="of every other scene")
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--out", type=Path, help="a JSON file for the counts")
    given = parser.parse_args()
    # Runs in the background ignore it, and so would all that they start.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    rng, log = np.random.default_rng(given.seed), Log()
    reference = undisturbed(STUDY_RUN, log)
    begin = time.monotonic()
    scenes: dict[str, Callable[[], None]] = {
        "study killed": lambda: killed(
            "study", STUDY_RUN, "journal.jsonl", given.kills - given.kills // 4, rng, log,
            lambda place: same(study_of(place), reference),
        ),
        "two runs": lambda: two_runs(given.rounds, reference, log),
        "disk full": lambda: disk_full(given.rounds, reference, rng, log),
        "clock set back": lambda: clock_back(given.rounds, reference, rng, log),
        "worker killed": lambda: worker_killed(given.rounds, rng, log),
        "prove killed": lambda: killed(
            "prove", MAKE_RUN, "made.jsonl", given.kills // 4, rng, log, sealed
        ),
    }  # fmt: skip
    for name, scene in scenes.items():
        scene()
        print(f"{time.monotonic() - begin:6.0f} s  {name}  {dict(log.done)}", flush=True)
        if given.out:
            write_json(given.out, {"seed": given.seed, "done": log.done, "wrong": log.wrong})
    sys.exit(bool(log.wrong))


if __name__ == "__main__":
    main()
