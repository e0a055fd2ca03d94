"""The inertia ratio J20/J10: how it is defined, and how it is realised on the robot.

The paper varies J20/J10 between 0.08 and 0.3 by hanging 66 g loads on platform 2 and does
not say about which point the J are taken. Two definitions are offered: about the joint P
(the default: with Table 1's values only this one is near the printed ratios), or about each
platform's own centre of mass. Two ways of realising a ratio are offered: changing the moment
of inertia I of platform 2 alone, or adding loads, which change its mass, centre of mass and
inertia together.
"""

import math
from dataclasses import replace
from typing import Any, Literal

from rr_opt.model.fields import SI, data, declared
from rr_opt.model.robot import Platform, Robot
from rr_opt.outcome import InputError
from rr_opt.units import Number

About = Literal["joint", "centre"]
By = Literal["inertia", "loads"]


_DISTANCE = Number("m", "44.1 mm", at_least=0)


@data
class Loads:
    """Loads that can be hung on platform 2; one weighs 66 g in Table 1.

    mass      of one load, kg
    distance  from the joint P to the loads along platform 2's axis, towards its axle, m
    spread    of the loads to either side of the axis, m: they hang in a balanced way, so the
              centre of mass stays on the axis and each adds mass*spread^2 of inertia
    whole     True: only whole numbers of loads exist
    """

    mass: SI = declared(Number("kg", "66 g", above=0), "Mass of one load, kg.", default=0.066)
    distance: SI = declared(
        _DISTANCE, "From the joint P to the loads, towards the axle, m.", default=0.0441
    )
    spread: SI = declared(
        _DISTANCE, "Of the loads to either side of the platform's axis, m.", default=0.05
    )
    whole: bool = declared(None, "true: only whole numbers of loads exist.", default=False)

    @property
    def each(self) -> tuple[float, float, float]:
        """mass, distance and spread of one load."""
        return self.mass, self.distance, self.spread


def inertia_ratio(robot: Robot, about: About) -> float:
    """J20/J10 of the robot as it is, dimensionless."""
    if about == "joint":
        return robot.platform2.joint_inertia / robot.platform1.joint_inertia
    return robot.platform2.I / robot.platform1.I


def hang(
    m: Any, I: Any, reach: Any, each: tuple[Any, Any, Any], count: Any
) -> tuple[Any, Any, Any]:
    """Mass, moment of inertia and distance from P to the centre of mass, with loads hung on.

    m, I, reach: the same without them. Works on whatever adds and divides: floats, arrays,
    CasADi expressions.
    """
    mass, distance, spread = each
    added = count * mass
    total = m + added
    centre = (m * reach + added * distance) / total
    reduced = m * added / total
    return total, I + reduced * (distance - reach) ** 2 + added * spread**2, centre


def with_load_count(platform: Platform, loads: Loads, count: float) -> Platform:
    """Platform 2 carrying `count` loads (a real number >= 0): new m, I and a."""
    m, I, reach = hang(platform.m, platform.I, platform.joint_to_centre, loads.each, count)
    return replace(platform, m=m, I=I, a=platform.c - reach)


def load_count(robot: Robot, ratio: float, about: About, loads: Loads) -> float:
    """How many loads give J20/J10 = ratio; a real number, negative if the robot exceeds it.

    About P the inertia grows linearly with the count. About the centre of mass the loads of
    mass M = count*mass give I2 + M spread^2 + m2 M/(m2 + M) d^2, d the distance between the
    centres, and the count is the root of a quadratic that is continuous with ratio.
    """
    platform = robot.platform2
    if about == "joint":
        excess = ratio * robot.platform1.joint_inertia - platform.joint_inertia
        each = loads.mass * (loads.distance**2 + loads.spread**2)
        return excess / each if each > 0 else _unreachable(excess)
    excess = ratio * robot.platform1.I - platform.I
    d2 = (loads.distance - platform.joint_to_centre) ** 2
    s2 = loads.spread**2
    # s2 M^2 + (m (s2 + d2) - excess) M - m excess = 0; the root that is 0 at excess = 0.
    linear = platform.m * (s2 + d2) - excess
    root = math.sqrt(max(linear**2 + 4 * s2 * platform.m * excess, 0.0))
    if linear + root <= 0:
        return _unreachable(excess)
    return 2 * platform.m * excess / (linear + root) / loads.mass


def _unreachable(excess: float) -> float:
    """The count where loads do not change the inertia enough, or at all."""
    return math.copysign(math.inf, excess) if excess else 0.0


def with_inertia_ratio(
    robot: Robot,
    ratio: float,
    about: About = "joint",
    by: By = "inertia",
    loads: Loads | None = None,
) -> Robot:
    """The robot rebuilt so that J20/J10 = ratio.

    The number of loads may be any real number here, `loads.whole` or not.
    Raises InputError when the ratio cannot be realised: an inertia that would not be
    positive, or fewer than no loads.
    """
    if by == "loads":
        loads = loads or Loads()
        count = load_count(robot, ratio, about, loads)
        own = inertia_ratio(robot, about)
        if count == math.inf:
            raise InputError(
                f"An inertia ratio J20/J10 = {ratio:.4g} cannot be reached with loads. At "
                f"{loads.distance:.4g} m from the joint and {loads.spread:.4g} m to the sides, any "
                "number of them stays below it. Ask for a smaller ratio, hang the loads further "
                "out, or use `by: inertia`."
            )
        if not count >= -1e-12:
            raise InputError(
                f"An inertia ratio J20/J10 = {ratio:.4g} cannot be reached with loads. The robot "
                f"without loads has {own:.4g}, and loads only add to it. Ask for a ratio of at "
                f"least {own:.4g}, or use `by: inertia`."
            )
        return replace(robot, platform2=with_load_count(robot.platform2, loads, max(count, 0.0)))
    if about == "joint":
        offset = robot.platform2.m * robot.platform2.joint_to_centre**2
        inertia = ratio * robot.platform1.joint_inertia - offset
    else:
        offset = 0.0
        inertia = ratio * robot.platform1.I
    if inertia <= 0:
        least = offset / robot.platform1.joint_inertia
        raise InputError(
            f"An inertia ratio J20/J10 = {ratio:.4g} about the joint needs a moment of inertia "
            f"I2 = {inertia:.3g} kg m2. It must be positive. Ask for a ratio above {least:.4g}, "
            "the part that platform 2's mass at its centre of mass already gives."
        )
    return replace(robot, platform2=replace(robot.platform2, I=inertia))
