"""Recordings that others made of real machines, diagnosed; pages in results/real.

`python -m benchmarks.real DATA`: a folder with experiment.yaml, or with the public sets pendulum,
servo and car, of which some recordings are held out: each swing-up, each gain and each trajectory
of the servo, a day of the car. The recordings stay where they are.
"""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import rr_opt as rr
from rr_opt.results.machine_diagnosis import ExplainedMachine

OUT = Path("results/real")
HEADS = {
    "pendulum": "machine: pendulum\nparameters: {J: 0.06, ml: 0.1, b: 0.05}\n"
    "columns: {t: time, q: position, u: torque}\n",
    "servo": "machine: servo\n"
    "parameters: {kt: 0.387, R: 4.02, armature: 0.0018, b: 0.0037, fc: 0.0128}\n"
    "columns: {t: timestamp, q: position, goal: goal_position, volts: input_volts,"
    ' "on": torque_enable, m: mass, l: length}\n',
    "car": "machine: car\nparameters: {L: 0.1735, mf: 0.847, mr: 0.733, gain: 0.35, zero: 0,"
    " ahead: 0.115, left: -0.01}\n"
    "columns: {t: vicon time, x: vicon x, y: vicon y, psi: vicon yaw, vx: vel encoder}\n",
}


def splits(folder: Path) -> Iterator[tuple[str, list[Path], list[Path]]]:
    """Name, recordings to fit and recordings to hold out."""
    if folder.name == "pendulum":
        one, other = folder / "ddp.csv", folder / "direct_collocation.csv"
        yield "pendulum-ddp", [one], [other]
        yield "pendulum-direct-collocation", [other], [one]
    elif folder.name == "servo":
        files = {p: json.loads(p.read_text()) for p in sorted(folder.glob("2*.json"))}
        for key in ("kp", "trajectory"):
            for value in dict.fromkeys(head[key] for head in files.values()):
                held = [p for p, head in files.items() if head[key] == value]
                yield f"servo-without-{value}".replace("_", "-"), [*files.keys() - held], held
    elif folder.name == "car":
        files = sorted(folder.glob("*.csv"))
        days = dict.fromkeys(p.name.split("Datarecording_")[1][:10] for p in files)
        for day in days:
            held = [p for p in files if day in p.name]
            yield f"car-without-{day}".replace("_", "-"), [p for p in files if p not in held], held


def diagnosed(experiment: Path, name: str) -> None:
    """One page, with its numbers."""
    began = time.process_time()
    found = rr.diagnose(experiment)
    assert isinstance(found, ExplainedMachine)
    with tempfile.TemporaryDirectory() as folder:
        found.save(folder)
        (OUT / name).mkdir(parents=True, exist_ok=True)
        for file in ("diagnosis.json", "report.html", "errors.svg"):
            shutil.copyfile(Path(folder) / file, OUT / name / file)
    print(f"{name}: {found.headline}, {time.process_time() - began:.0f} s CPU", flush=True)


def main(data: Path, only: Sequence[str]) -> None:
    """All that there is."""
    if (data / "experiment.yaml").is_file():
        diagnosed(data, data.resolve().name)
        return
    for kind in (one for one in HEADS if (data / one).is_dir()):
        for name, fit, held in splits((data / kind).resolve()):
            if only and not any(name.startswith(one) for one in only):
                continue
            with tempfile.TemporaryDirectory() as folder:
                experiment = Path(folder) / name
                experiment.mkdir()
                entries = [f"  - {{file: {json.dumps(str(p))}}}\n" for p in sorted(fit)]
                entries += [f"  - {{file: {json.dumps(str(p))}, use: holdout}}\n" for p in held]
                text = f"{HEADS[kind]}recordings:\n{''.join(entries)}"
                (experiment / "experiment.yaml").write_text(text)
                diagnosed(experiment, name)


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
