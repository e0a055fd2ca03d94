"""What the numpy steady cycle needs of each platform, for many inertia ratios at once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rr_opt.model.problem import RatioChoice
from rr_opt.model.robot import Platform, Robot


class Body(NamedTuple):
    """A platform: m, the inertia J about its axle's centre, m a, c, b, k; each may be a column."""

    m: ArrayLike
    J: ArrayLike
    ma: ArrayLike
    c: float
    b: float
    k: float


def body(p: Platform, k: float) -> Body:
    return Body(p.m, p.I + p.m * p.a**2, p.m * p.a, p.c, p.b, k)


def loaded_body(robot: Robot, choice: RatioChoice, ratio: NDArray[np.float64]) -> Body:
    """Platform 2 for each ratio J20/J10, in the definition and realisation of `choice`."""
    p, q, loads = robot.platform2, robot.platform1, choice.loads
    arm, arm1 = p.c - p.a, q.c - q.a
    wanted = ratio * (q.I + (q.m * arm1**2 if choice.about == "joint" else 0.0))
    if choice.by == "inertia":
        inertia = wanted - (p.m * arm**2 if choice.about == "joint" else 0.0)
        return Body(p.m, inertia + p.m * p.a**2, p.m * p.a, p.c, p.b, robot.k2)
    if choice.about == "joint":
        extra = (wanted - p.I - p.m * arm**2) / (loads.distance**2 + loads.spread**2)
    else:  # I + extra spread^2 + (m extra / (m + extra)) gap^2 = wanted, the root that is >= 0
        s2, excess = loads.spread**2, wanted - p.I
        half = (p.m * (s2 + (loads.distance - arm) ** 2) - excess) / 2
        extra = (np.sqrt(half**2 + s2 * p.m * excess) - half) / s2
    at = p.c - loads.distance  # where the loads hang, from the axle
    about_axle = p.I + p.m * p.a**2 + extra * (loads.spread**2 + at**2)
    return Body(p.m + extra, about_axle, p.m * p.a + extra * at, p.c, p.b, robot.k2)
