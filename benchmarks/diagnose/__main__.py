"""`rr-opt diagnose` on eight recordings of 30 s at 100 Hz: the whole command, and where it goes.

`python -m benchmarks.diagnose` writes results/bench/diagnose.md. The recordings are simulated by
the model itself, which is enough for times: nothing missing, dry friction, slipping wheels, and a
rolling force that no effect of the catalogue makes. Each is timed with code that was compiled
before, with a compiler but an empty cache, and without a compiler; median of three.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import yaml

from benchmarks.results import machine, spread, write, yardstick
from rr_opt.diagnose.model import Piece
from rr_opt.diagnose.racer import RollerRacer
from rr_opt.experiment.experiment import Experiment, Noise, Run
from rr_opt.experiment.recording import CHANNELS, Recording
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import Platform, Robot, Servo

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
WAYS = ("compiled before", "compiled now", "no compiler")
TIMES = 3


def main() -> None:
    lines = [
        "# `rr-opt diagnose`, eight recordings of 30 s at 100 Hz",
        "",
        f"Written by `python -m benchmarks.diagnose`. {machine()}. Wall-clock seconds of the "
        f"whole command, page included, median of {TIMES} (least to most).",
        "",
        f"| hidden | {' | '.join(WAYS)} | verdict | where the time goes |",
        "|---|---|---|---|---|---|",
    ]
    ratios = {}
    with tempfile.TemporaryDirectory() as place:
        for name, (effect, values) in HIDDEN.items():
            folder = Path(place) / name.replace(" ", "-")
            record(folder, effect, values)
            yard, cells, middle, found = yardstick(), [], {}, {}
            for way in WAYS:
                walls = []
                for k in range(TIMES):
                    wall, found = timed(folder, Path(place), way, k)
                    walls.append(wall)
                cells.append(spread(walls, 1))
                middle[way] = statistics.median(walls)
            steps = sorted(found["seconds"].items(), key=lambda pair: -pair[1])[:3]
            told = ", ".join(f"{step} {seconds:.1f}" for step, seconds in steps)
            lines.append(f"| {name} | {' | '.join(cells)} | {found['verdict']} | {told} |")
            ratios[f"{name}, yardstick/compiled before"] = yard / middle["compiled before"]
            ratios[f"{name}, no compiler/compiled before"] = (
                middle["no compiler"] / middle["compiled before"]
            )
            print(lines[-1], flush=True)
    lines += ["", "The last column is of the runs without a compiler."]
    write("diagnose", lines, ratios)


def record(folder: Path, effect: str, values: dict[str, float]) -> None:
    """An experiment folder of a robot with the effect, from the model itself."""
    t = np.arange(3001) / 100.0
    empty = np.zeros((t.size, 4))
    runs = tuple(Run(_recording(f"run{k}", t, empty), gait, "fit", "running")
                 for k, gait in enumerate(GAITS))  # fmt: skip
    model = RollerRacer(Experiment(ROBOT, NOISE, {}, runs, "bench"))
    rng = np.random.default_rng(0)
    folder.mkdir(parents=True)
    told = []
    for k, gait in enumerate(GAITS):
        given = {f"{effect}.{key}": value for key, value in values.items()}
        start = np.array([0.0, 0.0, 0.7 * k, 0.05, 0.0, 0.0])
        effects = (effect,) if effect else ()
        clean = model.respond(Piece(k, 0, t.size), given, effects, start).predicted
        noisy = clean + rng.normal(size=clean.shape) * [NOISE.of(name) for name in CHANNELS]
        table = np.column_stack([t, noisy])
        header = ",".join(("t", *CHANNELS))
        np.savetxt(
            folder / f"run{k}.csv", table, fmt="%.6f", delimiter=",", header=header, comments=""
        )
        told.append({
            "file": f"run{k}.csv", "use": "holdout" if k > 5 else "fit", "start": "running",
            "gait": {"amplitude": gait.amplitude, "period": gait.period, "offset": gait.offset},
        })  # fmt: skip
    names = ("m", "I", "c", "a", "b", "kappa")
    robot = {f"platform{i + 1}": dict(zip(names, PLATFORMS[i], strict=True)) for i in (0, 1)}
    servo = {"angle_limit": 2.6, "rate_limit": 6.28, "torque_limit": 1.5}
    whole = {
        "robot": {**robot, "h": ROBOT.h, "servo": servo},
        "noise": {"position": NOISE.position, "angle": NOISE.angle},
        "recordings": told,
    }
    (folder / "experiment.yaml").write_text(yaml.safe_dump(whole), encoding="utf-8")


def _recording(name: str, t: np.ndarray, values: np.ndarray) -> Recording:
    flags = {channel: np.zeros(t.size, np.uint8) for channel in CHANNELS}
    sigma = {channel: np.full(t.size, NOISE.of(channel)) for channel in CHANNELS}
    return Recording(name, t, dict(zip(CHANNELS, values.T, strict=True)), sigma, flags)


def timed(folder: Path, place: Path, way: str, k: int) -> tuple[float, dict]:
    """Wall-clock seconds of the command, and what it found."""
    cache = place / ("cache" if way == "compiled before" else f"cache-{folder.name}-{way}-{k}")
    compiler = "no-such-compiler" if way == "no compiler" else "cc"
    environment = {**os.environ, "XDG_CACHE_HOME": str(cache), "CC": compiler}
    out = place / "out"
    command = [str(Path(sys.executable).with_name("rr-opt")), "diagnose", str(folder)]
    if way == "compiled before" and k == 0:
        subprocess.run(
            [*command, "--out", str(out)], check=True, env=environment, capture_output=True
        )
    began = time.perf_counter()
    subprocess.run([*command, "--out", str(out)], check=True, env=environment, capture_output=True)
    wall = time.perf_counter() - began
    return wall, json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
