"""A case: a robot, what is hidden in it, and the runs that are made with it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Literal

from rr_opt.experiment.experiment import Experiment, Noise, Run, Start, Uncertainty, Use
from rr_opt.lab.capture import captured
from rr_opt.lab.effects import rig_with
from rr_opt.lab.engines import Engine, driven
from rr_opt.lab.outing import Motion, Outing
from rr_opt.lab.streams import stream
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import EffectUse, Robot

Verdict = Literal["consistent", "parameters", "missing_physics", "unexplained"]


@dataclass(frozen=True)
class Plan:
    """One run of a case: see `Outing`."""

    name: str
    gait: SineGait
    seconds: float = 30.0
    start: Start = "running"
    use: Use = "fit"
    pose: tuple[float, float, float] = (0.0, 0.0, 0.0)
    periods: int = 3

    @property
    def outing(self) -> Outing:
        """How the robot is let go, at 100 samples a second."""
        return Outing(self.seconds, self.start, self.pose, periods=self.periods)


@dataclass(frozen=True)
class Case:
    """What a diagnosis is tried on.

    nominal   the robot as the experimenter believes it to be; robot, as it is
    effects   what is hidden in it; verdict, what a right diagnosis says of it
    changed   names of the parameters in which robot and nominal differ, for `parameters`
    missing   fraction of the samples that the capture system loses
    engine    what drives it
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
    notes: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))


def motion_of(case: Case, plan: Plan, step: float | None = None, *, torque: bool = False) -> Motion:
    """What truly happens in a run; step: s, of the integration, the engine's own if left out."""
    outing = replace(plan.outing, torque=torque)
    return driven(case.engine, rig_with(case.robot, case.effects), plan.gait, outing, step)


def play(
    case: Case, progress: Callable[[str], None] = lambda _: None, step: float | None = None
) -> Experiment:
    """Make all recordings of a case; `progress` is told of each before it is made."""
    tracked = rig_with(case.robot, case.effects).tracked
    runs = []
    for n, plan in enumerate(case.plans):
        progress(f"recording {n + 1} of {len(case.plans)}")
        recording = captured(
            motion_of(case, plan, step),
            plan.name,
            case.noise,
            stream(case.seed, "noise", n),
            tracked=tracked,
            missing=case.missing,
        )
        runs.append(Run(recording, plan.gait, plan.use, plan.start))
    return Experiment(case.nominal, case.noise, case.uncertainty, tuple(runs), case.name)
