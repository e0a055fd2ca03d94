"""CPU and wall seconds of a new process from its begin to one answer, imports and all.

`python -m benchmarks.optimise.peers.once ALTERNATIVE PROBLEM`
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
from importlib import import_module
from resource import RUSAGE_CHILDREN, getrusage

FOLDER = "benchmarks.optimise.peers"


def cold(alternative: str, problem: str) -> tuple[float, float] | None:
    """CPU and wall seconds, children's included; None where it fails."""
    before, begun = getrusage(RUSAGE_CHILDREN), time.perf_counter()
    command = [sys.executable, "-m", f"{FOLDER}.once", alternative, problem]
    ended = subprocess.run(command, check=False, capture_output=True, timeout=300)
    wall, after = time.perf_counter() - begun, getrusage(RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return None if ended.returncode else (used, wall)


def main(alternative: str, problem: str) -> None:
    from benchmarks.optimise.peers.posed import posed
    from benchmarks.optimise.problems import PROBLEMS

    stated = posed(PROBLEMS[problem])
    claim = import_module(f"{FOLDER}.{alternative}").prepare(stated)(stated.starts(1, 0)[0])
    print(json.dumps(claim.speed))


if __name__ == "__main__":
    main(*sys.argv[1:])
