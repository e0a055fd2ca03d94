"""Problems whose free gaits were once no optima: a climb went on by 8e-4 and by 1.6e-3."""

from __future__ import annotations

from rr_opt.model.problem import GaitBounds, Interval, Limits, Problem
from rr_opt.model.robot import Platform, Robot


def _robot(h: float, one: tuple[float, ...], two: tuple[float, ...]) -> Robot:
    """Platforms as (m, I, c, a, b, k)."""
    both = (Platform(*p[:5], kappa=p[5] * h**2) for p in (one, two))
    return Robot(*both, h=h)


_SWING, _PERIOD = Interval(0.2, 1.4), Interval(0.5, 2.5)

BEATEN = {
    # The torque holds it: where the intervals begin counts.
    "beaten_torque": Problem(
        _robot(
            0.02,
            (0.2966, 0.003175, 0.1021, 0.05724, 0.02688, 0.01252),
            (0.4982, 0.002484, 0.1914, -0.003136, 0.03162, 0.006686),
        ),
        Limits(angle=1.5, rate=4.54, torque=0.3, singularity=0.02),
        GaitBounds(_SWING, _PERIOD, Interval(0.0, 0.0), "free"),
    ),
    # The angle holds it, between two nodes.
    "beaten_angle": Problem(
        _robot(
            0.012,
            (0.9721, 0.01203, 0.2349, 0.01123, 0.07009, 0.06863),
            (0.5991, 0.006061, 0.07346, 0.0305, 0.05861, 0.1059),
        ),
        Limits(angle=0.9, rate=3.79, torque=0.15, singularity=0.02),
        GaitBounds(_SWING, _PERIOD, Interval(-0.4, 0.4), "free"),
    ),
}
