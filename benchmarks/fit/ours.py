"""This project: its engine, by multiple shooting and then by least squares over whole runs."""

from __future__ import annotations

import numpy as np

from benchmarks.fit.case import BOX, TRUE, Array, Case
from benchmarks.fit.equations import B1, B2, C1, C2, M1, M2, PARAMETERS, H
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.model.experiment import CHANNELS, Experiment, Noise, Recording, Run
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Platform, Robot
from rr_opt.sysid.estimation import fitted, initial, whole_runs
from rr_opt.sysid.model import Quantity


def fit(case: Case, start: Array) -> Array:
    """The six parameters, from a start."""
    model = RollerRacer(_experiment(case, start))
    begin = dict(zip(PARAMETERS, start.tolist(), strict=True))
    quantities = tuple(
        Quantity(name, "", value, value, False, true / BOX, BOX * true, value)
        for (name, value), true in zip(begin.items(), TRUE.tolist(), strict=True)
    )
    problem, states = initial(model, (), quantities, begin, range(len(case.gaits)))
    found = whole_runs(fitted(problem, begin, states)).values
    return np.array([found[name] for name in PARAMETERS])


def _experiment(case: Case, start: Array) -> Experiment:
    kappa1, kappa2, I1, I2, a1, a2 = start.tolist()
    robot = Robot(Platform(M1, I1, C1, a1, B1, kappa1), Platform(M2, I2, C2, a2, B2, kappa2), H)
    noise = Noise(case.sigma[0], case.sigma[2])
    runs = tuple(
        Run(_recording(case, k, noise), SineGait(*gait)) for k, gait in enumerate(case.gaits)
    )
    return Experiment(robot, noise, {}, runs, "fit")


def _recording(case: Case, run: int, noise: Noise) -> Recording:
    flags = {name: np.zeros(case.t.size, np.uint8) for name in CHANNELS}
    sigma = {name: np.full(case.t.size, noise.of(name)) for name in CHANNELS}
    return Recording(
        f"run{run}", case.t, dict(zip(CHANNELS, case.values[run].T, strict=True)), sigma, flags
    )
