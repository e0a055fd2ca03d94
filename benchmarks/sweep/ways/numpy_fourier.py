"""NumPy: the Fourier steady state by hand (benchmarks/optimise/fourier_numpy), viscous only."""

from __future__ import annotations

import numpy as np

from benchmarks.optimise.fourier_numpy import evaluate
from benchmarks.sweep.case import ROBOT, Array, Work
from rr_opt.model.problem import Interval, RatioChoice

NAME = "NumPy Fourier series, by hand"
ROWS = 2048


def run(work: Work, steps: int) -> Array:
    """|speed| (K,) with the given number of nodes per period."""
    choice = RatioChoice(Interval(0.0, 1.0))
    parts = []
    for k in range(0, work.size, ROWS):
        own = slice(k, k + ROWS)
        gaits = (work.amplitude[own], work.period[own], work.offset[own], work.ratio[own])
        parts.append(evaluate(ROBOT, choice, gaits, nodes=steps, torque=False).speed)
    return np.abs(np.concatenate(parts))
