"""How often a nuisance is named, and how often one is seen where there is none.

    python -m benchmarks.robustness.nuisances [--cases 60] [--seed 1]

Recordings of random robots of the laboratory, with hidden physics in a quarter of them, are looked
at as they are and with one nuisance each. Writes results/robustness/nuisances.json.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import numpy as np

from rr_lab.case import Case, Plan, motion_of, recorded, stream
from rr_lab.random_case import random_case
from rr_opt.documents.archive import write_json
from rr_opt.model.experiment import Recording, Start
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Robot
from rr_opt.recordings.inspection import Circumstances, inspect
from rr_opt.recordings.nuisances.evidence import ExaminedRecording
from rr_opt.recordings.nuisances.start import initial
from rr_opt.recordings.warnings import Notice

OUT = Path(__file__).parents[2] / "results" / "robustness" / "nuisances.json"
KINDS = ("null", "parameters", "null", "single", "null", "parameters", "null", "outside")
ENGINES = ("planar", "planar", "mujoco")
TRUE = {
    *("clock.offset", "clock.drift", "command.scale", "command.bias"),
    *("motion.robot", "late.place"),
}
"""What is true of recordings of a servo that lags, a robot that hardly moves, wheels that creep."""

Values = dict[str, np.ndarray]


def _moved(**steps: float) -> Callable[[Values, float], None]:
    def change(v: Values, _: float) -> None:
        for name, step in steps.items():
            v[name] = v[name] + step

    return change


def _mirrored(v: Values, _: float) -> None:
    v["y"] = -v["y"]


def _exchanged(v: Values, _: float) -> None:
    v["psi"], v["phi"] = v["psi"] + v["phi"] + np.pi, -v["phi"]


def _slow(v: Values, _: float) -> None:
    middle = v["t"][len(v["t"]) // 2]
    v["t"] = np.where(v["t"] < middle, v["t"], middle + 2 * (v["t"] - middle))


def _pushed(v: Values, direction: float) -> None:
    part = np.clip((v["t"] - 0.4 * v["t"][-1]) / 0.2, 0, 1)
    v["x"] = v["x"] + 0.1 * np.cos(direction) * part
    v["y"] = v["y"] + 0.1 * np.sin(direction) * part


def _late(v: Values, _: float) -> None:
    v["phi"] = np.interp(v["t"] - 0.05, v["t"], v["phi"])


NUISANCES: dict[str, tuple[Callable[[Values, float], None], tuple[str, ...], str]] = {
    "y mirrored": (_mirrored, ("frame.wrong",), "y is mirrored"),
    "phi off by 180 deg": (_moved(phi=np.pi), ("frame.wrong",), "phi is off by 180 deg"),
    "psi off by 180 deg": (_moved(psi=np.pi), ("frame.wrong",), "psi is off by 180 deg"),
    "platforms exchanged": (_exchanged, ("frame.wrong",), "platforms 1 and 2 are swapped"),
    "clock half as fast from the middle": (_slow, ("clock.change",), ""),
    "push by 10 cm": (_pushed, ("push.robot", "push.surge"), ""),
    "`start: rest` of a robot that drives": (_moved(), ("start.running",), ""),
    "phi 50 ms late": (_late, ("late.phi",), ""),
}
"""What is done, and the codes and words by which it is named."""


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--cases", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    clean = 0
    false: Counter[str] = Counter()
    tried: Counter[str] = Counter()
    named: Counter[str] = Counter()
    beyond: Counter[str] = Counter()
    where: list[str] = []
    for n in range(given.cases):
        kind, seed = KINDS[n % len(KINDS)], 1000 * given.seed + n
        case = random_case(seed, kind, engine=ENGINES[n % len(ENGINES)], spread=1.0)
        for k, plan in enumerate(case.plans):
            recording = recorded(case, k)
            clean += 1
            name = f"case {seed} ({kind} {[use.name for use in case.effects]}), run {k + 1}"
            for one in codes(recording, case.nominal, plan.gait, plan.start):
                if one.code not in TRUE and one.level != "note":
                    false[one.code] += 1
                    where.append(f"{name}: {one.code}")
                    print("false", where[-1], one, flush=True)
            rng = stream(seed, "nuisance", k)
            for what in rng.choice(list(NUISANCES), 2, replace=False):
                start = plan.start
                if "rest" in what:
                    if start == "rest":
                        continue
                    start = "rest"
                tried[what] += 1
                shows = "rest" in what and drives(recording, case, plan)
                beyond["tried"] += shows
                spoilt = changed(recording, NUISANCES[what][0], rng.uniform(0, 2 * np.pi))
                found = codes(spoilt, case.nominal, plan.gait, start)
                _, wanted, words = NUISANCES[what]
                if any(one.code in wanted and words in one for one in found):
                    named[what] += 1
                    beyond["named"] += shows
                else:
                    where.append(f"{name}: {what} not named: {[one.code for one in found]}")
                    print("missed", where[-1], flush=True)
        print(n + 1, clean, dict(false), flush=True)
        record = {"seed": given.seed, "cases": n + 1, "recordings": clean}
        counts = {what: f"{named[what]} of {tried[what]}" for what in NUISANCES}
        counts["`start: rest`, driving faster than rest allows"] = (
            f"{beyond['named']} of {beyond['tried']}"
        )
        write_json(OUT, {**record, "false_alarms": false, "named": counts, "wrong": where})


def drives(recording: Recording, case: Case, plan: Plan) -> bool:
    """Whether the true speed at t = 0 is beyond what rest allows, by the doubts of its estimate; or
    there is none."""
    motion = motion_of(case, plan)
    x, y, psi = motion.one.T
    vx, vy = (np.gradient(one, motion.t, edge_order=2)[0] for one in (x, y))
    speed = float(np.cos(psi[0]) * vx + np.sin(psi[0]) * vy)
    found = initial(
        ExaminedRecording(recording, case.nominal, plan.gait, "rest"), case.nominal, plan.gait
    )
    return found is None or found.drives(speed)


def changed(
    recording: Recording, change: Callable[[Values, float], None], angle: float
) -> Recording:
    """The recording with a nuisance."""
    values = {name: y.copy() for name, y in recording.values.items()} | {"t": recording.t.copy()}
    change(values, angle)
    t = values.pop("t")
    return replace(recording, t=t, values=MappingProxyType(values))


def codes(recording: Recording, robot: Robot, gait: SineGait, start: Start) -> list[Notice]:
    """What is found in a recording."""
    found = inspect(recording, None, Circumstances(robot=robot, gait=gait, start=start))
    return [one for one in found.doubts if isinstance(one, Notice)]


if __name__ == "__main__":
    main()
