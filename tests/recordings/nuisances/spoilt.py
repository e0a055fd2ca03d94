"""A recording of a robot whose wheels roll, to be spoilt."""

from types import MappingProxyType

import numpy as np

from rr_opt.files.problem_file import read_problem
from rr_opt.model.experiment import CHANNELS, Noise, Recording
from rr_opt.model.gait import SineGait
from rr_opt.recordings.nuisances import nuisances
from rr_opt.recordings.nuisances.evidence import ExaminedRecording
from tests.recordings.clean.world import motion

ROBOT = read_problem(None).robot
NOISE = Noise(1e-3, 3e-3)
GAIT = SineGait(0.8, 1.0, 0.2)


def recording(name="run.csv", seed=0, turned=0.0, gait=GAIT, start="running", change=None):
    """The simulated motion, its frame turned, with noise; `change` spoils t and the channels."""
    rng = np.random.default_rng(seed)
    moved = motion(20.0, gait, start)
    place = (moved.x + 1j * moved.y) * np.exp(1j * turned)
    channels = dict(zip(CHANNELS, (place.real, place.imag, moved.psi + turned, moved.phi),
                        strict=True))  # fmt: skip
    n = len(moved.t)
    values = {one: y + NOISE.of(one) * rng.normal(size=n) for one, y in channels.items()}
    values["t"] = moved.t.copy()
    if change:
        change(values)
    t = values.pop("t")
    n = len(t)
    return Recording(
        name,
        t,
        MappingProxyType(values),
        {one: np.full(n, NOISE.of(one)) for one in CHANNELS},
        {one: np.where(np.isnan(values[one]), 1, 0).astype(np.uint8) for one in CHANNELS},
    )


def told(spoilt, robot=ROBOT, gait=GAIT, start="running"):
    """Codes of what is found, and all sentences."""
    found = nuisances(ExaminedRecording(spoilt, robot, gait, start))
    return {one.code for one in found}, " ".join(found)
