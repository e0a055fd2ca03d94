"""The runs of an experiment: mixed gaits, headings and starts, and two that are held out."""

from __future__ import annotations

import math

import numpy as np

from rr_opt.lab.case import Plan
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import Robot

GENTLEST, FIERCEST = 3.0, 30.0
"""rad/s2, peak of phi's acceleration; below, the robot hardly moves, above, real wheels let go."""

CLEARANCE = 0.25
"""The least S1 = c1 cos phi + c2 over c1 + c2: a distance from the singular posture."""


def draw_plans(rng: np.random.Generator, robot: Robot, seconds: float = 30.0) -> tuple[Plan, ...]:
    """Seven or eight runs; about half with an offset, two or three from rest, two held out."""
    count = int(rng.integers(7, 9))
    turning = rng.permutation(count) < count // 2
    resting = rng.permutation(count) < int(rng.integers(2, 4))
    held = rng.permutation(count) < 2
    return tuple(
        Plan(
            f"run{n + 1:02d}.csv",
            draw_gait(rng, robot, bool(turning[n])),
            seconds,
            "rest" if resting[n] else "running",
            "holdout" if held[n] else "fit",
            _pose(rng),
            int(rng.integers(1, 6)),
        )
        for n in range(count)
    )


def draw_gait(rng: np.random.Generator, robot: Robot, turning: bool) -> SineGait:
    """Amplitude 0.3 to 1 rad, period 0.8 to 2 s, offset up to 0.35 rad either way or none."""
    while True:
        amplitude = round(float(rng.uniform(0.3, 1.0)), 3)
        period = round(float(rng.uniform(0.8, 2.0)), 1)
        offset = round(float(rng.uniform(0.08, 0.35) * rng.choice([-1, 1])), 3) if turning else 0.0
        gait = SineGait(amplitude, period, offset)
        fierce = amplitude * gait.angular_frequency**2
        c1, c2 = robot.platform1.c, robot.platform2.c
        S1 = c1 * math.cos(gait.peak_angle) + c2
        if GENTLEST < fierce < FIERCEST and CLEARANCE * (c1 + c2) < S1:
            return gait


def _pose(rng: np.random.Generator) -> tuple[float, float, float]:
    x, y = rng.uniform(-0.3, 0.3, 2)
    return float(x), float(y), float(rng.uniform(-math.pi, math.pi))
