"""Values that are possible and probably not meant are warned about, and can be used."""

from __future__ import annotations

import pytest

from rr_opt.files.lint import lint_file
from rr_opt.files.robot_file import read_robot

DOUBTS = {
    ("a: 0.020", "a: 0.300"): ("platform1.a", "puts the centre of mass beyond the joint"),
    ("I: 0.00386", "I: 3.86"): ("platform1.I", "more than three times the platform's largest"),
    ("c: 0.206", "c: 206"): ("platform1.c", "Plain numbers are metres: write `206 mm`"),
    ("h: 0.020", "h: 20"): (
        "h",
        "The wheel radius is 20 m, larger than any length of the platforms",
    ),
    ("m: 0.469", "m: 469"): ("platform1.m", "Plain numbers are kilograms: write `469 g`"),
}


@pytest.mark.parametrize(("change", "told"), DOUBTS.items())
def test_doubts(write, robot_text, change: tuple[str, str], told: tuple[str, str]):
    path = write(robot_text.replace(*change, 1))
    found = {issue.path: issue for issue in lint_file(path)}
    assert told[1] in found[told[0]].message
    assert {issue.level for issue in found.values()} == {"warning"}
    assert read_robot(path)


def test_platforms_that_do_not_belong_together(write, robot_text):
    path = write(robot_text.replace("0.469", "469").replace("0.00386", "3.86"))
    (issue,) = [issue for issue in lint_file(path) if issue.path == "platform2.I"]
    assert "J20/J10 about the joint is 0.000" in issue.message


def test_a_singular_posture_within_reach_of_the_servo(write, robot_text):
    (issue,) = lint_file(write(robot_text))
    assert (issue.level, issue.path) == ("warning", "servo.angle_limit")
    assert "2.6 rad, includes the singular posture |phi| = arccos(-c2/c1) = 1.887" in issue.message
    assert lint_file(write(robot_text + "servo: {angle_limit: 1.88}\n")) == []


def test_a_problem_keeps_its_own_distance_from_it(write, robot_text):
    write(robot_text, "robot.yaml")
    assert lint_file(write("robot: robot.yaml\n")) == []
