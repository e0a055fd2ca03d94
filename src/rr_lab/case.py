"""A case: a robot, its hidden physics, its runs, and the engine that drives it.

The engines share the hidden physics, the command as shaped by the servo's faults, and the capture
system, but no equation of motion and no contact model.
"""

import zlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any, Literal, get_args

import numpy as np

from rr_lab import mujoco
from rr_lab.disturbances import disturbance_named
from rr_lab.effects import rig_with
from rr_lab.rig import Rig
from rr_lab.run import Conditions, Motion, asked_angle, captured
from rr_opt.array import Array
from rr_opt.model.experiment import Experiment, Noise, Recording, Run, Start, Uncertainty, Use
from rr_opt.model.gait import Gait, SineGait
from rr_opt.model.robot import EffectUse, Robot

Engine = Literal["mujoco", "planar"]
"""A three-dimensional robot in MuJoCo, or two planar bodies with an integrator of our own."""

ENGINES: tuple[Engine, ...] = get_args(Engine)


def _module(engine: Engine) -> Any:
    if engine == "mujoco":
        return mujoco
    from rr_lab.planar import drive as planar

    return planar


def driven(
    engine: Engine, rig: Rig, gait: Gait, conditions: Conditions, step: float | None = None
) -> Motion:
    """Drive a gait with steps of `step` s, or of the engine's own.

    Raises InputError if MuJoCo is needed and not installed, NotConvergedError if the motion is
    lost.
    """
    module = _module(engine)
    return module.drive(rig, gait, conditions, module.STEP if step is None else step)


def fine_enough(engine: Engine, rig: Rig, step: float) -> float:
    """The step that an engine actually uses if `step` is requested, s."""
    return _module(engine).fine_enough(rig, step)


EXACT = Noise(0.0, 0.0, 0.0)
"""A capture system without noise."""


def record(
    robot: Robot,
    gait: Gait,
    seconds: float = 30.0,
    start: Literal["rest", "running"] = "rest",
    effects: Iterable[EffectUse] = (),
    noise: Noise = EXACT,
    seed: int = 0,
    *,
    name: str = "run01.csv",
    pose: tuple[float, float, float] = (0.0, 0.0, 0.0),
    rate: float = 100.0,
    periods: int = 3,
    missing: float = 0.0,
    torque: bool = False,
    step: float | None = None,
    engine: Engine = "mujoco",
) -> Recording:
    """Drive a gait on the virtual robot and record it `rate` times a second.

    start    `rest`: the command begins at t = 0; `running`: `periods` whole periods earlier
    pose     initial x (m), y (m) and heading (rad)
    missing  fraction of the samples that are lost
    step     integration step, s; default: the engine's own
    Raises InputError for an unknown effect, or if MuJoCo is needed and not installed.
    """
    rig = rig_with(robot, effects)
    conditions = Conditions(seconds, start, pose, rate, periods, torque=torque)
    motion = driven(engine, rig, gait, conditions, step)
    rng = np.random.default_rng(seed)
    return captured(motion, name, noise, rng, tracked=rig.tracked, missing=missing)


def stream(seed: int, *purpose: object) -> np.random.Generator:
    """The generator of a seed for a purpose; equal words give equal numbers."""
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
        """The initial conditions, at 100 samples a second."""
        return Conditions(self.seconds, self.start, self.pose, periods=self.periods)


@dataclass(frozen=True)
class Case:
    """A test case for a diagnosis.

    nominal   the robot as the experimenter believes it to be; robot, as it is
    effects   the hidden effects; verdict, that of a correct diagnosis
    changed   names of the parameters in which robot and nominal differ, for `parameters`
    missing   fraction of the samples that the capture system loses
    engine    the physics engine
    disturbance  of the recordings, by name
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
        """The robot as it is, with its hidden effects."""
        return rig_with(self.robot, self.effects)


def motion_of(case: Case, plan: Plan, step: float | None = None, *, torque: bool = False) -> Motion:
    """The true motion of a run; step: of the integration, s; default: the engine's own."""
    clock = disturbance_named(case.disturbance).clock
    conditions = plan.conditions
    conditions = replace(
        conditions, torque=torque, rate=clock * conditions.rate, seconds=conditions.seconds / clock
    )
    return driven(case.engine, case.rig, plan.gait, conditions, step)


def servo_angles(case: Case, plan: Plan, when: Array) -> tuple[Array, Array]:
    """The command and the angle of the servo's shaft, rad, at command times `when`, s, of a run."""
    rig, gait, conditions = case.rig, plan.gait, plan.conditions
    begin, first = conditions.begin(gait), float(when.min())
    if rig.motor is None:
        t = np.arange(min(begin, first) - mujoco.SETTLE, when.max() + 0.01, mujoco.STEP)
        made = asked_angle(rig, gait, begin, t)
    else:
        # The load deflects a soft loop. Without play, the joint turns as the shaft does.
        shaft = replace(rig, clock=first, play=0.0, gear=None)
        longer = replace(conditions, seconds=float(np.ptp(when)) + 1 / conditions.rate)
        seen = captured(driven(case.engine, shaft, gait, longer), "", EXACT, stream(0))
        t, made = first + seen.t, seen.values["phi"]
    return gait.angle(np.maximum(when, begin)), np.interp(when, t, made)


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
