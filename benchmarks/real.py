"""Recordings that others made of real machines, diagnosed; pages and a table in results/real.

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
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import rr_opt as rr
from rr_opt.documents.archive import write_text
from rr_opt.formatting import with_unit
from rr_opt.machines.ode import OdeModel
from rr_opt.results.machine_diagnosis import ExplainedMachine
from rr_opt.sysid.candidates import first
from rr_opt.sysid.diagnosis import Finding
from rr_opt.sysid.evaluation import evaluation

OUT = Path("results/real")
PUBLISHED = {
    "pendulum": {
        "J": 0.06259, "ml": 0.1022, "b": 0.04707,
        "coulomb_friction.torque": 0.1839, "torque_offset.torque": 0.07586,
    },
    "servo": {
        "kt": 0.3804, "R": 3.380, "armature": 0.001918, "b": 0.004379, "fc": 0.008882,
        "load_friction.share": 0.1217, "angle_offset.angle": 0.02944,
    },
}  # fmt: skip
"""What was published with the recordings: the pendulum's system_identification.txt, the servo's
published_m3.json."""
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
        yield "pendulum-all", [one, other], []
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


def diagnosed(experiment: Path, name: str) -> tuple[str, ...]:
    """One page, with its numbers; the table's row."""
    began = time.process_time()
    found = rr.diagnose(experiment)
    assert isinstance(found, ExplainedMachine)
    spent = time.process_time() - began
    with tempfile.TemporaryDirectory() as folder:
        found.save(folder)
        (OUT / name).mkdir(parents=True, exist_ok=True)
        for file in ("diagnosis.json", "report.html", "errors.svg"):
            if (Path(folder) / file).is_file():
                shutil.copyfile(Path(folder) / file, OUT / name / file)
    print(f"{name}: {found.headline}, {spent:.0f} s CPU", flush=True)
    published = PUBLISHED.get(found.experiment.machine.name, {})
    held = any(run.held_out for run in found.experiment.runs)
    errors = found.errors(held_out=held)
    theirs = of_published(found, published, held_out=held)
    units = {one.name: one.unit for one in found.experiment.machine.outputs}
    columns = [
        "; ".join(f"{k} {with_unit(e[level], units[k], 3)}" for k, e in errors.items())
        for level in ("before", "parameters", "after")
    ]
    columns.append("; ".join(f"{k} {with_unit(e, units[k], 3)}" for k, e in theirs.items()))
    named = "; ".join(_named(one, published) for one in found.effects)
    return (f"[{name}]({name}/report.html)", found.verdict, named, *columns,
            f"{found.window:.2g} s", f"{spent:.0f}")  # fmt: skip


def of_published(
    found: ExplainedMachine, published: Mapping[str, float], *, held_out: bool
) -> dict[str, float]:
    """RMS error of each output, SI, over the same windows, with what was published."""
    if not published:
        return {}
    theirs = OdeModel(replace(found.experiment, nominal=published))
    runs = [k for k, run in enumerate(theirs.runs) if not run.held_out]
    fit = first(theirs, runs).fit
    theirs.horizon = found.window
    made = replace(found.found, nominal=evaluation(fit, published).misfits)
    errors = replace(found, found=made).errors(held_out=held_out)
    return {name: levels["before"] for name, levels in errors.items()}


def _named(effect: Finding, published: Mapping[str, float]) -> str:
    values = []
    for name, one in effect.parameters.items():
        known = published.get(f"{effect.name}.{name}")
        there = f" (published {known:g})" if known is not None else ""
        interval = f"[{one.low:.3g}, {one.high:.3g}]"
        values.append(f"{name} {one.value:.3g} {interval} {one.unit}{there}")
    return f"{effect.name} ({effect.confidence:.2f}): {', '.join(values)}"


def table(rows: Sequence[Sequence[str]]) -> str:
    """The page."""
    head = ("recordings", "verdict", "named (confidence): value [95 %]", "error, nominal",
            "parameters fitted", "corrected", "published model", "window", "CPU, s")  # fmt: skip
    lines = ["| " + " | ".join(row) + " |" for row in (head, ("---",) * len(head), *rows)]
    return (
        "# Real recordings\n\nErrors are RMS of recordings that were not fitted (of `all`, of "
        "those that were), over windows whose initial states alone are fitted.\n\n"
        + "\n".join(lines)
        + "\n"
    )


def main(data: Path, only: Sequence[str]) -> None:
    """All that there is."""
    if (data / "experiment.yaml").is_file():
        write_text(OUT / "README.md", table([diagnosed(data, data.resolve().name)]))
        return
    rows = []
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
                rows.append(diagnosed(experiment, name))
    write_text(OUT / "README.md", table(rows))


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
