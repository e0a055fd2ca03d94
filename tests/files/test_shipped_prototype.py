"""Without a file the problem is the paper's prototype, and each of its values says its origin."""

from __future__ import annotations

import math
from dataclasses import fields

import pytest

from rr_opt.files.problem_file import read_problem
from rr_opt.model.problem import Interval, Limits, RatioChoice
from rr_opt.model.robot import Platform, Servo


def test_the_robot_has_table_1():
    robot = read_problem().robot
    assert (robot.platform1.m, robot.platform2.m) == (0.469, 0.250)
    assert (robot.platform1.I, robot.platform2.I) == (0.00386, 0.00175)
    assert robot.platform1.joint_to_centre == pytest.approx(0.186)
    assert robot.platform2.joint_to_centre == pytest.approx(0.0441)
    assert robot.servo == Servo(2.6, pytest.approx(math.pi), 1.37)


def test_the_wheel_friction_is_that_of_the_fit():
    robot = read_problem().robot
    assert robot.k1 == pytest.approx(0.155)
    assert robot.k2 == pytest.approx(0.155)


def test_the_problem_is_the_papers():
    problem = read_problem(None)
    assert problem.gait.amplitude == Interval(0.05, 2.6)
    assert problem.gait.period == Interval(0.3, 3.0)
    assert problem.gait.offset == Interval(0.0, 0.0)
    assert problem.inertia_ratio == RatioChoice(Interval(0.12, 0.3), "joint", "inertia")
    assert problem.limits == Limits(2.6, pytest.approx(math.pi), 1.37, 0.020)
    assert problem.direction == "either"


def test_every_value_says_its_origin():
    provenance = read_problem().robot.provenance
    platforms = {f"{p}.{f.name}" for p in ("platform1", "platform2") for f in fields(Platform)}
    servo = {f"servo.{f.name}" for f in fields(Servo)}
    assert set(provenance) == platforms | servo | {"h"}
    assumed = {key for key, told in provenance.items() if told.startswith("assumed: ")}
    assert {"platform1.a", "platform2.b", "platform1.kappa", "h", "servo.torque_limit"} <= assumed
    assert provenance["platform1.m"] == "measured: Table 1"
