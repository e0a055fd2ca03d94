"""CPU seconds to fit six parameters to six recordings, here and elsewhere: `-m benchmarks.fit`.

Writes results/bench/fit.md and fit.json, or, where only some ways are named, nothing. The ways
take turns from near starts, from which all get to the minimum; only who is there counts. Then from
far starts it is counted who still gets there. One core each: libraries' threads are off.
"""

from __future__ import annotations

import argparse
import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault(
    "XLA_FLAGS", "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"
)

import resource
import statistics
import subprocess
import sys
import tempfile

import numpy as np

from benchmarks.fit import ours
from benchmarks.fit.case import TRUE, Array, Case, case, starts
from benchmarks.fit.referee import Minimum, costs, minimum, same
from benchmarks.fit.report import text
from benchmarks.fit.ways import EXAMPLE, OURS, PATIENCE, WAYS, Tried, near, patience, way
from benchmarks.results import installed, write

_DRAWS, _STARTS = 20, 40


def main() -> None:
    """Measure and store."""
    parser = argparse.ArgumentParser()
    parser.add_argument("ways", nargs="*", default=list(WAYS), metavar="WAY")
    parser.add_argument("--rounds", type=int, default=5, help="from near starts")
    parser.add_argument("--far", type=int, default=10, help="far starts of the others")
    parser.add_argument("--patience", type=float, default=PATIENCE, help="CPU seconds of a fit")
    asked = parser.parse_args()
    here = [one for one in asked.ways if installed(WAYS[one].needs)]
    work = case()
    best = minimum(work)
    tried = {one: Tried() for one in here}
    for one in here:
        tried[one].cold = None if WAYS[one].slow else _cold(one)
    for turn, start in enumerate(near(asked.rounds)):
        for one in here:
            if turn < (WAYS[one].most or asked.rounds):
                if turn == 0 and not WAYS[one].slow:
                    way(one)(work, start)
                _near(one, tried[one], work, start, best, asked.patience)
                print(one, turn, tried[one], flush=True)
    for one in here:
        if not WAYS[one].slow:
            count = _STARTS if one == OURS else min(asked.far, WAYS[one].most or asked.far)
            _far(one, tried[one], work, starts(_STARTS)[:count], best)
            print(one, tried[one], flush=True)
    at_bound = _at_bound(best) if OURS in here else float("nan")
    lines = text(tried, [one for one in asked.ways if one not in here], best, at_bound)
    print("\n".join(lines))
    if asked.ways != list(WAYS):
        return  # what is kept tells of all
    mine = statistics.median(tried[OURS].warm)
    ratios = {
        f"{WAYS[one].name}/ours, warm": statistics.median(tried[one].warm) / mine
        for one in here
        if one != OURS and tried[one].warm
    }
    colds = [tried[one].cold for one in (EXAMPLE, OURS) if one in tried]
    if len(colds) == 2 and colds[0] and colds[1]:
        ratios[f"{WAYS[EXAMPLE].name}/ours, cold"] = colds[0] / colds[1]
    ratios["far starts reached"] = tried[OURS].reached / max(len(tried[OURS].far), 1)
    write("fit", lines, ratios)


def _near(one: str, to: Tried, work: Case, start: Array, best: Minimum, most: float) -> None:
    try:
        with patience(most):
            seconds, p = _timed(one, work, start)
    except TimeoutError:
        to.stopped = most
        return
    cost = costs(work, p[None])
    if same(cost, best.cost)[0]:
        to.warm.append(seconds)
        to.worst = max(to.worst, float(cost[0] / best.cost - 1))
    else:
        to.missed += 1


def _far(one: str, to: Tried, work: Case, begin: Array, best: Minimum) -> None:
    done = [_timed(one, work, start) for start in begin]
    to.far = [seconds for seconds, _ in done]
    to.reached = int(same(costs(work, np.array([p for _, p in done])), best.cost).sum())


def _timed(one: str, work: Case, start: Array) -> tuple[float, Array]:
    """CPU seconds, of this process and of what it starts, and the parameters."""
    begun = _cpu()
    p = way(one)(work, start)
    return _cpu() - begun, p


def _cold(one: str) -> float:
    """CPU seconds of a process of its own, with nothing compiled before."""
    with tempfile.TemporaryDirectory() as cache:
        begun = _cpu()
        subprocess.run(
            [sys.executable, "-m", "benchmarks.fit.ways", one],
            check=True, capture_output=True, env={**os.environ, "XDG_CACHE_HOME": cache},
        )  # fmt: skip
        return _cpu() - begun


def _cpu() -> float:
    every = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(used.ru_utime + used.ru_stime for used in every)


def _at_bound(best: Minimum) -> float:
    """The mean square of our errors over draws of the noise, in units of the bound: 1 is on it."""
    inverse = np.linalg.inv(best.covariance)
    errors = [ours.fit(case(seed), near(1)[0]) / TRUE - 1 for seed in range(1, _DRAWS + 1)]
    return float(np.mean([e @ inverse @ e for e in errors])) / TRUE.size


if __name__ == "__main__":
    main()
