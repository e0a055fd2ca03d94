"""A robot file becomes the robot it describes."""

from __future__ import annotations

import math

import pytest

from rr_opt.files.lint import lint_file
from rr_opt.files.robot_file import read_robot
from rr_opt.model.robot import Platform, Robot, Servo


def test_plain_numbers(write, robot_text):
    assert read_robot(write(robot_text)) == Robot(
        Platform(0.469, 0.00386, 0.206, 0.020, 0.050, 2.0e-5),
        Platform(0.250, 0.00175, 0.0641, 0.020, 0.050, 2.0e-5),
        h=0.020,
        servo=Servo(),
    )


def test_units(write, robot_text):
    with_units = (
        robot_text.replace("0.469", "469 g")
        .replace("0.206", "206 mm")
        .replace("kappa: 2.0e-5", "k: 0.05 N*s/m")
        .replace("h: 0.020", "h: 2 cm")
    )
    plain, united = read_robot(write(robot_text)), read_robot(write(with_units))
    assert united.platform1.m == pytest.approx(plain.platform1.m)
    assert united.platform1.c == pytest.approx(plain.platform1.c)
    assert united.platform1.kappa == pytest.approx(plain.platform1.kappa)
    assert united.h == pytest.approx(plain.h)


def test_the_servo_is_optional_key_by_key(write, robot_text):
    servo = read_robot(write(robot_text + "servo: {torque_limit: .inf}\nname: Ada\n")).servo
    assert servo == Servo(torque_limit=math.inf)


def test_the_centre_of_mass_may_lie_behind_the_axle(write, robot_text):
    assert read_robot(write(robot_text.replace("a: 0.020", "a: -5 mm", 1))).platform1.a == -0.005


@pytest.mark.parametrize("key", ["m", "I", "c", "b"])
@pytest.mark.parametrize("value", ["0", "-1", ".inf"])
def test_what_must_be_positive(write, robot_text, key: str, value: str):
    first, rest = robot_text.split("\n", 1)
    start = first.index(f"{key}: ") + len(key) + 2
    end = first.index(",", start)
    (issue,) = lint_file(write(f"{first[:start]}{value}{first[end:]}\n{rest}"))
    assert (issue.level, issue.path) == ("error", f"platform1.{key}")
    assert "above 0" in issue.message


@pytest.mark.parametrize("limit", ["3.15", "180 deg", "-1", ".inf"])
def test_the_angle_limit_is_below_half_a_turn(write, robot_text, limit: str):
    (issue,) = lint_file(write(f"{robot_text}servo: {{angle_limit: {limit}}}\n"))
    assert issue.path == "servo.angle_limit"
    assert "below 3.14159" in issue.message


@pytest.mark.parametrize("text", ["root: secret\nuser: secret\n", "root:secret\nuser:secret\n"])
def test_a_file_that_is_none_of_ours_is_not_quoted(write, text):
    write(text, "passwords")
    (issue,) = lint_file(write("robot: passwords\n", "problem.yaml"))
    assert "Expected" in issue.message
    assert "secret" not in str(issue)
    assert "user" not in str(issue)
