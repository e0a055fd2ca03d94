"""Random effects, plans of runs, robots, and wrong nominal values."""

from __future__ import annotations

import math

import numpy as np

from rr_lab.case import Case, Plan, motion_of
from rr_lab.effect_size import COARSE
from rr_lab.effects.hidden_effect import HiddenEffect, Setting
from rr_opt.model.experiment import Noise
from rr_opt.model.gait import SineGait
from rr_opt.model.parameters import Uncertainty, parameters_of, with_parameters
from rr_opt.model.robot import EffectUse, Platform, Robot, Servo


def draw_effect(rng: np.random.Generator, effect: HiddenEffect, case: Case) -> EffectUse:
    """An effect of about its typical size for a case that does not have it yet.

    `effect_size.scaled_to` corrects its strength later.
    """

    def passed() -> tuple[float, float]:
        plan = case.plans[int(rng.integers(len(case.plans)))]
        path = motion_of(case, plan, COARSE).one
        at = int(rng.uniform(0.3, 0.7) * len(path))
        return float(path[at, 0]), float(path[at, 1])

    gaits = tuple(plan.gait for plan in case.plans)
    setting = Setting(rng, case.nominal, gaits, passed)
    return EffectUse(effect.key, effect.drawn(setting))


GENTLEST, FIERCEST = 3.0, 42.0
"""rad/s2, peak of phi's acceleration; below, the robot hardly moves, above, real wheels let go."""

CLEARANCE = 0.25
"""The least S1 = c1 cos phi + c2 over c1 + c2: a distance from the singular posture."""

SHORTEST = 0.65
"""Of the longest run's length: people do not record runs of one length."""


def draw_plans(rng: np.random.Generator, robot: Robot, seconds: float = 30.0) -> tuple[Plan, ...]:
    """Seven or eight runs of up to `seconds`: from three to all but two with an offset, one to
    three from rest, two held out."""
    count = int(rng.integers(7, 9))
    turning = rng.permutation(count) < int(rng.integers(3, count - 1))
    resting = rng.permutation(count) < int(rng.integers(1, 4))
    held_out = rng.permutation(count) < 2
    return tuple(
        Plan(
            f"run{n + 1:02d}.csv",
            draw_gait(rng, robot, bool(turning[n])),
            round(seconds * float(rng.uniform(SHORTEST, 1.0)), 2),
            "rest" if resting[n] else "running",
            "holdout" if held_out[n] else "fit",
            _pose(rng),
            int(rng.integers(1, 6)),
        )
        for n in range(count)
    )


def draw_gait(rng: np.random.Generator, robot: Robot, turning: bool) -> SineGait:
    """Amplitude 0.3 to 1.05 rad, period 0.8 to 2 s, offset up to 0.36 rad either way or none."""
    while True:
        amplitude = round(float(rng.uniform(0.3, 1.05)), 3)
        period = round(0.05 * float(rng.integers(16, 41)), 2)
        offset = round(float(rng.uniform(0.05, 0.36) * rng.choice([-1, 1])), 3) if turning else 0.0
        gait = SineGait(amplitude, period, offset)
        fierce = amplitude * gait.angular_frequency**2
        c1, c2 = robot.platform1.c, robot.platform2.c
        S1 = c1 * math.cos(gait.peak_angle) + c2
        if GENTLEST < fierce < FIERCEST and CLEARANCE * (c1 + c2) < S1:
            return gait


def _pose(rng: np.random.Generator) -> tuple[float, float, float]:
    x, y = rng.uniform(-0.3, 0.3, 2)
    return float(x), float(y), float(rng.uniform(-math.pi, math.pi))


def draw_robot(rng: np.random.Generator) -> Robot:
    """A Roller Racer with its longer platform first, rounded as a builder would write it."""
    h = round(rng.uniform(0.015, 0.03), 4)
    c1, c2 = rng.uniform(0.13, 0.24), rng.uniform(0.048, 0.127)
    m1, m2 = rng.uniform(0.3, 0.7), rng.uniform(0.17, 0.6)
    # Both platforms of a robot have like wheels; k, N s/m, spreads over a decade between robots.
    k = np.exp(rng.uniform(np.log(0.0105), np.log(0.085)))
    rate, torque = rng.choice([math.pi, 4.2, 5.5, 6.28]), rng.choice([1.37, 1.5, 2.0, 3.0])
    return Robot(
        _platform(rng, m1, c1, k * rng.uniform(0.82, 1.18), h),
        _platform(rng, m2, c2, k * rng.uniform(0.82, 1.18), h),
        h,
        Servo(2.6, round(float(rate), 5), float(torque)),
    )


def _platform(rng: np.random.Generator, m: float, c: float, k: float, h: float) -> Platform:
    """The radius of gyration of the real platforms is 65 to 110 mm, whatever their c."""
    gyration = rng.uniform(0.065, 0.11)
    return Platform(
        m=round(m, 3),
        I=float(f"{m * gyration**2:.3g}"),
        c=round(c, 4),
        a=round(rng.uniform(0.0, 0.04), 4),
        b=round(rng.uniform(0.038, 0.075), 4),
        kappa=float(f"{k * h**2:.3g}"),
    )


def draw_noise(rng: np.random.Generator) -> Noise:
    """That of a capture system: 0.5 to 1.5 mm, 3 to 4 mrad."""
    return Noise(float(rng.choice([0.5e-3, 1e-3, 1.5e-3])), float(rng.choice([3e-3, 4e-3])))


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
    changed = {}
    for name in names:
        value, known = parameters_of(nominal)[name], uncertainty[name]
        if known.factor is not None:
            value *= rng.uniform(*FACTORS) ** rng.choice([-1, 1])
        else:
            value += known.sigma * rng.uniform(*SIGMAS) * rng.choice([-1, 1])
        changed[name] = float(value)
    return with_parameters(nominal, changed), names


def draw_near(
    rng: np.random.Generator, nominal: Robot, uncertainty: dict[str, Uncertainty], spread: float
) -> Robot:
    """The robot with every value off by chance, `spread` times what its uncertainty says."""
    values = parameters_of(nominal)
    for name in sorted(uncertainty):
        off = spread * float(np.clip(rng.standard_normal(), -2.5, 2.5))
        values[name] += uncertainty[name].sigma * off
    return with_parameters(nominal, values)
