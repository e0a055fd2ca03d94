"""The recordings that are diagnosed: eight of 30 s at 100 Hz, simulated by the model itself."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import yaml

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.model.experiment import CHANNELS, Experiment, Noise, Recording, Run
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Platform, Robot, Servo
from rr_opt.sysid.model import Request, segments

PLATFORMS = ((0.5, 0.004, 0.15, 0.03, 0.05, 1.2e-5), (0.3, 0.003, 0.08, 0.03, 0.05, 1.2e-5))
ROBOT = Robot(Platform(*PLATFORMS[0]), Platform(*PLATFORMS[1]), 0.02, Servo(2.6, 6.28, 1.5))
GAITS = [
    SineGait(0.5, 1.0),
    SineGait(0.8, 1.6, 0.2),
    SineGait(0.4, 1.2, -0.25),
    SineGait(0.7, 1.4, 0.1),
    SineGait(0.6, 0.9, -0.1),
    SineGait(0.9, 1.8),
    SineGait(0.45, 1.1, 0.3),
    SineGait(0.65, 1.3, -0.2),
]
NOISE = Noise(0.001, 0.003)
CURVE = {f"force{k}": force for k, force in enumerate((0.03, 0.0, 0.03, 0.0, 0.03))}
HIDDEN: dict[str, tuple[str, dict[str, float]]] = {
    "nothing": ("", {}),
    "dry friction": ("coulomb_friction", {"force1": 0.002, "force2": 0.001}),
    "slipping wheels": ("lateral_slip", {"mu": 0.03}),
    "no name": ("rolling_force_curve", CURVE | {"speed": 0.12}),
}


def record(folder: Path, effect: str, values: dict[str, float]) -> None:
    """An experiment folder of a robot with the effect."""
    t = np.arange(3001) / 100.0
    empty = np.zeros((t.size, 4))
    runs = tuple(
        Run(_recording(f"run{k}", t, empty), gait, "fit", "running") for k, gait in enumerate(GAITS)
    )
    model = RollerRacer(Experiment(ROBOT, NOISE, {}, runs, "bench"))
    effects = (effect,) if effect else ()
    rng = np.random.default_rng(0)
    folder.mkdir(parents=True)
    recordings = []
    for k, gait in enumerate(GAITS):
        given = {f"{effect}.{key}": value for key, value in values.items()}
        start = np.zeros(model.state_scale(effects).size)
        start[2:4] = 0.7 * k, 0.05
        (whole,) = segments({k: model.runs[k]})
        clean = model.predicted(Request(whole, given, start), effects)
        noisy = clean + rng.normal(size=clean.shape) * [NOISE.of(name) for name in CHANNELS]
        table = np.column_stack([t, noisy])
        header = ",".join(("t", *CHANNELS))
        np.savetxt(
            folder / f"run{k}.csv", table, fmt="%.6f", delimiter=",", header=header, comments=""
        )
        recordings.append(
            {
                "file": f"run{k}.csv",
                "use": "holdout" if k > 5 else "fit",
                "start": "running",
                "gait": {"amplitude": gait.amplitude, "period": gait.period, "offset": gait.offset},
            }
        )
    names = ("m", "I", "c", "a", "b", "kappa")
    robot = {f"platform{i + 1}": dict(zip(names, PLATFORMS[i], strict=True)) for i in (0, 1)}
    servo = {"angle_limit": 2.6, "rate_limit": 6.28, "torque_limit": 1.5}
    experiment = {
        "robot": {**robot, "h": ROBOT.h, "servo": servo},
        "noise": {"position": NOISE.position, "angle": NOISE.angle},
        "recordings": recordings,
    }
    (folder / "experiment.yaml").write_text(yaml.safe_dump(experiment), encoding="utf-8")


def _recording(name: str, t: np.ndarray, values: np.ndarray) -> Recording:
    flags = {channel: np.zeros(t.size, np.uint8) for channel in CHANNELS}
    sigma = {channel: np.full(t.size, NOISE.of(channel)) for channel in CHANNELS}
    return Recording(name, t, dict(zip(CHANNELS, values.T, strict=True)), sigma, flags)
