"""Gait problems of every kind the package accepts, to run it and its alternatives on.

Between them: straight, turning and free offsets; every direction; each limit binding and not;
the paper's ranges and wide ones; J20/J10 free, fixed and absent, by loads and by inertia, about
the joint and about the centres; low and high friction; a robot that can never be singular.
"""

from __future__ import annotations

import math
from dataclasses import replace

from rr_opt.model.ballast import Loads
from rr_opt.model.problem import GaitBounds, Interval, Limits, Problem, RatioChoice
from rr_opt.model.robot import Platform, Robot

H = 0.02  # wheel radius, m
RPM30 = math.pi  # rad/s
WIDE = (Interval(0.05, 2.6), Interval(0.3, 3.0))
PAPER = (Interval(0.1, 1.4), Interval(0.8, 2.0))
STRAIGHT, FREE = Interval(0.0, 0.0), Interval(-0.5, 0.5)


def robot(k: float = 0.05, **platform2: float) -> Robot:
    """The benchmark's robot with viscous friction k, N s/m per wheel."""
    kappa = k * H**2
    one = Platform(m=0.469, I=0.00386, c=0.236, a=0.05, b=0.05, kappa=kappa)
    two = Platform(m=0.25, I=0.3 * 0.00386, c=0.0941, a=0.05, b=0.05, kappa=kappa)
    return Robot(one, replace(two, **platform2), h=H)


def prototype() -> Robot:
    """Table 1's masses and inertias, the rest as fitted to the paper's speeds."""
    one = Platform(m=0.469, I=0.00386, c=0.206, a=0.020, b=0.022, kappa=0.15 * H**2)
    two = Platform(m=0.250, I=0.00175, c=0.0641, a=0.020, b=0.022, kappa=0.15 * H**2)
    return Robot(one, two, h=H)


def gait(ranges: tuple[Interval, Interval], offset: Interval = STRAIGHT) -> GaitBounds:
    return GaitBounds(*ranges, offset)


def limits(torque: float = 1.5, rate: float = RPM30, singularity: float = 0.020) -> Limits:
    return Limits(angle=2.6, rate=rate, torque=torque, singularity=singularity)


def ratio(low: float, high: float, about: str = "joint", by: str = "inertia") -> RatioChoice:
    return RatioChoice(Interval(low, high), about, by, Loads())


CENTRE = ratio(0.08, 0.6, "centre")

PROBLEMS: dict[str, Problem] = {
    # The problem on which the alternatives were first compared.
    "reference": Problem(robot(), limits(), gait(WIDE, FREE), CENTRE),
    "reference_torque": Problem(robot(), limits(torque=0.05), gait(WIDE, FREE), CENTRE),
    "straight": Problem(robot(), limits(), gait(WIDE), CENTRE, "forward"),
    "straight_torque": Problem(robot(), limits(torque=0.02), gait(WIDE), CENTRE),
    "no_rate_limit": Problem(robot(), limits(rate=math.inf), gait(WIDE), CENTRE),
    "no_rate_limit_turning": Problem(robot(), limits(0.2, math.inf), gait(WIDE, FREE), CENTRE),
    "no_rate_limit_backward": Problem(
        prototype(), limits(0.2, math.inf), gait(WIDE, FREE), ratio(0.12, 0.6), "backward"
    ),
    "paper": Problem(prototype(), limits(), gait(PAPER), ratio(0.12, 0.3)),
    "paper_forward": Problem(prototype(), limits(), gait(PAPER), ratio(0.12, 0.3), "forward"),
    "paper_torque": Problem(prototype(), limits(torque=0.05), gait(PAPER), ratio(0.12, 0.3)),
    "paper_loads": Problem(prototype(), limits(), gait(PAPER), ratio(0.12, 0.3, by="loads")),
    "loads_centre": Problem(
        robot(), limits(0.1), gait(WIDE, FREE), ratio(0.3, 0.6, "centre", "loads")
    ),
    "ratio_fixed": Problem(robot(), limits(), gait(WIDE, FREE), ratio(0.2, 0.2)),
    "ratio_absent": Problem(prototype(), limits(), gait(WIDE, FREE)),
    "turn_fixed": Problem(robot(), limits(), gait(WIDE, Interval(0.3, 0.3)), CENTRE),
    "turn_away": Problem(robot(), limits(0.06), gait(WIDE, Interval(0.2, 0.6)), CENTRE),
    "turn_backward": Problem(
        prototype(), limits(), gait(WIDE, Interval(-0.6, -0.2)), ratio(0.12, 0.6), "backward"
    ),
    "low_friction": Problem(robot(0.01), limits(), gait(WIDE, FREE), CENTRE),
    "low_friction_torque": Problem(robot(0.01), limits(0.05), gait(WIDE, FREE), CENTRE),
    "high_friction": Problem(robot(0.5), limits(), gait(WIDE, FREE), CENTRE),
    "never_singular": Problem(robot(c=0.3), limits(), gait(WIDE, FREE), ratio(1.3, 3.0)),
    "tight_margin": Problem(robot(), limits(singularity=0.005), gait(WIDE, FREE), ratio(0.2, 0.2)),
}
