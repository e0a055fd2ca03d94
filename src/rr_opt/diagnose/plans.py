"""Recordings that could be made next: gaits the servo can do, and runs of them that are made up."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.diagnose.model import Array, Piece
from rr_opt.diagnose.racer import RollerRacer
from rr_opt.experiment.experiment import Run, Start
from rr_opt.experiment.recording import CHANNELS, Recording
from rr_opt.physics.floor_motion import floor_motion
from rr_opt.physics.kinematics import robot_values
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import Robot

CLEARANCE = 0.25
"""The least S1 = c1 cos phi + c2 over c1 + c2 that a plan comes to: near 0 is the singularity."""

FIERCEST = 30.0
"""Peak of phi's acceleration, rad/s2, beyond which real wheels let go."""

_AMPLITUDES = (0.25, 0.4, 0.6, 0.8, 1.0, 1.3)
_PERIODS = (0.6, 0.8, 1.0, 1.4, 2.0, 2.8)
_OFFSETS = (0.0, 0.15, 0.3, 0.5)
_SETTLING = 20.0
"""So long a robot that is `running` has been driven before, s."""


@dataclass(frozen=True)
class Plan:
    """A recording to be made: a sine, how long (s), from rest or running, heading (rad)."""

    gait: SineGait
    seconds: float
    start: Start
    heading: float


def gaits(robot: Robot) -> list[SineGait]:
    """Sines within the servo's limits and away from the singular posture, both sides."""
    offsets = sorted({side * offset for offset in _OFFSETS for side in (1, -1)})
    every = (SineGait(*one) for one in itertools.product(_AMPLITUDES, _PERIODS, offsets))
    return [gait for gait in every if allowed(robot, gait)]


def allowed(robot: Robot, gait: SineGait) -> bool:
    """Whether the servo can do it, and the robot stays away from the singular posture."""
    c1, c2 = robot.platform1.c, robot.platform2.c
    S1 = c1 * math.cos(min(gait.peak_angle, math.pi)) + c2
    return (
        gait.peak_angle <= robot.servo.angle_limit
        and gait.peak_rate <= robot.servo.rate_limit
        and gait.amplitude * gait.angular_frequency**2 <= FIERCEST
        and CLEARANCE * (c1 + c2) <= S1
    )


@dataclass(frozen=True)
class Imagined:
    """A run that was never made, as the one run of a model, and the state in which it starts."""

    model: RollerRacer
    piece: Piece
    start: Array


def imagined(
    model: RollerRacer,
    plan: Plan,
    rate: float,
    values: Mapping[str, float],
    effects: tuple[str, ...],
) -> Imagined:
    """The run of a plan, sampled at `rate`, 1/s, as the model with the effects predicts it.

    It starts from where the recorded runs did, in the middle of them.
    """
    first = np.nanmedian([data.values[:20, :2] for data in model.runs], axis=(0, 1))
    start = np.array([*first, plan.heading, 0.0, 0.0, 0.0])
    if plan.start == "running":
        start[3] = _settled(model, plan, values, effects, start)
    t = np.arange(round(plan.seconds * rate) + 1) / rate
    empty = _one_run(model, plan, t, np.zeros((t.size, len(CHANNELS))))
    piece = Piece(0, 0, t.size)
    predicted = empty.respond(piece, values, effects, start).predicted
    return Imagined(_one_run(model, plan, t, predicted), piece, start)


def _settled(
    model: RollerRacer,
    plan: Plan,
    values: Mapping[str, float],
    effects: tuple[str, ...],
    start: Array,
) -> float:
    """z, m/s, after whole periods of the gait, begun at rest."""
    period = plan.gait.period
    end = math.ceil(_SETTLING / period) * period
    t = np.append(np.arange(0.0, end - period / 40, period / 40), [end - 1e-3, end])
    before = _one_run(model, replace(plan, start="rest"), t, np.zeros((t.size, len(CHANNELS))))
    seen = before.respond(Piece(0, 0, t.size), values, effects, start).predicted
    dx, dy = (seen[-1, :2] - seen[-2, :2]) / 1e-3
    # P moves at v along platform 1's axis, and the state holds z = v - g dphi.
    v = float(dx * np.cos(seen[-1, 2]) + dy * np.sin(seen[-1, 2]))
    p = robot_values(model.experiment.robot)
    angle = [float(plan.gait.angle(0.0)), float(plan.gait.rate(0.0))]
    return v - float(floor_motion().speeds([*start[:3], 0.0], angle, p)[0])


def _one_run(model: RollerRacer, plan: Plan, t: Array, values: Array) -> RollerRacer:
    noise = model.experiment.noise
    recording = Recording(
        "to be made",
        t,
        dict(zip(CHANNELS, values.T, strict=True)),
        {name: np.full(t.size, noise.of(name)) for name in CHANNELS},
        {name: np.zeros(t.size, np.uint8) for name in CHANNELS},
    )
    run = Run(recording, plan.gait, "fit", plan.start)
    return RollerRacer(replace(model.experiment, runs=(run,)))
