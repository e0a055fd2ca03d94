"""What J20/J10 may mean: several readings, each giving platform 2 the inertia it asks for.

The paper varies the ratio by loads on platform 2 and does not say about which points J20 and J10
are taken. Section 2 also has J1 and J2 of its own, in which both platforms and the joint enter.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from rr_opt.outcome import InputError
from rr_opt.robot.ballast import inertia_ratio, with_inertia_ratio
from rr_opt.robot.parameters import Robot


@dataclass(frozen=True)
class Reading:
    """One meaning of J20/J10.

    ratio  of a robot as it is
    build  (robot, ratio) -> the robot rebuilt; raises InputError where that cannot be
    """

    name: str
    ratio: Callable[[Robot], float]
    build: Callable[[Robot, float], Robot]


def _about_axles(robot: Robot) -> float:
    one, two = robot.platform1, robot.platform2
    return (two.I + two.m * two.a**2) / (one.I + one.m * one.a**2)


def _with_axles(robot: Robot, ratio: float) -> Robot:
    one, two = robot.platform1, robot.platform2
    return _with_inertia(robot, ratio * (one.I + one.m * one.a**2) - two.m * two.a**2)


def _of_section_2(robot: Robot) -> tuple[float, float]:
    """J1 and J2 of section 2 less I20, kg m2: what they are besides it."""
    one, two = robot.platform1, robot.platform2
    return (
        one.I + one.m * one.a**2 + two.m * (two.a**2 + one.c**2 - two.c**2),
        -two.m * (two.c**2 - two.a**2),
    )


def _section_2(robot: Robot) -> float:
    J1, J2 = _of_section_2(robot)
    return (robot.platform2.I + J2) / (robot.platform2.I + J1)


def _with_section_2(robot: Robot, ratio: float) -> Robot:
    J1, J2 = _of_section_2(robot)
    return _with_inertia(robot, (ratio * J1 - J2) / (1 - ratio))


def _with_inertia(robot: Robot, inertia: float) -> Robot:
    if inertia <= 0:
        raise InputError(
            f"The ratio needs I2 = {inertia:.3g} kg m2. It must be positive. Ask for a larger one."
        )
    return replace(robot, platform2=replace(robot.platform2, I=inertia))


READINGS = (
    Reading(
        "about P, by platform 2's inertia",
        lambda robot: inertia_ratio(robot, "joint"),
        lambda robot, ratio: with_inertia_ratio(robot, ratio, "joint"),
    ),
    Reading(
        "about P, by loads of 66 g",
        lambda robot: inertia_ratio(robot, "joint"),
        lambda robot, ratio: with_inertia_ratio(robot, ratio, "joint", "loads"),
    ),
    Reading(
        "about the centres of mass",
        lambda robot: inertia_ratio(robot, "centre"),
        lambda robot, ratio: with_inertia_ratio(robot, ratio, "centre"),
    ),
    Reading("about the axles' centres", _about_axles, _with_axles),
    Reading("J2/J1 of section 2", _section_2, _with_section_2),
)
ABOUT_P = READINGS[0]
