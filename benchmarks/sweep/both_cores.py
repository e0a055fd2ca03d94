"""How much sooner a sweep is done where more than one processor is free."""

from __future__ import annotations

import os
import time

from benchmarks.sweep.case import Work
from benchmarks.sweep.ways import OURS


def lines(work: Work, rounds: int) -> list[str]:
    """Wall-clock seconds of all points on one processor and on all, the least of the rounds."""
    free = os.sched_getaffinity(0)
    everywhere = set(range(os.cpu_count() or 1))
    told = []
    for processors in ({min(everywhere)}, everywhere):
        os.sched_setaffinity(0, processors)
        walls, shares = [], []
        for _ in range(rounds):
            wall, cpu = time.perf_counter(), time.process_time()
            OURS.run(work, 0)
            walls.append(time.perf_counter() - wall)
            shares.append((time.process_time() - cpu) / walls[-1])
        told.append(
            f"On {len(processors)} processor(s) {work.size:,} points with {work.friction} friction "
            f"took {min(walls):.2f} s (least of {rounds}), {max(shares):.2f} processors busy at "
            "best."
        )
    os.sched_setaffinity(0, free)
    return [*told, f"Others used this machine too: load {os.getloadavg()[0]:.1f}."]
