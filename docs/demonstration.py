"""Five minutes with the whole tool: `python docs/demonstration.py [--seed N]`.

A robot with something hidden in it is recorded, and the answer sealed. The diagnosis sees the
recordings alone. Then the seal is opened, the fastest gait is looked for with the nominal
and with the corrected model, both are driven by the robot that has the hidden effect, and what was
predicted is held against what was recorded. Every step is a command that is shown, and can be given
by hand. Files go to out/demonstration.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import json
import math
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

from rr_lab.effects import effect_named

PROGRAM = Path(sys.executable).with_name("rr-opt")
SECONDS, DRIVE = 15, 40
"""s, of each recording, and of each drive that is predicted."""

NOISE = ("--noise", "1 mm, 3 mrad")
GAITS = (
    "0.5, 1 s, 0, rest",
    "0.6, 1.2 s, 0.17",
    "0.5, 1.1 s, -0.14, rest",
    "0.7, 1.4 s, 0.1",
    "0.8, 1.6 s, 0",
    "0.45, 0.9 s, 0.09, holdout",
    "0.65, 1.3 s, -0.1, holdout",
)
ROBOT = """\
platform1: {m: 0.469, I: 0.00386, c: 206 mm, a: 20 mm, b: 50 mm, kappa: 2.0e-5}
platform2: {m: 0.250, I: 0.00175, c: 64.1 mm, a: 20 mm, b: 50 mm, kappa: 2.0e-5}
h: 20 mm
"""
# The gaits to choose from reach far beyond those that were recorded.
PROBLEM = """\
robot: {robot}
gait: {{amplitude: [0.3, 2], period: [0.5 s, 4 s], offset: 0}}
"""
ROBOTS = {"nominal": "robot.yaml", "corrected": "diagnosis/robot-corrected.yaml"}


def main() -> None:
    parser = argparse.ArgumentParser(description="Five minutes with the whole tool.")
    parser.add_argument("--seed", default="5", help="of what is hidden")
    parser.add_argument("--out", type=Path, default=Path("out/demonstration"))
    asked = parser.parse_args()
    record_and_seal(asked.out, asked.seed)
    say("2. The diagnosis sees the recordings alone.")
    print(run("diagnose", f"{asked.out}/recorded", "--out", f"{asked.out}/diagnosis"))
    effects = open_seal(asked.out)
    say("4. The fastest gait, by the nominal and by the corrected model.")
    gaits = {name: fastest(asked.out, name) for name in ROBOTS}
    hold_together(asked.out, gaits, effects)
    print(f"\nThe diagnosis's page: {asked.out}/diagnosis/report.html")


def record_and_seal(out: Path, seed: str) -> None:
    """Record a robot with something hidden in it."""
    say("1. A robot is recorded. What it hides is sealed.")
    out.mkdir(parents=True, exist_ok=True)
    (out / "robot.yaml").write_text(ROBOT)
    runs = [word for gait in GAITS for word in ("--gait", gait)]
    sealed = ("--hide", "single", "--seal", f"{out}/sealed.json", "--seed", seed)
    words = ("--seconds", str(SECONDS), "--out", f"{out}/recorded")
    print(run("record", f"{out}/robot.yaml", *runs, *sealed, *NOISE, *words))


def open_seal(out: Path) -> list[str]:
    """What was hidden, as `record` takes it: --effect and its values for each."""
    say("3. The seal is opened.")
    text = (out / "sealed.json").read_text()
    digest = (out / "recorded" / "answer.sha256").read_text().split()[0]
    print(f"SHA-256 as sealed: {hashlib.sha256(text.encode()).hexdigest() == digest}")
    effects = [effect_text(one) for one in json.loads(text)["effects"]]
    print("\n".join(effects))
    return [word for effect in effects for word in ("--effect", effect)]


def hold_together(out: Path, gaits: dict[str, dict[str, Any]], effects: list[str]) -> None:
    """Record each gait with the hidden effects, and print it beside what each model predicts."""
    say("5. The robot that hides it drives both, from rest, and each model predicts both.")
    lines = [f"{'gait chosen by':<24}{'recorded':>14}{'nominal':>20}{'corrected':>20}"]
    for chosen, gait in gaits.items():
        command, folder = f"{gait['amplitude']:.6g}, {gait['period']:.6g} s", f"{out}/best-{chosen}"
        words = ("--seconds", str(DRIVE), "--out", folder)
        run("record", f"{out}/robot.yaml", "--gait", f"{command}, rest", *effects, *NOISE, *words)
        seen = mean_speed(Path(folder) / "run01.csv", gait["period"])
        said = [predicted(out, gait, name) for name in ROBOTS]
        cells = "".join(f"{1e3 * one:>10.1f} ({100 * (one / seen - 1):+.1f} %)" for one in said)
        lines.append(f"{f'the {chosen} model':<24}{1e3 * seen:>9.1f} mm/s{cells}")
    print("\n" + "\n".join(lines))


def fastest(out: Path, name: str) -> dict[str, Any]:
    """The gait that `maximize-speed` finds for one of the robot files."""
    (out / f"problem-{name}.yaml").write_text(PROBLEM.format(robot=ROBOTS[name]))
    words = ("--no-figures", "--json", "--out", f"{out}/fastest-{name}")
    gait = json.loads(run("maximize-speed", f"{out}/problem-{name}.yaml", *words))["gait"]
    print(f"  {name}: amplitude {gait['amplitude']:.4g} rad, period {gait['period']:.4g} s")
    return gait


def predicted(out: Path, gait: dict[str, Any], name: str) -> float:
    """The mean speed that a robot file gives for a gait, m/s."""
    folder = f"{out}/predicted-{name}"
    size = ("--amplitude", f"{gait['amplitude']:.6g}", "--period", f"{gait['period']:.6g}")
    run("simulate", str(out / ROBOTS[name]), *size, "--seconds", str(DRIVE), "--out", folder)
    return mean_speed(Path(folder) / "trajectory.csv", gait["period"])


def mean_speed(path: Path, period: float) -> float:
    """Way over time of the last five whole periods, m/s, positive along platform 1's heading."""
    with path.open(encoding="utf-8") as file:
        # Without the units: `x [m]`.
        names = [name.split(" [")[0] for name in next(csv.reader(file))]
        rows = [row for row in csv.DictReader(file, names) if row["x"]]
    last = rows[-1]
    begin = float(last["t"]) - 5 * period
    first = min(rows, key=lambda row: abs(float(row["t"]) - begin))
    dx, dy = (float(last[axis]) - float(first[axis]) for axis in ("x", "y"))
    heading = sum(float(row["psi"]) for row in rows if float(row["t"]) >= begin)
    heading /= sum(float(row["t"]) >= begin for row in rows)
    along = dx * math.cos(heading) + dy * math.sin(heading)
    return math.copysign(math.hypot(dx, dy), along) / (float(last["t"]) - float(first["t"]))


def effect_text(one: dict[str, Any]) -> str:
    """An effect of an answer as `record --effect` takes it."""
    name = "/".join(filter(None, (one["name"], one.get("realisation"))))
    accepted = effect_named(name).accepted
    values = one["parameters"] | one.get("plant", {})
    given = (f"{key}={each['value']}" for key, each in values.items() if key in accepted)
    return f"{name}:{','.join(given)}"


def say(text: str) -> None:
    print(f"\n{text}\n", flush=True)


def run(*words: str) -> str:
    """Show a command, run it, and return what it prints; stops where it fails."""
    print(f"$ rr-opt {shlex.join(words)}", flush=True)
    return subprocess.run([PROGRAM, *words], stdout=subprocess.PIPE, text=True, check=True).stdout


if __name__ == "__main__":
    main()
