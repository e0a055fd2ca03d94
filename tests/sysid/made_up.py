"""Experiments made up from the model itself, with noise: what is in them is known exactly."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from rr_opt.array import Array
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.machines.racer.simulation import slips
from rr_opt.model.experiment import CHANNELS, Experiment, Noise, Recording, Run, Start, Uncertainty
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Platform, Robot, Servo
from rr_opt.sysid.candidates import Candidate, first
from rr_opt.sysid.model import Request, Segment

ROBOT = Robot(
    Platform(0.5, 0.004, 0.15, 0.03, 0.05, 4e-6),
    Platform(0.3, 0.003, 0.08, 0.03, 0.05, 4e-6),
    0.016,
    Servo(2.0, 6.0, 3.0),
)
NOISE = Noise(0.001, 0.003)
KNOWN = {
    **{f"{part}{i}": 0.01 for part, i in itertools.product("mI", (1, 2))},
    **{f"{part}{i}": 0.005 for part, i in itertools.product("cab", (1, 2))},
}
GAITS: tuple[tuple[SineGait, Start], ...] = (
    (SineGait(0.5, 1.0), "rest"),
    (SineGait(0.8, 1.6, 0.2), "running"),
    (SineGait(0.4, 1.2, -0.25), "running"),
    (SineGait(0.7, 1.4), "rest"),
)


def experiment(
    gaits: Sequence[tuple[SineGait, Start]] = GAITS, seconds: float = 10.0, rate: float = 50.0
) -> Experiment:
    """Runs that have nothing recorded yet."""
    t = np.arange(round(seconds * rate) + 1) / rate
    platforms = {"1": ROBOT.platform1, "2": ROBOT.platform2}
    known = {
        name: Uncertainty(share * getattr(platforms[name[-1]], name[:-1]))
        for name, share in KNOWN.items()
    }
    known |= {f"kappa{i}": Uncertainty(factor=5.0) for i in (1, 2)}
    runs = tuple(
        Run(_recording(f"run{k}", t, np.zeros((t.size, 4))), gait, "fit", start)
        for k, (gait, start) in enumerate(gaits)
    )
    return Experiment(ROBOT, NOISE, known, runs, "made up")


def _recording(name: str, t: Array, values: Array) -> Recording:
    return Recording(
        name,
        t,
        dict(zip(CHANNELS, values.T, strict=True)),
        {channel: np.full(t.size, NOISE.of(channel)) for channel in CHANNELS},
        {channel: np.zeros(t.size, np.uint8) for channel in CHANNELS},
    )


def whole(model: RollerRacer, run: int) -> Segment:
    """All of a run."""
    n = model.runs[run].t.size
    return Segment(run, 0, n, n - 1)


def predicted(
    model: RollerRacer,
    run: int,
    values: Mapping[str, float],
    effects: tuple[str, ...],
    start: Array,
) -> Array:
    """What would be recorded (n, 4) of a whole run.

    start  x, y, psi, z and the side speeds, which count only where the wheels may slip
    """
    state = start[: 6 if slips(effects) else 4]
    return model.predicted(Request(whole(model, run), values, state), effects)


def recorded(given: Experiment, predict: Callable[[int, Array], Array], seed: int) -> RollerRacer:
    """The experiment with predict(run, start) (n, 4) and noise in its recordings."""
    rng = np.random.default_rng(seed)
    runs = []
    for k, run in enumerate(given.runs):
        start = np.array(
            [0.1 * k, -0.1 * k, 0.9 * k, 0.0 if run.start == "rest" else 0.03, 0.0, 0.0]
        )
        clean = predict(k, start)
        noisy = clean + rng.normal(size=clean.shape) * [NOISE.of(name) for name in CHANNELS]
        runs.append(replace(run, recording=_recording(run.name, run.recording.t, noisy)))
    return RollerRacer(replace(given, runs=tuple(runs)))


def with_effect(values: Mapping[str, float], effects: tuple[str, ...], **about) -> RollerRacer:
    """An experiment in which the robot has the effects."""
    seed = about.pop("seed", 1)
    given = experiment(**about)
    empty = RollerRacer(given)
    return recorded(given, lambda k, start: predicted(empty, k, values, effects, start), seed)


def base_of(model: RollerRacer) -> Candidate:
    """The parameters alone, fitted to all runs."""
    return first(model, range(len(model.runs)))
