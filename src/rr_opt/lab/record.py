"""A recording of a robot with effects in it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

import numpy as np

from rr_opt.experiment.experiment import Noise
from rr_opt.experiment.recording import Recording
from rr_opt.lab.capture import captured
from rr_opt.lab.effects import rig_with
from rr_opt.lab.engines import Engine, driven
from rr_opt.lab.outing import Outing
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import EffectUse, Robot

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
    Raises InputError for an unknown effect, or if MuJoCo is asked for and not installed.
    """
    rig = rig_with(robot, effects)
    outing = Outing(seconds, start, pose, rate, periods, torque=torque)
    motion = driven(engine, rig, gait, outing, step)
    rng = np.random.default_rng(seed)
    return captured(motion, name, noise, rng, tracked=rig.tracked, missing=missing)
