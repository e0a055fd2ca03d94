"""Values of a robot that are possible, and probably not meant."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rr_opt.robot.ballast import inertia_ratio
from rr_opt.robot.parameters import Platform, Robot

_LARGEST_LENGTH = 5.0
"""Longer platforms are taken for millimetres written as metres, m."""

_DENSITY = 8000.0
"""Of steel, kg/m3."""

_LARGEST_FRICTION = 1000.0
"""A robot of a kilogram then stops within a fraction of a millisecond, N s/m per wheel."""


def doubts(robot: Robot) -> Iterator[tuple[tuple[str, ...], str]]:
    """Key path and message of every value that looks like a slip of the pen."""
    for key, platform in (("platform1", robot.platform1), ("platform2", robot.platform2)):
        for name, message in _platform_doubts(platform):
            yield (key, name), message
    longest = max(_longest(robot.platform1)[1], _longest(robot.platform2)[1])
    if robot.h > longest:
        yield (
            ("h",),
            f"The wheel radius is {robot.h:.4g} m, more than any length of the platforms. Plain "
            f"numbers are metres: write `{robot.h:g} mm` for millimetres.",
        )
    ratio = inertia_ratio(robot, "joint")
    if not 0.01 <= ratio <= 100:
        yield (
            ("platform2", "I"),
            f"The inertia ratio J20/J10 about the joint is {ratio:.3g}. Expected 0.01 to 100: the "
            "platforms hardly belong together. Check the units of m, I, c and a of both.",
        )


def too_much_friction(robot: Robot) -> Iterator[tuple[tuple[str, ...], str]]:
    """Key path and message of friction that would stop any robot at once."""
    for key, k in (("platform1", robot.k1), ("platform2", robot.k2)):
        if k > _LARGEST_FRICTION:
            yield (
                (key, "kappa"),
                f"The friction along the floor is k = kappa/h^2 = {k:.3g} N s/m per wheel. "
                f"Expected at most {_LARGEST_FRICTION:.4g}: nothing would roll. Check the "
                "units of kappa and h.",
            )


def singular_posture(robot: Robot) -> str | None:
    """What to say if the servo can reach the posture where S1 = c1 cos phi + c2 vanishes."""
    limit, singular = robot.servo.angle_limit, robot.singular_angle
    if singular >= limit:
        return None
    return (
        f"Within {limit:.4g} rad lies the singular posture |phi| = arccos(-c2/c1) = "
        f"{singular:.4g} rad, where a model without side slip means nothing. A problem keeps "
        "its distance with `limits.singularity`."
    )


def _platform_doubts(platform: Platform) -> Iterator[tuple[str, str]]:
    key, longest = _longest(platform)
    gyration = math.sqrt(platform.I / platform.m)
    if platform.a > platform.c:
        yield (
            "a",
            (
                f"a = {platform.a:.4g} m puts the centre of mass beyond the joint (c = "
                f"{platform.c:.4g} m). a counts from the axle towards the "
                "joint; check that it is not the distance from the joint."
            ),
        )
    if longest > _LARGEST_LENGTH:
        yield (
            key,
            (
                f"The platform is {longest:.4g} m long. Plain numbers are metres: write "
                f"`{longest:g} mm` for millimetres."
            ),
        )
    if platform.m / longest / longest / longest > _DENSITY:
        yield (
            "m",
            (
                f"The platform weighs {platform.m:.4g} kg, more than a cube of steel of its "
                f"largest length, {longest:.3g} m. Plain numbers are kilograms: write "
                f"`{platform.m:g} g` for grams."
            ),
        )
    if gyration > 3 * longest:
        yield (
            "I",
            (
                f"The radius of gyration sqrt(I/m) is {gyration:.3g} m, more than three times the "
                f"platform's largest length, {longest:.3g} m. Check the "
                "units of I (kg m2), m, c and b."
            ),
        )


def _longest(platform: Platform) -> tuple[str, float]:
    """The largest of its lengths, and its key."""
    lengths = {"c": platform.c, "a": abs(platform.a), "b": platform.b}
    key = max(lengths, key=lambda name: lengths[name])
    return key, lengths[key]
