"""The engines that drive a rig, by name, and a recording made by one of them.

They share what is hidden, the command as the servo's faults shape it, and the capture system; no
equation of motion and no contact.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Literal, get_args

import numpy as np

from rr_lab.effects import rig_with
from rr_lab.mujoco import drive as mujoco
from rr_lab.rig import Rig
from rr_lab.run import Conditions, Motion, captured
from rr_opt.model.experiment import Noise, Recording
from rr_opt.model.gait import Gait
from rr_opt.model.robot import EffectUse, Robot

Engine = Literal["mujoco", "planar"]
"""A robot in three dimensions in MuJoCo, or two bodies in the plane, stepped here."""

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
    pose     x (m), y (m) and heading (rad) where the robot is put down
    missing  fraction of the samples that are lost
    step     of the integration, s; the engine's own if left out
    Raises InputError for an unknown effect, or if MuJoCo is needed and not installed.
    """
    rig = rig_with(robot, effects)
    conditions = Conditions(seconds, start, pose, rate, periods, torque=torque)
    motion = driven(engine, rig, gait, conditions, step)
    rng = np.random.default_rng(seed)
    return captured(motion, name, noise, rng, tracked=rig.tracked, missing=missing)
