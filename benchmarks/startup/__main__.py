"""Time until `rr-opt` answers: `python -m benchmarks.startup` writes results/bench/startup.md.

Every command runs in a process of its own, in turn with the floors: what Python takes to start and
to load the libraries that a verb cannot do without. The first line is the wall-clock time until
stdout begins; CPU is of the whole process. Then each verb is run once more to see what it loads
without using it.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from benchmarks.results import machine, spread, write
from benchmarks.startup.commands import FLOORS, LIGHT, LONG, program, verbs
from benchmarks.startup.loaded import package

ROOT = Path(__file__).parents[2]
_WORTH = 3.0
"""ms of importing below which a package is not told."""
_PATIENCE = 60.0
"""s that a verb may take under the profile."""
_IMPORTED = re.compile(r"import time:\s+(\d+) \|\s+\d+ \|\s+(\S+)")


@dataclass
class Times:
    """Seconds of the runs of a command: to the first line, and of CPU."""

    first: list[float] = field(default_factory=list)
    cpu: list[float] = field(default_factory=list)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--rounds", type=int, default=7)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        every = {name: [program(), *given] for name, given in verbs(Path(place)).items()}
        floors = {name: [sys.executable, "-c", code] for name, code in FLOORS.items()}
        light = {**floors, **{name: every[name] for name in LIGHT}}
        long = {name: every[name] for name in LONG}
        short = {name: every[name] for name in every if name not in LONG}
        times = {name: Times() for name in (*floors, *every)}
        for commands, rounds in ((light, asked.rounds), ({**floors, **short}, 3), (long, 1)):
            for _ in range(rounds):
                for name, command in commands.items():
                    _run(command, times[name])
        needless = {name: None if name in LONG else _needless(command[1:], Path(place))
                    for name, command in every.items()}  # fmt: skip
    casadi, numpy = (statistics.median(times[f"python -c 'import {one}'"].cpu)
                     for one in ("casadi", "numpy"))  # fmt: skip
    ratios = {
        f"import {'numpy' if name in LIGHT else 'casadi'}/{name}, CPU": (
            numpy if name in LIGHT else casadi
        )
        / statistics.median(times[name].cpu)
        for name in every
    }
    write("startup", _text(times, needless), ratios)


def _run(command: Sequence[str], times: Times) -> None:
    """Run a command and note its times."""
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    begun = time.perf_counter()
    run = subprocess.Popen(
        command, cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    )
    if run.stdout is None:
        raise RuntimeError("there is no pipe")
    run.stdout.readline()
    times.first.append(time.perf_counter() - begun)
    run.stdout.read()
    _, status, used = os.wait4(run.pid, 0)
    run.returncode = os.waitstatus_to_exitcode(status)
    run.stdout.close()
    if run.returncode:
        raise RuntimeError(f"{' '.join(command)} ended with {run.returncode}")
    times.cpu.append(used.ru_utime + used.ru_stime)


def _needless(arguments: Sequence[str], place: Path) -> Mapping[str, float] | None:
    """ms of importing by package that a verb loads and does not use; None if it takes too long."""
    file = place / "loaded.json"
    command = [sys.executable, "-X", "importtime", "-m", "benchmarks.startup.loaded", str(file)]
    try:
        run = subprocess.run(
            [*command, *arguments],
            cwd=ROOT, capture_output=True, text=True, check=False, timeout=_PATIENCE,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return None
    took: dict[str, float] = defaultdict(float)
    for line in run.stderr.splitlines():
        if told := _IMPORTED.match(line):
            took[package(told[2])] += int(told[1]) / 1000
    unused = json.loads(file.read_text(encoding="utf-8"))["unused"]
    return {name: took[name] for name in sorted(unused, key=lambda name: -took[name])
            if took[name] >= _WORTH}  # fmt: skip


def _text(
    times: Mapping[str, Times], needless: Mapping[str, Mapping[str, float] | None]
) -> list[str]:
    lines = [
        "# Startup: time until `rr-opt` answers",
        "",
        f"Written by `python -m benchmarks.startup`. {machine()}. Fresh processes, interleaved; "
        "seconds, median (least to most). `first line`: wall-clock until stdout begins, or, where "
        "nothing is printed, ends. `over`: CPU beyond that of `import casadi`; for verbs that "
        "compute next to nothing beyond `python -c pass`. Loaded and not used: packages none of "
        "whose functions is called outside of an import, ms of their own importing under a "
        "profile, which slows it; some come with a library that is used.",
        "",
        "| command | runs | first line | CPU | over | loaded and not used, ms |",
        "|---|---|---|---|---|---|",
    ]
    bare, casadi = (statistics.median(times[name].cpu)
                    for name in ("python -c pass", "python -c 'import casadi'"))  # fmt: skip
    for name, one in times.items():
        over, told = "", ""
        if name in needless:
            over = f"{statistics.median(one.cpu) - (bare if name in LIGHT else casadi):+.2f}"
            told = _loaded(needless[name])
        shown = name if name in FLOORS else f"rr-opt {name}"
        lines.append(
            f"| `{shown}` | {len(one.cpu)} | {spread(one.first)} | {spread(one.cpu)} | {over} | "
            f"{told} |"
        )
        print(lines[-1], flush=True)
    return lines


def _loaded(needless: Mapping[str, float] | None) -> str:
    if needless is None:
        return "not looked at: too long"
    return ", ".join(f"{what} {ms:.0f}" for what, ms in needless.items()) or "none"


if __name__ == "__main__":
    main()
