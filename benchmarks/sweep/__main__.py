"""Points per second per core of a sweep, at 1e-6 of the average speed, in every way.

`python -m benchmarks.sweep` writes results/bench/sweep.md and sweep.json; some minutes on one
core. `--quick` tries it on few points and writes nothing.
"""

from __future__ import annotations

import os
import sys

# Before anything starts threads of its own: rates are those of one core.
for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"


def main(quick: bool) -> None:
    from benchmarks.results import machine, write
    from benchmarks.sweep import cold, page, profiled
    from benchmarks.sweep.case import plane, space
    from benchmarks.sweep.measure import both_cores, measured
    from benchmarks.sweep.ways import WAYS

    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    cases = {
        "viscous, alpha and T": plane("viscous", 40 if quick else 200),
        "viscous, four dimensions": space("viscous", 8 if quick else 32),
        "quadratic drag, alpha and T": plane("quadratic", 48),
        "quadratic drag, four dimensions": space("quadratic", 7),
        "dry friction, alpha and T": plane("coulomb", 48),
        "dry friction, four dimensions": space("coulomb", 7),
    }
    found = {}
    for label, work in cases.items():
        print(f"{label}: {work.size} points", flush=True)
        found[label] = measured(work, 1 if quick else 3)
    starts: dict[str, dict[str, float]] = {way.name: {} for way in WAYS}
    here = {rate.name for rates in found.values() for rate in rates if not rate.why}
    for way in WAYS:
        for friction in ("viscous", "coulomb"):
            if way.name in here and way.counts[friction != "viscous"]:
                starts[way.name][friction] = cold.seconds(way, friction)
    busy = both_cores(cases["viscous, four dimensions"], 3)
    busy += both_cores(cases["dry friction, alpha and T"], 3)
    nonlinear = {label: work for label, work in cases.items() if work.friction != "viscous"}
    uncompiled = profiled.lines(nonlinear)
    lines, ratios = page.written(machine(), cases, found, starts, busy, uncompiled)
    print("\n".join(lines))
    if not quick:
        write("sweep", lines, ratios)


if __name__ == "__main__":
    main("--quick" in sys.argv[1:])
