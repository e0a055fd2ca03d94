"""Rates of all ways on one case, in turns, each held against the same speeds first."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from benchmarks.sweep.case import ACCURACY, LEAST_SPEED, Array, Work, drawn, error
from benchmarks.sweep.ways import NODES, NUMBA, OURS, WAYS, Way
from benchmarks.sweep.ways.ours import run

_TIGHT = {"viscous": 1e-9, "quadratic": 1e-8, "coulomb": 2e-7}
"""Tolerance of the speeds that all are held against; solve_ivp, which shares nothing with them, is
one of those that have to agree."""

_CHECKED = 4096
"""Points whose speeds are looked at, of those that have more; only those that take no steps do."""

_LONG = 6.0
"""A way that takes longer, s, is run once."""


@dataclass
class Rate:
    """Points per CPU second, by round, and per wall-clock second; error: the largest; why: it is
    not here."""

    name: str
    points: int = 0
    error: float = float("nan")
    cpu: list[float] = field(default_factory=list)
    wall: list[float] = field(default_factory=list)
    why: str = ""

    @property
    def close(self) -> bool:
        """Whether it gives the same answer."""
        return self.error <= ACCURACY


def measured(work: Work, rounds: int) -> list[Rate]:
    """The ways in turns, rounds times; the first run of each, which may compile, is the check."""
    rates, ready, parts = [], [], {}
    for way in WAYS:
        count = way.counts[work.friction != "viscous"]
        if not count:
            continue
        rate = Rate(way.name)
        rates.append(rate)
        part = parts.setdefault(count, work.part(count))
        try:
            job = _Job(way, part)
            rate.points, rate.error = part.size, job.check()
        except ImportError as missing:
            rate.why = f"not available here: {missing}"
            continue
        print(f"  {rate.name}: {part.size} points, error {rate.error:.1e}", flush=True)
        ready.append((job, rate))
    for _ in range(rounds):
        for job, rate in ready:
            if rate.cpu and rate.points / rate.cpu[-1] > _LONG:
                continue
            wall, cpu = time.perf_counter(), time.process_time()
            job.run()
            rate.cpu.append(rate.points / (time.process_time() - cpu))
            rate.wall.append(rate.points / (time.perf_counter() - wall))
    return rates


@lru_cache
def _true(work: Work) -> Array:
    return run(work, 0, _TIGHT[work.friction])


@lru_cache
def _needed(kind: str, work: Work) -> NDArray[np.int_]:
    return needed(kind, work, _true(work))


_LEAST, _MOST = {"rk4": 32, "nodes": 16}, {"rk4": 16384, "nodes": 1024}


def needed(kind: str, work: Work, true: Array) -> NDArray[np.int_]:
    """How many steps or nodes a period each point needs: the fewest that are close enough, (K,).

    Found beforehand and not counted, which favours whoever takes fixed steps. Powers of two; with
    fewer than twice as many, the error may be small by chance.
    """
    finder = NUMBA if kind == "rk4" else NODES
    found = np.zeros(work.size, int)
    pending = np.arange(work.size)
    n = _LEAST[kind]
    before = np.zeros(work.size, bool)
    while len(pending):
        speed = finder.run(work.only(pending), n)
        good = np.abs(speed - true[pending]) <= ACCURACY * np.maximum(true[pending], LEAST_SPEED)
        settled = good & before[pending] | (n >= _MOST[kind])
        found[pending[settled]] = n // 2
        before[pending] = good
        pending, n = pending[~settled], 2 * n
    return found


class _Job:
    """A way and its points, in groups that take as many steps."""

    def __init__(self, way: Way, work: Work) -> None:
        self._run, self._size = way.run, work.size
        self._checked = work.part(_CHECKED)
        self._true = _true(self._checked)
        steps = _needed(way.steps, work) if way.steps else np.zeros(work.size, int)
        self._groups = [(n, np.flatnonzero(steps == n)) for n in np.unique(steps).tolist()]
        self._works = [
            work if len(self._groups) == 1 else work.only(own) for _, own in self._groups
        ]

    def run(self) -> Array:
        """|speed| of all points."""
        speed = np.empty(self._size)
        for (n, own), work in zip(self._groups, self._works, strict=True):
            speed[own] = self._run(work, n)
        return speed

    def check(self) -> float:
        """The largest error, of the points that are looked at."""
        speed = self.run()
        if self._size > self._checked.size:
            speed = speed[drawn(self._size, _CHECKED)]
        return error(speed, self._true)


def both_cores(work: Work, rounds: int) -> list[str]:
    """How much sooner a sweep is done where more than one processor is free.

    Wall-clock seconds of all points on one processor and on all, the least of the rounds.
    """
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
