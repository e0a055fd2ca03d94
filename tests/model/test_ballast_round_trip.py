"""A robot rebuilt for an inertia ratio has that ratio, and nothing else of it has changed."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rr_opt.model.ballast import Loads, inertia_ratio, load_count, with_inertia_ratio
from rr_opt.model.robot import Platform, Robot
from tests.mechanics.cases import REPEATABLE, numbers, robots
from tests.reference.paper import TABLE_1

ABOUT = pytest.mark.parametrize("about", ["joint", "centre"])
loads = st.builds(
    Loads, mass=numbers(0.01, 0.2), distance=numbers(-0.1, 0.15), spread=numbers(0.01, 0.1)
)


@ABOUT
@REPEATABLE
@given(robots(), numbers(1.01, 10.0))
def test_by_inertia(about, robot, factor):
    bare = replace(robot, platform2=replace(robot.platform2, I=1e-9))
    ratio = factor * inertia_ratio(bare, about)
    rebuilt = with_inertia_ratio(robot, ratio, about, "inertia")
    assert inertia_ratio(rebuilt, about) == pytest.approx(ratio, rel=1e-12)
    assert replace(rebuilt, platform2=replace(rebuilt.platform2, I=robot.platform2.I)) == robot


@ABOUT
@REPEATABLE
@given(robots(), numbers(1.0, 10.0), loads)
def test_by_loads(about, robot, factor, loads):
    ratio = factor * inertia_ratio(robot, about)
    rebuilt = with_inertia_ratio(robot, ratio, about, "loads", loads)
    assert inertia_ratio(rebuilt, about) == pytest.approx(ratio, rel=1e-9)
    old, new = robot.platform2, rebuilt.platform2
    assert (new.m, new.I) >= (old.m, old.I)
    without = replace(new, m=old.m, I=old.I, a=old.a)
    assert replace(rebuilt, platform2=without) == robot


@ABOUT
@REPEATABLE
@given(robots(), numbers(0.0, 20.0), loads)
def test_count_of_loads_comes_back(about, robot, count, loads):
    from_joint = robot.platform2.joint_to_centre
    own = robot.platform2
    # Hung by hand: what each load adds to the second moment about P, then moved to the centre.
    added = count * loads.mass
    about_joint = own.I + own.m * from_joint**2 + added * (loads.distance**2 + loads.spread**2)
    centre = (own.m * from_joint + added * loads.distance) / (own.m + added)
    inertia = about_joint - (own.m + added) * centre**2
    one = robot.platform1
    ratio = {
        "joint": about_joint / (one.I + one.m * (one.c - one.a) ** 2),
        "centre": inertia / one.I,
    }[about]
    assert load_count(robot, ratio, about, loads) == pytest.approx(count, rel=1e-7, abs=1e-9)


def test_table_1_gives_the_papers_ratios_about_the_joint_only():
    (m1, _), (m2, _) = TABLE_1["m1"], TABLE_1["m2"]
    (I1, _), (I2, _) = TABLE_1["I10"], TABLE_1["I20"]
    (g1, _), (g2, _) = TABLE_1["c1 - a1"], TABLE_1["c2 - a2"]
    one = Platform(m1, I1, c=g1 + 0.02, a=0.02, b=0.05, kappa=2e-5)
    two = Platform(m2, I2, c=g2 + 0.02, a=0.02, b=0.05, kappa=2e-5)
    robot = Robot(one, two, h=0.02)
    assert inertia_ratio(robot, "joint") == pytest.approx(0.1113, abs=5e-5)
    assert inertia_ratio(robot, "centre") == pytest.approx(0.4534, abs=5e-5)
    # The first series begins at 0.08, which even about the joint no number of loads gives.
    assert load_count(robot, 0.08, "joint", Loads()) < 0
    assert math.isfinite(load_count(robot, 0.3, "joint", Loads()))
