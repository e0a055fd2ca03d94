"""A problem file becomes the problem it describes; what it does not say has its default."""

from __future__ import annotations

import math

import pytest

from rr_opt.files.lint import lint_file
from rr_opt.files.problem_file import read_problem
from rr_opt.model.problem import GaitBounds, Interval, Limits
from rr_opt.model.robot import Servo


def test_defaults(write):
    problem = read_problem(write("direction: backward\n"))
    assert problem.gait == GaitBounds()
    assert problem.inertia_ratio is None
    assert problem.limits == Limits(2.6, math.pi, 1.37, 0.020)
    assert problem.direction == "backward"
    assert problem.robot == read_problem().robot


def test_a_number_fixes_and_a_pair_bounds(write):
    gait = read_problem(
        write("gait: {shape: sine, amplitude: 30 deg, period: [300 ms, 1], offset: [-0.1, 0.1]}")
    ).gait
    assert gait.amplitude.fixed
    assert gait.amplitude.low == pytest.approx(math.pi / 6)
    assert gait.period == Interval(pytest.approx(0.3), 1.0)
    assert gait.offset == Interval(-0.1, 0.1)


@pytest.mark.parametrize(
    ("text", "bounds"),
    [
        ("{shape: sine}", GaitBounds()),
        ("{shape: fourier}", GaitBounds(shape="fourier", harmonics=3)),
        ("{shape: fourier, harmonics: 16}", GaitBounds(shape="fourier", harmonics=16)),
        ("{shape: free}", GaitBounds(shape="free", intervals=96)),
        ("{shape: free, intervals: 16}", GaitBounds(shape="free", intervals=16)),
    ],
)
def test_a_shape_and_its_fineness(write, text: str, bounds: GaitBounds):
    assert read_problem(write(f"gait: {text}")).gait == bounds


def test_limits_come_from_the_robots_servo_one_by_one(write, robot_text):
    servo = "servo: {angle_limit: 1.5, rate_limit: 4, torque_limit: .inf}\n"
    write(robot_text + servo, "robots/own.yaml")
    text = "robot: robots/own.yaml\nlimits: {rate: 3, singularity: 10 mm}\n"
    problem = read_problem(write(text))
    assert problem.robot.servo == Servo(1.5, 4.0, math.inf)
    assert problem.limits == Limits(1.5, 3.0, math.inf, 0.010)


def test_limits_beyond_the_servo_are_warned_about(write):
    issues = lint_file(write("limits: {angle: 3, rate: .inf, torque: 1}\n"))
    assert [(issue.level, issue.path) for issue in issues] == [
        ("warning", "limits.angle"),
        ("warning", "limits.rate"),
    ]
    assert "Read 3, more than the robot's servo can do, 2.6 rad." in issues[0].message


def test_amplitudes_that_are_surely_degrees_are_warned_about(write):
    (issue,) = lint_file(write("gait: {amplitude: [5, 70]}\n"))
    assert (issue.level, issue.path) == ("warning", "gait.amplitude")
    assert "degrees need their unit, as in `5 deg`" in issue.message
    assert not lint_file(write("gait: {amplitude: [5 deg, 70 deg]}\n"))


def test_the_robot_may_stand_in_the_file(write, robot_text):
    inline = "robot:\n" + "".join(f"  {line}\n" for line in robot_text.splitlines())
    assert read_problem(write(inline)).robot.platform2.c == 0.0641


def test_a_folder_stands_for_its_problem(write, tmp_path):
    write("direction: forward\n", "problem.yaml")
    assert read_problem(tmp_path).direction == "forward"
    assert read_problem(str(tmp_path)) == read_problem(tmp_path / "problem.yaml")


def test_a_robot_file_stands_for_the_shipped_problem_with_it(write, robot_text):
    path = write(robot_text + "servo: {rate_limit: 2}\n")
    problem, shipped = read_problem(path), read_problem()
    assert problem.robot.platform1.a == 0.020
    assert problem.limits == Limits(2.6, 2.0, 1.37, shipped.limits.singularity)
    assert problem.gait == shipped.gait
    # As it is: nobody asked for another inertia.
    assert problem.inertia_ratio is None
