"""A patch multiplies the viscous drag and the dry friction of the wheels on it, and of no others.

With all wheels on it the robot is one with so many times the friction; with none it is unchanged.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from rr_opt.model.robot import EffectUse, Robot
from tests.mechanics.cases import REPEATABLE, cases, numbers
from tests.mechanics.floor import on_floor

CIRCLE = {"x": 0.4, "y": -0.3, "radius": 1.0, "normal": 0.0, "edge_x": 9.0, "edge_y": 9.0}
EDGE = {"x": 9.0, "y": 9.0, "radius": 0.0, "normal": 2.2, "edge_x": 0.4, "edge_y": -0.3}
STRIP = {**EDGE, "width": 2.0}
INTO = np.array([math.cos(2.2), math.sin(2.2)])
HERE = np.array([0.4, -0.3])


def rolls_harder(robot: Robot, times: float) -> Robot:
    one, two = (replace(p, kappa=times * p.kappa) for p in (robot.platform1, robot.platform2))
    return replace(robot, platform1=one, platform2=two)


@pytest.mark.parametrize(
    ("values", "place", "on"),
    [
        (CIRCLE, HERE, True),
        (CIRCLE, HERE + np.array([0.0, 2.0]), False),
        (EDGE, HERE + INTO, True),
        (EDGE, HERE - INTO, False),
        (STRIP, HERE + INTO, True),
        (STRIP, HERE + 3 * INTO, False),
        (STRIP, HERE - INTO, False),
    ],
    ids=[
        "in the circle",
        "beside it",
        "beyond the edge",
        "before it",
        "on the strip",
        "behind it",
        "in front",
    ],
)
def test_drag_where_it_lies(values, place, on):
    @settings(REPEATABLE, max_examples=8)
    @given(cases(), numbers(0.0, 20.0), numbers(-7.0, 7.0))
    def drags(case, times, psi):
        robot, state = case
        use = EffectUse("floor_patch", {"multiplier": times, **values})
        there = np.array([*place, psi])
        found = on_floor(replace(robot, physics=(use,)), state, there)
        expected = on_floor(rolls_harder(robot, times) if on else robot, state, there)
        assert np.hstack(found) == pytest.approx(np.hstack(expected), rel=1e-8, abs=1e-8)

    drags()


@pytest.mark.parametrize("name", ["coulomb_friction", "stribeck_friction", "left_right_drag"])
def test_whatever_the_floor_does_to_the_wheels_is_multiplied(name):
    use = EffectUse("floor_patch", {"multiplier": 3.0, **CIRCLE})

    @settings(REPEATABLE, max_examples=8)
    @given(cases((name,)))
    def multiplied(case):
        robot, state = case
        there = np.array([*HERE, 0.7])
        frictionless = rolls_harder(replace(robot, physics=()), 0.0)
        plain, patched, none = (
            on_floor(one, state, there).torque
            for one in (robot, replace(robot, physics=(*robot.physics, use)), frictionless)
        )
        assert patched - none == pytest.approx(3 * (plain - none), rel=1e-7, abs=1e-8)

    multiplied()
