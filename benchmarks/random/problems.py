"""Random problems: robots, bounds, limits, offsets, directions, inertia ratios."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from rr_opt.model.ballast import About, By, Loads, inertia_ratio, with_inertia_ratio
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Direction, GaitBounds, Interval, Limits, Problem, RatioChoice
from rr_opt.model.robot import Platform, Robot
from rr_opt.motion.steady_cycle import peak_torque, steady_cycle
from rr_opt.outcome import InputError, NotConvergedError

_DIRECTIONS: tuple[Direction, ...] = ("forward", "backward", "either")


def draw(seed: str, number: int) -> np.random.Generator:
    """The generator of one case."""
    return np.random.default_rng([*seed.encode(), number])


def problem(rng: np.random.Generator) -> Problem:
    """A problem; many have no gait that keeps every limit."""
    robot = _robot(rng)
    limits = Limits(
        angle=_four(rng.uniform(0.8, 2.6)),
        rate=math.inf if rng.random() < 0.2 else _four(rng.uniform(2.0, 9.0)),
        torque=1.0,
        singularity=float(rng.choice([0.01, 0.02, 0.03])),
    )
    shortest = _four(rng.uniform(0.3, 1.0))
    gait = GaitBounds(
        Interval(float(rng.choice([0.05, 0.2])), _four(rng.uniform(0.6, 2.5))),
        Interval(shortest, _four(shortest * rng.uniform(2.0, 5.0))),
        _offset(rng),
    )
    posed = Problem(robot, limits, gait, _ratio(rng, robot), _DIRECTIONS[int(rng.integers(3))])
    return replace(posed, limits=replace(limits, torque=_torque(rng, posed)))


def turning(rng: np.random.Generator) -> Problem:
    """A problem whose offset is open to both sides: for turns."""
    wide = _four(rng.uniform(0.3, 1.0))
    posed = problem(rng)
    return replace(posed, gait=replace(posed.gait, offset=Interval(-wide, wide)))


def _four(value: float) -> float:
    return float(f"{value:.4g}")


def _robot(rng: np.random.Generator) -> Robot:
    h = float(rng.choice([0.012, 0.016, 0.02, 0.025, 0.03]))
    # Most robots roll well; one in ten has friction as in the paper's Table 1.
    kappa = 0.1 if rng.random() < 0.1 else h**2 * 10 ** rng.uniform(-2.0, 0.0)
    platforms = [
        Platform(
            m=_four(rng.uniform(0.2, 1.0)),
            I=_four(10 ** rng.uniform(-3.0, -1.9)),
            c=_four(rng.uniform(*span)),
            a=_four(rng.uniform(-0.03, 0.06)),
            b=_four(rng.uniform(0.02, 0.08)),
            kappa=kappa * rng.uniform(0.5, 2.0),
        )
        for span in ((0.1, 0.28), (0.05, 0.2))
    ]
    return Robot(*platforms, h=h)


def _offset(rng: np.random.Generator) -> Interval:
    kind, size = rng.integers(4), _four(rng.uniform(0.1, 0.6))
    low, high = {
        0: (0.0, 0.0), 1: (size, size), 2: (-size, size), 3: (_four(size / 3), size),
    }[int(kind)]  # fmt: skip
    return Interval(low, high)


def _ratio(rng: np.random.Generator, robot: Robot) -> RatioChoice | None:
    kind = rng.integers(3)
    ways: tuple[By, ...] = ("inertia", "inertia", "loads")
    centres: tuple[About, ...] = ("joint", "centre")
    by, about = ways[int(rng.integers(3))], centres[int(rng.integers(2))]
    own = inertia_ratio(robot, about)
    low = _four(own * (1.0 if by == "loads" else rng.uniform(0.8, 1.2)))
    high = _four(low * rng.uniform(1.3, 3.0))
    if kind == 0:
        return None
    bounds = Interval(high, high) if kind == 1 else Interval(low, high)
    try:
        with_inertia_ratio(robot, bounds.low, about, by, Loads())
    except InputError:
        return None
    return RatioChoice(bounds, about, by, Loads())


def _torque(rng: np.random.Generator, posed: Problem) -> float:
    """None to speak of, or from a third to three times what a gait of the box needs."""
    if rng.random() < 0.4:
        return 5.0
    box = posed.gait
    amplitude = min(0.5 * (box.amplitude.low + box.amplitude.high), 0.8 * posed.limits.angle)
    amplitude = max(amplitude - abs(box.offset.high), box.amplitude.low)
    middle = SineGait(amplitude, math.sqrt(box.period.low * box.period.high), box.offset.high)
    try:
        needed = peak_torque(steady_cycle(posed.robot, middle, steps=2048))
    except NotConvergedError:
        return 5.0
    return _four(needed * 10 ** rng.uniform(-0.5, 0.5))
