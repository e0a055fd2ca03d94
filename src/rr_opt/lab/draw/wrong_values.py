"""Robots that are not what their builder believes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rr_opt.experiment.experiment import Uncertainty
from rr_opt.robot.parameters import Robot

CANDIDATES = ("m1", "m2", "I1", "I2", "c1", "c2", "a1", "a2", "kappa1", "kappa2")

SIGMAS = 4.0, 8.0
"""By how many standard deviations a known value is wrong: more than chance would make it."""

FACTORS = 1.5, 3.0
"""By what factor a friction is, up or down."""


def draw_wrong(
    rng: np.random.Generator, nominal: Robot, uncertainty: dict[str, Uncertainty]
) -> tuple[Robot, tuple[str, ...]]:
    """The robot with one or two values changed, and their names."""
    count = 1 if rng.random() < 0.6 else 2
    names = tuple(sorted(str(name) for name in rng.choice(CANDIDATES, count, replace=False)))
    robot = nominal
    for name in names:
        value = parameter(robot, name)
        known = uncertainty[name]
        if known.factor is not None:
            value *= rng.uniform(*FACTORS) ** rng.choice([-1, 1])
        else:
            value += known.sigma * rng.uniform(*SIGMAS) * rng.choice([-1, 1])
        robot = with_parameter(robot, name, float(value))
    return robot, names


def draw_near(
    rng: np.random.Generator, nominal: Robot, uncertainty: dict[str, Uncertainty], spread: float
) -> Robot:
    """The robot with every value off by chance, `spread` times what its uncertainty says."""
    robot = nominal
    for name in sorted(uncertainty):
        value, known = parameter(nominal, name), uncertainty[name]
        off = spread * float(np.clip(rng.standard_normal(), -2.5, 2.5))
        robot = with_parameter(robot, name, value + known.sigma * off)
    return robot


def parameter(robot: Robot, name: str) -> float:
    """m1, I1, ... kappa2, or h, of a robot."""
    if name == "h":
        return robot.h
    return getattr(robot.platform1 if name[-1] == "1" else robot.platform2, name[:-1])


def with_parameter(robot: Robot, name: str, value: float) -> Robot:
    """The robot with one of them changed."""
    if name == "h":
        return replace(robot, h=value)
    which = "platform1" if name[-1] == "1" else "platform2"
    return replace(robot, **{which: replace(getattr(robot, which), **{name[:-1]: value})})


def changed_values(robot: Robot, names: Sequence[str]) -> dict[str, float]:
    """The true values of the named parameters."""
    return {name: parameter(robot, name) for name in names}
