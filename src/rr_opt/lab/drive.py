"""A gait driven on a rig: MuJoCo steps it, and its motion is written down."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from rr_opt.lab.plant import Plant
from rr_opt.lab.rig import Rig
from rr_opt.robot.gait import Gait

Array = NDArray[np.float64]

SETTLE = 0.05
"""s, in which the robot comes to rest on its wheels before anything else, on a level floor."""

STEP = 2.5e-4
"""s. results/lab/README.md shows what it is worth."""


@dataclass(frozen=True)
class Outing:
    """How a robot is let go.

    seconds, rate   how long is recorded, s, and how often, 1/s
    start           `rest`: the command begins at its time 0; `running`: `periods` whole periods
                    before, from rest
    nudge           m/s, a push at the recording's t = 0, by which the whole mass would be faster
    pose            x (m), y (m) of P and heading (rad) of platform 1 where it is put down
    """

    seconds: float
    start: Literal["rest", "running"] = "rest"
    pose: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rate: float = 100.0
    periods: int = 3
    nudge: float = 0.0

    def begin(self, gait: Gait) -> float:
        """When the command begins, s on its own clock."""
        return 0.0 if self.start == "rest" else -self.periods * gait.period


@dataclass(frozen=True)
class Motion:
    """What truly happened, at the recording's times t (n,), s.

    one, two  x (m), y (m) and heading (rad, unwrapped) of the platforms' joint ends, (n, 3). A
              loose pin sets them apart
    torque    of the servo on platform 2, N m (n,)
    """

    t: Array
    one: Array
    two: Array
    torque: Array


def drive(rig: Rig, gait: Gait, outing: Outing, step: float = STEP) -> Motion:
    """Drive a gait and write down the motion."""
    plant = Plant.of(rig, step)
    every = max(1, round(1 / (outing.rate * step)))
    dt = 1 / (outing.rate * every)
    plant.model.opt.timestep = dt
    begin = outing.begin(gait)
    before = math.ceil((SETTLE + max(0.0, rig.clock - begin)) / dt)
    samples = round(outing.seconds * outing.rate) + 1
    t = rig.clock + (np.arange(before + (samples - 1) * every + 2) - before) * dt
    angle = _angle(rig, gait, begin, t)
    return _run(plant, outing, angle, before, every, t, begin)


def servo_angles(rig: Rig, gait: Gait, outing: Outing, when: Array) -> tuple[Array, Array]:
    """The command and the angle of the servo's shaft, rad, at command times `when`, s."""
    begin = outing.begin(gait)
    t = np.arange(min(begin, when.min()) - SETTLE, when.max() + 2 * STEP, STEP)
    return gait.angle(np.maximum(when, begin)), np.interp(when, t, _angle(rig, gait, begin, t))


def _angle(rig: Rig, gait: Gait, begin: float, t: NDArray[Any]) -> Array:
    """The angle that the servo makes, rad, at the times t: the command, shaped by its faults."""
    angle = gait.angle(np.maximum(t, begin)) + rig.offset
    for shaper in rig.shapers:
        angle = shaper(t, angle)
    return angle


def _run(
    plant: Plant,
    outing: Outing,
    angle: Array,
    before: int,
    every: int,
    t: NDArray[Any],
    begin: float,
) -> Motion:
    model, data = plant.model, plant.data
    dt = model.opt.timestep
    plant.put_down(outing.pose, angle[0])
    level = np.array([0.0, 0.0, float(plant.rig.gravity[2])])
    model.opt.gravity[:] = level
    let_go = int(np.searchsorted(t, begin - 1e-12))
    # The acceleration that takes the flywheel, whose steps are q' = q + dt w', through `angle`.
    push = np.diff(np.concatenate([angle[:1], angle]), 2) / dt**2
    rows: list[tuple[Any, ...]] = []
    step, control, laws = plant.mujoco.mj_step, data.ctrl, plant.rig.laws
    for k in range(len(t) - 1):
        if k == let_go:
            model.opt.gravity[:] = plant.rig.gravity
        if laws:
            plant.brake(t[k] - begin)
        if outing.nudge:
            plant.push(outing.nudge / dt if k == before else 0.0)
        control[0] = push[k]
        since = k - before
        if since >= 0 and since % every == 0:
            place = plant.places()
            step(model, data)
            rows.append((*place, plant.torque()))
        else:
            step(model, data)
    plant.require_sound()
    table = np.array(rows)
    table[:, 2], table[:, 5] = np.unwrap(table[:, 2]), np.unwrap(table[:, 5])
    when = np.arange(len(table)) / outing.rate
    return Motion(when, table[:, :3], table[:, 3:6], table[:, 6])
