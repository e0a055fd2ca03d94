"""A case: a robot, what is hidden in it, its runs, and how they are handed over."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Literal

import numpy as np

from rr_lab.disturbances import disturbance_named
from rr_lab.effects import rig_with
from rr_lab.engines import Engine, driven
from rr_lab.rig import Rig
from rr_lab.run import Conditions, Motion, captured
from rr_opt.model.experiment import Experiment, Noise, Recording, Run, Start, Uncertainty, Use
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse, Robot


def stream(seed: int, *purpose: object) -> np.random.Generator:
    """The generator of a seed for a purpose; the same words give the same numbers."""
    words = [zlib.crc32(str(word).encode()) for word in purpose]
    return np.random.default_rng([seed, *words])


Verdict = Literal["consistent", "parameters", "missing_physics", "unexplained"]


@dataclass(frozen=True)
class Plan:
    """One run of a case: see `Conditions`."""

    name: str
    gait: SineGait
    seconds: float = 30.0
    start: Start = "running"
    use: Use = "fit"
    pose: tuple[float, float, float] = (0.0, 0.0, 0.0)
    periods: int = 3

    @property
    def conditions(self) -> Conditions:
        """How the robot is let go, at 100 samples a second."""
        return Conditions(self.seconds, self.start, self.pose, periods=self.periods)


@dataclass(frozen=True)
class Case:
    """What a diagnosis is tried on.

    nominal   the robot as the experimenter believes it to be; robot, as it is
    effects   what is hidden in it; verdict, what a right diagnosis says of it
    changed   names of the parameters in which robot and nominal differ, for `parameters`
    missing   fraction of the samples that the capture system loses
    engine    what drives it
    disturbance  what goes wrong in the recordings, by name
    """

    name: str
    nominal: Robot
    robot: Robot
    effects: tuple[EffectUse, ...]
    plans: tuple[Plan, ...]
    noise: Noise
    uncertainty: Mapping[str, Uncertainty]
    verdict: Verdict
    seed: int
    changed: tuple[str, ...] = ()
    missing: float = 0.0
    engine: Engine = "mujoco"
    disturbance: str = ""
    notes: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))

    @property
    def rig(self) -> Rig:
        """The robot as it is, with what is hidden in it."""
        return rig_with(self.robot, self.effects)


def motion_of(case: Case, plan: Plan, step: float | None = None, *, torque: bool = False) -> Motion:
    """What truly happens in a run; step: s, of the integration, the engine's own if left out."""
    clock = disturbance_named(case.disturbance).clock
    conditions = plan.conditions
    conditions = replace(
        conditions, torque=torque, rate=clock * conditions.rate, seconds=conditions.seconds / clock
    )
    return driven(case.engine, case.rig, plan.gait, conditions, step)


def recorded(
    case: Case, number: int, step: float | None = None, *, torque: bool = False
) -> Recording:
    """The recording of a case's run 0, 1, ..."""
    plan = case.plans[number]
    return captured(
        motion_of(case, plan, step, torque=torque),
        plan.name,
        case.noise,
        stream(case.seed, "noise", number),
        tracked=case.rig.tracked,
        missing=case.missing,
        disturbance=disturbance_named(case.disturbance),
    )


def play(
    case: Case, progress: Callable[[str], None] = lambda _: None, step: float | None = None
) -> Experiment:
    """Make all recordings of a case; `progress` is called before each."""
    runs = []
    for n, plan in enumerate(case.plans):
        progress(f"recording {n + 1} of {len(case.plans)}")
        runs.append(Run(recorded(case, n, step), plan.gait, plan.use, plan.start))
    return Experiment(case.nominal, case.noise, case.uncertainty, tuple(runs), case.name)
