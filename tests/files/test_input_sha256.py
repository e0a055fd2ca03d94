"""The fingerprint changes with every byte of the problem and of its robot, and with no path."""

from __future__ import annotations

import pytest

from rr_opt.files.issue import InvalidFileError
from rr_opt.files.problem_file import input_sha256
from rr_opt.files.source import SHIPPED


def test_bytes_of_both_files(write, robot_text):
    write(robot_text, "robot.yaml")
    problem = write("robot: robot.yaml\n", "problem.yaml")
    first = input_sha256(problem)
    assert len(first) == 64
    assert input_sha256(problem.parent) == first
    write(robot_text + "# a comment\n", "robot.yaml")
    second = input_sha256(problem)
    write("robot: robot.yaml # a comment\n", "problem.yaml")
    assert len({first, second, input_sha256(problem)}) == 3


def test_the_place_does_not_matter(write, robot_text):
    prints = set()
    for folder in ("one", "two"):
        write(robot_text, f"{folder}/robot.yaml")
        prints.add(input_sha256(write("robot: robot.yaml\n", f"{folder}/problem.yaml")))
    assert len(prints) == 1


def test_shipped():
    assert input_sha256() == input_sha256(SHIPPED) == input_sha256(SHIPPED / "robot.yaml")


def test_a_file_that_is_not_there():
    with pytest.raises(InvalidFileError, match="There is no such file"):
        input_sha256("nowhere.yaml")
