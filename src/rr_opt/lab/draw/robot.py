"""A plausible robot, and how well its builder knows it."""

from __future__ import annotations

import numpy as np

from rr_opt.experiment.experiment import Noise, Uncertainty
from rr_opt.robot.parameters import Platform, Robot, Servo

RELATIVE = {"m": 0.01, "I": 0.05}
ABSOLUTE = {"c": 2e-3, "a": 2e-3, "b": 2e-3}
WHEEL_RADIUS = 5e-4
FRICTION_FACTOR = 5.0


def draw_robot(rng: np.random.Generator) -> Robot:
    """A Roller Racer with its longer platform first, rounded as a builder would write it."""
    h = round(rng.uniform(0.015, 0.03), 4)
    c1, c2 = rng.uniform(0.13, 0.24), rng.uniform(0.05, 0.12)
    # Both platforms of a robot have like wheels; k, N s/m, spreads over a decade between robots.
    k = np.exp(rng.uniform(np.log(0.012), np.log(0.085)))
    return Robot(
        _platform(rng, c1, k * rng.uniform(0.85, 1.15), h),
        _platform(rng, c2, k * rng.uniform(0.85, 1.15), h),
        h,
        Servo(2.6, 6.28, 1.5),
    )


def _platform(rng: np.random.Generator, c: float, k: float, h: float) -> Platform:
    """The radius of gyration of the real platforms is 65 to 100 mm, whatever their c."""
    m, gyration = rng.uniform(0.3, 0.7), rng.uniform(0.065, 0.1)
    return Platform(
        m=round(m, 3),
        I=float(f"{m * gyration**2:.3g}"),
        c=round(c, 4),
        a=round(rng.uniform(0.0, 0.03), 4),
        b=round(rng.uniform(0.04, 0.07), 4),
        kappa=float(f"{k * h**2:.3g}"),
    )


def draw_noise(rng: np.random.Generator) -> Noise:
    """That of a capture system: 0.5 to 1.5 mm, 3 to 4 mrad."""
    return Noise(float(rng.choice([0.5e-3, 1e-3, 1.5e-3])), float(rng.choice([3e-3, 4e-3])))


def usual_uncertainty(robot: Robot) -> dict[str, Uncertainty]:
    """1 sigma each: masses 1 %, inertias 5 %, lengths 2 mm, h 0.5 mm; kappa unknown."""
    known = {"h": Uncertainty(WHEEL_RADIUS)}
    for number, platform in ((1, robot.platform1), (2, robot.platform2)):
        for name, part in RELATIVE.items():
            known[f"{name}{number}"] = Uncertainty(part * getattr(platform, name))
        for name, size in ABSOLUTE.items():
            known[f"{name}{number}"] = Uncertainty(size)
        known[f"kappa{number}"] = Uncertainty(factor=FRICTION_FACTOR)
    return known
