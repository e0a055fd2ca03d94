"""Recordings that could be made next: gaits the servo can do, and runs of them that are made up."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.diagnose.model import Array, Asked, Piece
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
    """Runs that were never made, as those of a model, and the states in which they start."""

    model: RollerRacer
    starts: Mapping[Piece, Array]

    def within(self, room: float) -> dict[Piece, Array]:
        """Those that go no farther than `room`, m, and keep to the numbers."""
        values = {piece: self.model.runs[piece.run].values for piece in self.starts}
        return {
            piece: start
            for piece, start in self.starts.items()
            if np.isfinite(values[piece][1:]).any() and extent([values[piece][:, :2]]) <= room
        }


def imagined(
    model: RollerRacer,
    plans: Sequence[Plan],
    rate: float,
    values: Mapping[str, float],
    effects: tuple[str, ...],
) -> Imagined:
    """The runs of plans, sampled at `rate`, 1/s, as the model with the effects predicts them.

    They start from where the recorded runs did, in the middle of them.
    """
    first = np.nanmedian([data.values[:20, :2] for data in model.runs], axis=(0, 1))
    starts = [np.array([*first, plan.heading, 0.0, 0.0, 0.0]) for plan in plans]
    for k, z in _settled(model, plans, values, effects, starts).items():
        starts[k][3] = z
    times = [np.arange(round(plan.seconds * rate) + 1) / rate for plan in plans]
    empty, predicted = _driven(model, plans, times, values, effects, starts)
    runs = [
        replace(run, recording=_recording(model, t, seen))
        for run, t, seen in zip(empty.experiment.runs, times, predicted, strict=True)
    ]
    # A run that leaves the numbers says nothing of what is usual, and no plan changes another's.
    made = RollerRacer(replace(model.experiment, runs=tuple(runs)), model.setting)
    pieces = (Piece(k, 0, t.size) for k, t in enumerate(times))
    return Imagined(made, dict(zip(pieces, starts, strict=True)))


def _settled(
    model: RollerRacer,
    plans: Sequence[Plan],
    values: Mapping[str, float],
    effects: tuple[str, ...],
    starts: Sequence[Array],
) -> dict[int, float]:
    """z, m/s, of the plans that start running, after whole periods of the gait begun at rest."""
    running = [k for k, plan in enumerate(plans) if plan.start == "running"]
    before = [replace(plans[k], start="rest") for k in running]
    times = []
    for plan in before:
        period = plan.gait.period
        end = math.ceil(_SETTLING / period) * period
        t = np.arange(0.0, end - period / 40, period / 40)
        times.append(np.append(t, [end - 1e-3, end]))
    _, predicted = _driven(model, before, times, values, effects, [starts[k] for k in running])
    p = robot_values(model.experiment.robot)
    out = {}
    for k, seen in zip(running, predicted, strict=True):
        dx, dy = (seen[-1, :2] - seen[-2, :2]) / 1e-3
        # P moves at v along platform 1's axis, and the state holds z = v - g dphi.
        v = float(dx * np.cos(seen[-1, 2]) + dy * np.sin(seen[-1, 2]))
        gait = plans[k].gait
        angle = [float(gait.angle(0.0)), float(gait.rate(0.0))]
        out[k] = v - float(floor_motion().speeds([*starts[k][:3], 0.0], angle, p)[0])
    return out


def _driven(
    model: RollerRacer,
    plans: Sequence[Plan],
    times: Sequence[Array],
    values: Mapping[str, float],
    effects: tuple[str, ...],
    starts: Sequence[Array],
) -> tuple[RollerRacer, Sequence[Array]]:
    """A model with the runs of plans, still empty, and its predictions of them (n, 4)."""
    runs = tuple(
        Run(_recording(model, t, np.zeros((t.size, len(CHANNELS)))), plan.gait, "fit", plan.start)
        for plan, t in zip(plans, times, strict=True)
    )
    empty = RollerRacer(replace(model.experiment, runs=runs), model.setting)
    asked = [
        Asked(Piece(k, 0, t.size), values, start)
        for k, (t, start) in enumerate(zip(times, starts, strict=True))
    ]
    return empty, empty.simulated.predicted(asked, effects)


def _recording(model: RollerRacer, t: Array, values: Array) -> Recording:
    noise = model.experiment.noise
    return Recording(
        "to be made",
        t,
        dict(zip(CHANNELS, values.T, strict=True)),
        {name: np.full(t.size, noise.of(name)) for name in CHANNELS},
        {name: np.zeros(t.size, np.uint8) for name in CHANNELS},
    )


def extent(paths: Sequence[Array]) -> float:
    """How far any of the paths (n, 2) goes from where it starts, m."""
    return max(float(np.nanmax(np.hypot(*(path - path[_first(path)]).T))) for path in paths)


def _first(path: Array) -> int:
    return int(np.flatnonzero(np.isfinite(path).all(axis=1))[0])
