"""A turn that is asked for, and one that is reached, in words."""

from __future__ import annotations

import math
from dataclasses import dataclass

from rr_opt.problem import ANY, Interval, Turn
from rr_opt.robot.gait import SineGait

SURE = 2e-3
"""The search is good to a few parts in ten thousand; what is told to be in reach, is."""


@dataclass(frozen=True)
class Nearest:
    """The gait that comes nearest to a turn within all limits, and what it does.

    torque   largest, N m; share: of the ballast's range
    distance from the turn, relative
    """

    gait: SineGait
    share: float
    curvature: float
    yaw_rate: float
    heading: float
    torque: float
    distance: float


def asked_text(turn: Turn) -> str:
    """What is asked, in words."""
    parts = []
    if turn.curvature != ANY:
        parts.append(_radius(_binding(turn.curvature), not turn.curvature.fixed))
    if turn.yaw_rate != ANY:
        rate = _binding(turn.yaw_rate)
        parts.append(f"at least {abs(rate):.4g} rad/s to the {side(rate)}")
    if turn.heading != ANY:
        each = _binding(turn.heading)
        parts.append(f"{abs(each):.4g} rad a period to the {side(each)}")
    return " with ".join(parts)


def reached_text(turn: Turn, nearest: Nearest) -> str:
    """The same of what can be reached, rounded away from what cannot."""
    parts = []
    for name, asked in (
        ("curvature", turn.curvature),
        ("yaw_rate", turn.yaw_rate),
        ("heading", turn.heading),
    ):
        if asked == ANY:
            continue
        value = getattr(nearest, name)
        # Nearer to the asked value is out of reach: a little further away is told.
        value *= 1 - math.copysign(SURE, (asked.clip(value) - value) * value)
        text = {
            "curvature": _radius(value, False),
            "yaw_rate": f"{abs(value):.4g} rad/s to the {side(value)}",
            "heading": f"{abs(value):.4g} rad a period to the {side(value)}",
        }
        parts.append(text[name])
    return " with ".join(parts)


def side(value: float) -> str:
    """Which way a positive or negative turn goes."""
    return "left" if value > 0 else "right"


def _binding(asked: Interval) -> float:
    """The end of an interval that asks for something: a finite one, the nearest to straight."""
    ends = [end for end in (asked.low, asked.high) if math.isfinite(end)]
    return min(ends, key=abs)


def _radius(curvature: float, at_most: bool) -> str:
    """`a radius of 0.3 m to the left`."""
    most = "at most " if at_most else ""
    return f"a radius of {most}{abs(1 / curvature):.4g} m to the {side(curvature)}"
