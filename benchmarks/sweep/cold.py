"""A way in a fresh process: imports, compiling, and 64 points.

`python -m benchmarks.sweep.cold MODULE FUNCTION FRICTION STEPS` is that process.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile

from benchmarks.sweep.case import plane
from benchmarks.sweep.ways import Way

_POINTS = 64
STEPS = {"rk4": 256, "nodes": 64, "": 0}


def seconds(way: Way, friction: str) -> float:
    """CPU seconds of the process and what it starts, with nothing in any cache."""
    with tempfile.TemporaryDirectory() as cache:
        environment = {**os.environ, "XDG_CACHE_HOME": cache}
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        command = [sys.executable, "-m", __name__, way.module, way.function, friction]
        subprocess.run([*command, str(STEPS[way.steps])], check=True, env=environment)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def main(module: str, function: str, friction: str, steps: str) -> None:
    """The process."""
    work = plane(friction, 200 if friction == "viscous" else 48).part(_POINTS)
    Way(module, function, (), (0, 0)).run(work, int(steps))


if __name__ == "__main__":
    main(*sys.argv[1:])
