"""Every problem of a file and of its robot is told in one go, with key path and line."""

from __future__ import annotations

import pytest

from rr_opt.files.issue import InvalidFileError
from rr_opt.files.lint import lint_file
from rr_opt.files.problem_file import read_problem
from rr_opt.outcome import EXIT_WRONG_INPUT, InputError

WRONG = """\
robot:
  platform1: {mass: 1, I: 3 s, c: .nan, a: 1, b: 2, kappa: 1, k: 1}
  platform2: [1]
  servo:
    angle_limit: 4
    torque_limit: off
  physics:
    - {name: coulomb}
    - {name: coulomb_friction, F1: -1, force1: 3, F9: 1}
  provenance: {h: guessed}
gait: {amplitude: [2, 1], period: 0, offset: [1, 2, 3], shape: square}
inertia_ratio: {about: center, by: load, loads: {whole: maybe}}
limits: 3
direction: 4
speed: 3
"""

EXPECTED = {
    ("robot.platform1.mass", 2),
    ("robot.platform1.m", 2),
    ("robot.platform1.I", 2),
    ("robot.platform1.c", 2),
    ("robot.platform1.k", 2),
    ("robot.platform2", 3),
    ("robot.servo.angle_limit", 5),
    ("robot.servo.torque_limit", 6),
    ("robot.h", 1),
    ("robot.physics[0].name", 8),
    ("robot.physics[1].F1", 9),
    ("robot.physics[1].force1", 9),
    ("robot.physics[1].F9", 9),
    ("robot.provenance.h", 10),
    ("gait.amplitude", 11),
    ("gait.period", 11),
    ("gait.offset", 11),
    ("gait.shape", 11),
    ("inertia_ratio.bounds", 12),
    ("inertia_ratio.about", 12),
    ("inertia_ratio.by", 12),
    ("inertia_ratio.loads.whole", 12),
    ("limits", 13),
    ("direction", 14),
    ("speed", 15),
}


def test_all_are_told(write):
    issues = lint_file(write(WRONG))
    assert {(issue.path, issue.line) for issue in issues} == EXPECTED
    assert len(issues) == len(EXPECTED)
    assert {issue.level for issue in issues} == {"error"}


def test_the_error_lists_them_one_a_line(write):
    path = write(WRONG)
    with pytest.raises(InvalidFileError) as caught:
        read_problem(path)
    lines = str(caught.value).splitlines()
    assert len(lines) == len(EXPECTED)
    assert all(line.startswith(f"{path}:") for line in lines)
    assert f"{path}:14: direction: Read 4. Expected one of: forward, backward, either." in lines


def test_it_is_an_input_error(write):
    with pytest.raises(InputError) as caught:
        read_problem(write(WRONG))
    assert caught.value.exit_code == EXIT_WRONG_INPUT


def test_the_issues_of_a_named_robot_carry_its_own_file(write, robot_text):
    robot = write(robot_text.replace("0.469", "-1"), "robots/mine.yaml")
    issues = lint_file(write("robot: robots/mine.yaml\nspeed: 3\n"))
    assert [(issue.file, issue.path, issue.line) for issue in issues] == [
        (str(robot), "platform1.m", 1),
        (str(robot.parent.parent / "file.yaml"), "speed", 2),
    ]
