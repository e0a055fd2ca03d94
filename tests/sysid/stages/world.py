"""Recordings made by simulation, and the fit that the stages start from."""

from __future__ import annotations

import numpy as np

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.model.experiment import CHANNELS, Experiment, Noise, Recording, Run, Uncertainty
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Platform, Robot
from rr_opt.sysid.candidate import nominal, whole
from rr_opt.sysid.least_squares import Fit

ROBOT = Robot(
    Platform(m=0.469, I=0.00386, c=0.206, a=0.02, b=0.05, kappa=2e-5),
    Platform(m=0.25, I=0.00175, c=0.0641, a=0.02, b=0.05, kappa=2e-5),
    h=0.02,
)
_NOISE = Noise(0.001, 0.003)
_KNOWN = {
    **{f"m{i}": Uncertainty(0.003) for i in (1, 2)},
    **{f"I{i}": Uncertainty(1.5e-4) for i in (1, 2)},
    **{f"{part}{i}": Uncertainty(0.002) for i in (1, 2) for part in "cab"},
    **{f"kappa{i}": Uncertainty(factor=5.0) for i in (1, 2)},
}
_GAITS = (
    SineGait(amplitude=0.6, period=1.0),
    SineGait(amplitude=0.8, period=1.6, offset=0.25),
    SineGait(amplitude=0.5, period=1.2, offset=-0.2),
)
_HEADINGS = (0.3, 1.9, -2.2)


def recorded(values: dict[str, float], seed: int, seconds: float = 8.0) -> RollerRacer:
    """Three runs of the robot with effects that have these values, `effect.parameter`."""
    rng = np.random.default_rng(seed)
    effects = tuple(dict.fromkeys(name.split(".")[0] for name in values if "." in name))
    t = np.arange(0.0, seconds, 0.01)
    blank = RollerRacer(_experiment([np.zeros((t.size, 4))] * len(_GAITS), t))
    sigma = np.array([_NOISE.of(name) for name in CHANNELS])
    seen = []
    for piece, heading in zip(whole(blank, range(len(_GAITS))), _HEADINGS, strict=True):
        start = np.array([0.1, -0.2, heading, 0.2])
        made = blank.respond(piece, values, effects, start).predicted
        seen.append(made + sigma * rng.normal(size=made.shape))
    return RollerRacer(_experiment(seen, t))


def _experiment(seen: list[np.ndarray], t: np.ndarray) -> Experiment:
    runs = []
    for k, (values, gait) in enumerate(zip(seen, _GAITS, strict=True)):
        recording = Recording(
            f"run{k}",
            t,
            dict(zip(CHANNELS, values.T, strict=True)),
            {name: np.full(t.size, _NOISE.of(name)) for name in CHANNELS},
            {name: np.zeros(t.size, np.uint8) for name in CHANNELS},
        )
        runs.append(Run(recording, gait))
    return Experiment(ROBOT, _NOISE, _KNOWN, tuple(runs))


def fitted(model: RollerRacer) -> Fit:
    """The starts that fit best, with the parameters as they are believed to be."""
    return nominal(model, whole(model, range(len(model.runs))))
