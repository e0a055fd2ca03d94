"""A study of many cases with one process and with several, warm and cold; and idle cases.

`python -m benchmarks.study [--cases N] [--workers W]` writes results/bench/study.md. Wall-clock
seconds from the first case handed out to the last row in the journal; the start of the processes
and what they load and build is within. An idle case does nothing: what is left is what handing a
case to a process, taking its row back and syncing the journal cost.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.results import machine, write, yardstick
from rr_opt.batch.journal import Journal
from rr_opt.batch.pools import LocalPool
from rr_opt.batch.run import run
from rr_opt.design.study.case import Task, solve_case, solve_study
from rr_opt.design.study.plan import plan
from rr_opt.design.study.row import Row, row_record
from rr_opt.files.study_file import Study, read_study
from rr_opt.outcome import Status

STUDY = """
problem:
  gait: {{amplitude: [0.05, 1.5], period: [0.4 s, 3 s]}}
vary:
  limits.rate: {{from: 15 rpm, to: 60 rpm, count: {rates}}}
  limits.torque: {{from: 0.05, to: 0.5, count: {torques}, spacing: log}}
"""


def idle(_task: Task) -> Row:
    """A case that takes no time."""
    return Row(Status.NOT_CONVERGED, "Nothing was done.")


def study_of(cases: int) -> Study:
    """The prototype over rate and torque, with about this many cases."""
    torques = max(2, round(cases**0.5))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "study.yaml"
        path.write_text(STUDY.format(rates=max(2, round(cases / torques)), torques=torques))
        return read_study(path)[0]


def measure(
    study: Study, workers: int, solve: Callable[[Task], Row], *, cold: bool
) -> tuple[float, Mapping[int, Row]]:
    """Wall-clock seconds of all cases, and their rows."""
    planned = plan([axis.numbers for axis in study.axes], study.shape)
    rows: dict[int, Row] = {}
    with tempfile.TemporaryDirectory() as folder:
        begun = time.perf_counter()
        pool = LocalPool(workers)
        with Journal(Path(folder) / "journal.jsonl", {"input_sha256": study.sha256}) as journal:
            found = solve_study(study.problems, planned, {}, partial(run, pool, solve), cold=cold)
            for case, row in found:
                journal.append(case, row_record(row))
                rows[case] = row
        taken = time.perf_counter() - begun
        pool.close()
    return taken, rows


def line(name: str, taken: float, rows: Mapping[int, Row]) -> dict[str, Any]:
    """One measurement."""
    cpu = sum(row.seconds for row in rows.values())
    return {
        "run": name,
        "cases": len(rows),
        "wall": taken,
        "per case": 1e3 * taken / len(rows),
        "cpu per case": 1e3 * cpu / len(rows),
        "cold": sum(row.started == "cold" for row in rows.values()),
        "checked": sum(row.started == "warm and cold" for row in rows.values()),
    }


def table(lines: list[dict[str, Any]], apart: float) -> list[str]:
    """The measurements as Markdown."""
    text = [
        "# Study: seconds for a batch",
        "",
        f"{machine()}. Times per case are ms. "
        "`cold`: cases solved from cold starts; `checked`: from neighbours' "
        "optima and from cold starts; the others from neighbours' optima alone.",
        "",
        "| run | cases | wall, s | wall per case | CPU per case | cold | checked |",
        "|---|---|---|---|---|---|---|",
    ]
    for one in lines:
        text.append(
            f"| {one['run']} | {one['cases']} | {one['wall']:.1f} | {one['per case']:.1f} | "
            f"{one['cpu per case']:.1f} | {one['cold']} | {one['checked']} |"
        )
    return [*text, "", f"Largest difference of a speed, warm against cold, relative: {apart:.0e}."]


def compared(lines: list[dict[str, Any]], yard: float) -> dict[str, float]:
    """What neighbours' optima and a second process save, and a case against the yardstick."""
    _, cold, warm, several = lines
    return {
        "cold/warm, CPU": cold["cpu per case"] / warm["cpu per case"],
        "one process/several, wall": warm["wall"] / several["wall"],
        "yardstick/warm case, CPU": 1e3 * yard / warm["cpu per case"],
    }


def main() -> None:
    """Measure and store."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=2)
    asked = parser.parse_args()
    study = study_of(asked.cases)
    lines, speeds, yards = [], {}, [yardstick()]
    for name, workers, solve, cold in (
        ("idle, 1 process", 1, idle, True),
        ("cold, 1 process", 1, solve_case, True),
        ("warm, 1 process", 1, solve_case, False),
        (f"warm, {asked.workers} processes", asked.workers, solve_case, False),
    ):
        taken, rows = measure(study, workers, solve, cold=cold)
        lines.append(line(name, taken, rows))
        yards.append(yardstick())  # the machine's speed changes while they run
        speeds[name] = {case: row.optimum.speed for case, row in rows.items() if row.optimum}
        print(lines[-1], flush=True)
    cold, warm = speeds["cold, 1 process"], speeds["warm, 1 process"]
    apart = max(abs(warm[case] / speed - 1) for case, speed in cold.items())
    text = table(lines, apart)
    write("study", text, compared(lines, statistics.median(yards)))
    print("\n".join(text))


if __name__ == "__main__":
    main()
