"""Spoiled files through every verb: `python -m tests.robustness.fuzz --inputs 20000 --seed 5`.

An input is a folder that is right but for one file. Every verb that reads it has to end with the
right exit code, in time and memory, and with a message that says which file, where, and what to do;
verbs agree with `lint` on what is wrong. Input N of a seed is always the same:
`--only N` runs it again and keeps its folder.
"""

from __future__ import annotations

import argparse
import gc
import json
import os
import re
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from rr_opt.documents.archive import write_json
from tests.robustness.inputs import LONG, Input, Verb, inputs
from tests.robustness.spoil import spoiled

SECONDS, BYTES = 10.0, 2**30
"""Of the processor and of memory that a verb may take for a spoiled file."""
PATIENCE = 600.0
"""s after which a process that does not end is killed: others may be using the processor."""
STOP = 1.5
"""s after which a verb is interrupted that has taken the input and computes."""
_REFUSED = 0.2
"""Of the inputs that `lint` refuses, with how many verbs that compute are tried too."""
DONE = {0, 3, 4}
WRONG, INTERRUPTED = 2, 130
_PLACE = re.compile(r"(:\d+: )|(: [\w.\[\]'\"-]+: )|(row|line|column|key|frame|byte)s? ")
_ADVICE = re.compile(
    "Expected|Lower |Write|Check|Give|Delete|Correct|Name |Export|Save|Cut|Install|Keep|Leave|"
    "Add |Record",
    re.IGNORECASE,
)
_STAGE = re.compile(r" *\d+\.\d s  .*")


@dataclass(frozen=True)
class Ended:
    """How a verb ended. code: negative for a signal; seconds: of the processor."""

    code: int
    out: str
    err: str
    seconds: float
    bytes: int


def ended(verbs: Sequence[Verb], folder: Path, stop: float | None = None) -> list[Ended]:
    """Run verbs in a folder, one after the other in a process of their own, until one crashes.

    stop: when it is interrupted, s
    """
    with tempfile.TemporaryFile("w+") as report:
        child = os.fork()
        if child == 0:
            _child(verbs, folder, report, stop)
        signal.signal(signal.SIGALRM, lambda *_: _kill(child))
        signal.setitimer(signal.ITIMER_REAL, PATIENCE)
        _, status, used = os.wait4(child, 0)
        signal.setitimer(signal.ITIMER_REAL, 0)
        report.seek(0)
        ends = [Ended(*json.loads(line)) for line in report]
    size = 1024 * used.ru_maxrss
    code = os.waitstatus_to_exitcode(status)
    if len(ends) < len(verbs):  # as by a signal, or by os._exit where it was interrupted
        ends.append(Ended(code, *_texts(folder), used.ru_utime + used.ru_stime, size))
    return [replace(end, bytes=size) for end in ends]


def _kill(child: int) -> None:
    with suppress(ProcessLookupError):  # it may have ended at that moment
        os.kill(child, signal.SIGKILL)


OUT, ERR = "..out", "..err"


def _texts(folder: Path) -> tuple[str, str]:
    one, two = ((folder / name).read_bytes()[: 10**6] for name in (OUT, ERR))
    return one.decode("utf-8", "replace"), two.decode("utf-8", "replace")


def _child(verbs: Sequence[Verb], folder: Path, report: TextIO, stop: float | None) -> None:
    """The command as a user's shell runs it; never returns."""
    from rr_opt.cli.entry import main

    os.chdir(folder)
    signal.setitimer(signal.ITIMER_REAL, 0)
    if stop is not None:
        signal.signal(signal.SIGALRM, lambda *_: os.kill(os.getpid(), signal.SIGINT))
        signal.setitimer(signal.ITIMER_REAL, stop)
    code = 0
    for verb in verbs:
        for number, name in ((1, OUT), (2, ERR)):
            file = os.open(name, os.O_CREAT | os.O_TRUNC | os.O_RDWR)
            os.dup2(file, number)
            os.close(file)
        sys.stdout, sys.stderr = (open(n, "w", closefd=False) for n in (1, 2))  # noqa: SIM115
        sys.argv = ["rr-opt", *verb]
        begun, code = time.process_time(), 0
        try:
            main()
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else 1
        except BaseException:
            code = 1
            traceback.print_exc()
        sys.stdout.flush()
        sys.stderr.flush()
        seconds = time.process_time() - begun
        print(json.dumps([code, *_texts(Path()), seconds, 0]), file=report, flush=True)
    os._exit(code)


def judged(verb: Verb, end: Ended, given: Input, lint: int | None) -> list[str]:
    """What is wrong with how a verb ended."""
    wrong = []
    name = verb[0]
    if "Traceback" in end.err + end.out or "Exception ignored" in end.err:
        wrong.append("traceback")
    allowed = {0, WRONG} | (DONE if name in (*LONG, "simulate", "circle") else set())
    allowed |= {INTERRUPTED} if name in LONG and lint == 0 else set()
    if end.code not in allowed:
        wrong.append("exit code")
    if end.seconds > SECONDS or end.code == -signal.SIGKILL:
        wrong.append("time")
    if end.bytes > BYTES:
        wrong.append("memory")
    if lint == WRONG and end.code != WRONG and name != "inspect":
        wrong.append("lint refuses what this verb takes")
    if lint == 0 and end.code == WRONG and name in LONG:
        wrong.append("lint takes what this verb refuses")
    if end.code != WRONG:
        return wrong
    lines = [one for one in (end.err + end.out).splitlines() if one and not _STAGE.fullmatch(one)]
    told = [one for one in lines if "warning: " not in one]
    if not told:
        wrong.append("no message")
    elif not any(file in "\n".join(told) for file in (*given.files, ".:", "/etc/passwd:")):
        wrong.append("no file named")
    elif not _ADVICE.search("\n".join(told)):
        wrong.append("no advice")
    return wrong


def case(seed: int, number: int) -> tuple[str, Input, bytes, float]:
    """Kind, folder, what the spoiled file holds, and a number that decides what is computed."""
    rng = np.random.default_rng([seed, number])
    known = inputs()
    kind = sorted(known)[number % len(known)]
    given = known[kind]
    return kind, given, spoiled(given.files[given.spoilt], given.spoilt, rng), rng.random()


def tried(
    seed: int, number: int, share: float, folder: Path
) -> Iterator[tuple[str, Verb, Ended, list[str]]]:
    """Every verb on an input; share: of inputs that are taken, with which verbs compute."""
    kind, given, content, chance = case(seed, number)
    for name, right in given.files.items():
        (folder / name).write_bytes(content if name == given.spoilt else right)
    quick = [verb for verb in given.verbs if verb[0] not in LONG]
    ends = list(zip(quick, ended(quick, folder), strict=False))
    lint = next((end.code for verb, end in ends if verb[0] == "lint"), None)
    for verb in given.verbs if chance < (share if lint == 0 else _REFUSED) else ():
        if verb[0] in LONG:
            ends += [(verb, *ended([verb], folder, STOP if lint == 0 else None))]
    for verb, end in ends:
        yield kind, verb, end, judged(verb, end, given, lint)


def warm() -> None:
    """Load what verbs load, once for all the processes to come; what is right has to pass."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    import rr_opt.cli.main
    import rr_opt.machines.racer  # noqa: F401

    for kind, given in inputs().items():
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for file, content in given.files.items():
                (folder / file).write_bytes(content)
            for verb in given.verbs:
                if verb[0] in LONG:
                    continue
                end = _here(verb, folder)
                if end.code != 0:
                    raise AssertionError(f"{kind} is not right: {verb}: {end}")
    gc.collect()
    gc.freeze()


def _here(verb: Verb, folder: Path) -> Any:
    from typer.testing import CliRunner

    from rr_opt.cli.main import app

    back = Path.cwd()
    os.chdir(folder)
    try:
        done = CliRunner().invoke(app, list(verb))
    finally:
        os.chdir(back)
    return Ended(done.exit_code, done.stdout, done.stderr, 0.0, 0)


@dataclass
class Counts:
    """Of the inputs of a run."""

    inputs: int = 0
    slowest: float = 0.0
    largest: int = 0
    ends: dict[str, Counter[str]] = field(default_factory=dict)
    wrong: list[str] = field(default_factory=list)

    def merge(self, other: Counts) -> None:
        """Add another's."""
        self.inputs += other.inputs
        self.slowest = max(self.slowest, other.slowest)
        self.largest = max(self.largest, other.largest)
        for verb, codes in other.ends.items():
            self.ends.setdefault(verb, Counter()).update(codes)
        self.wrong += other.wrong

    def add(self, number: int, kind: str, verb: Verb, end: Ended, wrong: list[str]) -> None:
        """Count how a verb ended."""
        self.slowest = max(self.slowest, end.seconds)
        self.largest = max(self.largest, end.bytes)
        self.ends.setdefault(verb[0], Counter())[str(end.code)] += 1
        self.wrong += [f"{number} ({kind}, {verb[0]}, code {end.code}): {one}" for one in wrong]


def run(seed: int, numbers: Iterable[int], share: float) -> Counts:
    """Try inputs by their numbers."""
    counts = Counts()
    for number in numbers:
        counts.inputs += 1
        with tempfile.TemporaryDirectory() as folder:
            for kind, verb, end, wrong in tried(seed, number, share, Path(folder)):
                counts.add(number, kind, verb, end, wrong)
    return counts


def main() -> None:
    """Run, report on stderr as it goes, and write the counts."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--inputs", type=int, default=2000)
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument(
        "--share", type=float, default=0.02, help="of inputs that are computed with"
    )
    parser.add_argument("--only", type=int, help="this input alone, whose folder is kept")
    parser.add_argument("--out", type=Path, help="a JSON file for the counts")
    given = parser.parse_args()
    # A run in the background ignores it, and so would the verbs.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    warm()
    if given.only is not None:
        folder = Path(tempfile.mkdtemp(prefix="fuzz-"))
        for kind, verb, end, wrong in tried(given.seed, given.only, 1.0, folder):
            print(
                kind, *verb, "\n", end.code, f"{end.seconds:.2f} s", wrong, "\n", end.out, end.err
            )
        print(folder)
        return
    begun, done = time.monotonic(), Counts()
    numbers = range(given.first, given.first + given.inputs)
    record = {"seed": given.seed, "kinds": len(inputs()), **vars(done)}
    for first in range(0, given.inputs, 100):
        done.merge(run(given.seed, numbers[first : first + 100], given.share))
        print(f"{done.inputs} inputs, {time.monotonic() - begun:.0f} s, {len(done.wrong)} wrong",
              file=sys.stderr, flush=True)  # fmt: skip
        record |= vars(done)
        if given.out:
            write_json(given.out, record)
    print(json.dumps(record, indent=2))
    sys.exit(bool(done.wrong))


if __name__ == "__main__":
    main()
