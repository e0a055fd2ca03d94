"""The paper's robot: Table 1, its omissions, and the possible definitions of J20/J10.

Table 1 leaves open a1 and a2 (c1 and c2 follow from c1 - a1 and c2 - a2), the half track b and
the friction k of a wheel, here the same for all wheels. The paper varies J20/J10 by loads on
platform 2 without saying about which points J20 and J10 are taken; section 2 also defines J1 and
J2, which involve both platforms and the joint.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from rr_opt.model.ballast import About, By, inertia_ratio, with_inertia_ratio
from rr_opt.model.robot import Platform, Robot
from rr_opt.outcome import InputError
from rr_paper.publication import TABLE_1, Row
from rr_paper.signs import steady_cycle

BOX = MappingProxyType(
    {
        "a1": (-0.03, 0.03),
        "a2": (-0.03, 0.03),
        "b": (0.02, 0.08),
        "k": (0.01, 1.0),
        "amplitude": (0.2, 1.5),
    }
)
"""Bounds of the unknowns, Table 2's amplitude among them: m, m, m, N s/m, rad."""
UNITS = MappingProxyType({"a1": "m", "a2": "m", "b": "m", "k": "N s/m", "amplitude": "rad"})


def prototype(a1: float, a2: float, b: float, k: float) -> Robot:
    """Table 1 with these unknowns. h is arbitrary (20 mm), as only k = kappa/h^2 matters."""
    h = 0.02
    known = {name: value for name, (value, _) in TABLE_1.items()}
    return Robot(
        Platform(known["m1"], known["I10"], known["c1 - a1"] + a1, a1, b, k * h**2),
        Platform(known["m2"], known["I20"], known["c2 - a2"] + a2, a2, b, k * h**2),
        h,
    )


def random_prototype(rng: np.random.Generator) -> Robot:
    """A prototype drawn from BOX, uniformly except for k, which is log-uniform."""
    a1, a2, b = (rng.uniform(*BOX[name]) for name in ("a1", "a2", "b"))
    return prototype(a1, a2, b, math.exp(rng.uniform(*np.log(BOX["k"]))))


def box_grid(count: int) -> list[Robot]:
    """Prototypes over count x count values of a1 and a2."""
    a1, a2 = (np.linspace(*BOX[name], count).tolist() for name in ("a1", "a2"))
    return [prototype(one, two, 0.03, 0.1) for one in a1 for two in a2]


@dataclass(frozen=True)
class RatioDefinition:
    """One definition of J20/J10.

    ratio  of a robot as it is
    build  (robot, ratio) -> the robot rebuilt to have it; raises InputError if that is impossible
    """

    name: str
    ratio: Callable[[Robot], float]
    build: Callable[[Robot, float], Robot]


def _ballast(name: str, about: About, by: By = "inertia") -> RatioDefinition:
    return RatioDefinition(
        name,
        lambda robot: inertia_ratio(robot, about),
        lambda robot, ratio: with_inertia_ratio(robot, ratio, about, by),
    )


def _by_inertia(name: str, parts: Callable[[Robot], tuple[float, float, float]]) -> RatioDefinition:
    """J20/J10 = (I2 + top)/(share I2 + bottom), of parts top, share and bottom."""

    def ratio(robot: Robot) -> float:
        top, share, bottom = parts(robot)
        return (robot.platform2.I + top) / (share * robot.platform2.I + bottom)

    def build(robot: Robot, ratio: float) -> Robot:
        top, share, bottom = parts(robot)
        inertia = (ratio * bottom - top) / (1 - share * ratio)
        if inertia <= 0:
            raise InputError(
                f"The ratio needs I2 = {inertia:.3g} kg m2. Expected a positive value. Ask for a "
                "larger ratio."
            )
        return replace(robot, platform2=replace(robot.platform2, I=inertia))

    return RatioDefinition(name, ratio, build)


def _about_axles(robot: Robot) -> tuple[float, float, float]:
    one, two = robot.platform1, robot.platform2
    return two.m * two.a**2, 0.0, one.I + one.m * one.a**2


def _of_section2(robot: Robot) -> tuple[float, float, float]:
    """J1 and J2 of section 2 both contain I20."""
    one, two = robot.platform1, robot.platform2
    bottom = one.I + one.m * one.a**2 + two.m * (two.a**2 + one.c**2 - two.c**2)
    return -two.m * (two.c**2 - two.a**2), 1.0, bottom


ABOUT_P = _ballast("about P, by platform 2's inertia", "joint")
DEFINITIONS = (
    ABOUT_P,
    _ballast("about P, by loads of 66 g", "joint", "loads"),
    _ballast("about the centres of mass", "centre"),
    _by_inertia("about the axles' centres", _about_axles),
    _by_inertia("J2/J1 of section 2", _of_section2),
)


@dataclass(frozen=True)
class Sensitivity:
    """Change of a gait's |speed| as one unknown varies over its box, low to high.

    assumed  its value in the shipped robot
    """

    name: str
    assumed: float
    low: float
    high: float
    least: float
    largest: float

    @property
    def swing(self) -> float:
        """Least speed over largest."""
        return self.least / self.largest


def sensitivities(robot: Robot, row: Row) -> tuple[Sensitivity, ...]:
    """Sensitivity to each unknown of the robot alone, at the gait of a row of Table 3."""
    one, two = robot.platform1, robot.platform2
    assumed = {"a1": one.a, "a2": two.a, "b": one.b, "k": robot.k1}
    found = []
    for name, value in assumed.items():
        robots = [prototype(**assumed | {name: x}) for x in np.linspace(*BOX[name], 41).tolist()]
        loaded = [ABOUT_P.build(robot, row.ratio) for robot in robots]
        speed = np.abs(steady_cycle(loaded, row.amplitude or math.nan, row.period).speed)
        found.append(Sensitivity(name, value, *BOX[name], float(speed.min()), float(speed.max())))
    return tuple(found)
