"""`rr-opt diagnose` on eight recordings of 30 s at 100 Hz: the whole command, and where it goes.

`python -m benchmarks.diagnose` writes results/bench/diagnose.md. The recordings are simulated by
the model itself, which is enough for times: nothing missing, dry friction, slipping wheels, and a
rolling force that no effect of the catalogue makes. Each is timed once with a compiler and an empty
cache, then three times with what was compiled, and once without a compiler, which is not waited for
to the end. For the slowest a profile says what the time goes into.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from benchmarks.diagnose.case import HIDDEN, record
from benchmarks.diagnose.profiled import lines as profile
from benchmarks.results import machine, spread, write, yardstick

USUAL, NOW, NEVER = "compiled before", "compiled now", "no compiler"
WAYS = {NOW: 1, USUAL: 3, NEVER: 1}
"""How often each is timed, in this order: what is compiled now is there for the next."""

PATIENCE = 60.0
"""s, the goal; without a compiler it is not waited for longer."""

SHOWN = 0.05
"""s; a stage that takes less in every case has no line."""


def main() -> None:
    lines = [
        "# `rr-opt diagnose`, eight recordings of 30 s at 100 Hz",
        "",
        f"Written by `python -m benchmarks.diagnose`. {machine()}. Wall-clock seconds of the "
        f"whole command, page included: {USUAL}, the median of {WAYS[USUAL]} (least to most), and "
        f"once each with an empty cache and without a compiler, {PATIENCE:.0f} s at most.",
        "",
        f"| hidden | {' | '.join(WAYS)} | verdict |",
        "|---|---|---|---|---|",
    ]
    ratios, stages, slowest = {}, {}, (0.0, "")
    with tempfile.TemporaryDirectory() as place:
        for name, (effect, values) in HIDDEN.items():
            folder = Path(place) / name.replace(" ", "-")
            record(folder, effect, values)
            yard, cells, middle, verdict, late = yardstick(), [], {}, "", ""
            for way, times in WAYS.items():
                walls = []
                for _ in range(times):
                    wall, found = timed(folder, Path(place), way)
                    walls.append(wall)
                    if way == USUAL:
                        verdict = found["verdict"]
                        told = found["seconds"]
                        stages[name] = told | {
                            "reading, figures and page": wall - sum(told.values())
                        }
                late = "> " if max(walls) > PATIENCE and way == NEVER else ""
                cells.append(spread(walls, 1) if way == USUAL else f"{late}{walls[0]:.1f}")
                middle[way] = statistics.median(walls)
            lines.append(f"| {name} | {' | '.join(cells)} | {verdict} |")
            ratios[f"{name}, yardstick/{USUAL}"] = yard / middle[USUAL]
            if not late:
                ratios[f"{name}, {NEVER}/{USUAL}"] = middle[NEVER] / middle[USUAL]
            slowest = max(slowest, (middle[USUAL], name))
            print(lines[-1], flush=True)
        lines += ["", "## Where the time goes", "", *_stages(stages), ""]
        lines += [f"The slowest, {slowest[1]}, once more:", ""]
        lines += profile(Path(place) / slowest[1].replace(" ", "-"))
    write("diagnose", lines, ratios)


def _stages(stages: Mapping[str, Mapping[str, float]]) -> list[str]:
    """Seconds of every stage, compiled before, of the last run of each case."""
    names = list(dict.fromkeys(name for told in stages.values() for name in told))
    rows = {name: [told.get(name, 0.0) for told in stages.values()] for name in names}
    return [
        f"| stage, s | {' | '.join(stages)} |",
        "|---" * (len(stages) + 1) + "|",
        *(
            f"| {name} | {' | '.join(f'{seconds:.1f}' for seconds in row)} |"
            for name, row in rows.items()
            if max(row) > SHOWN
        ),
    ]


def timed(folder: Path, place: Path, way: str) -> tuple[float, dict]:
    """Wall-clock seconds of the command, and what it found; nothing where it was not waited for."""
    cache, compiler = place / f"cache-{folder.name}", "cc"
    if way == NEVER:
        cache, compiler = place / f"no-cache-{folder.name}", "no-such-compiler"
    environment = {**os.environ, "XDG_CACHE_HOME": str(cache), "CC": compiler}
    out = place / "out"
    command = [str(Path(sys.executable).with_name("rr-opt")), "diagnose", str(folder)]
    limit = PATIENCE if way == NEVER else None
    began = time.perf_counter()
    with suppress(subprocess.TimeoutExpired):
        subprocess.run(
            [*command, "--out", str(out)],
            check=True,
            env=environment,
            capture_output=True,
            timeout=limit,
        )
        wall = time.perf_counter() - began
        return wall, json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))
    return time.perf_counter() - began, {}


if __name__ == "__main__":
    main()
