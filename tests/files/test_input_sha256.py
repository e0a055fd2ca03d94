"""The fingerprint changes with every byte of the problem and of its robot, and with no path."""

from __future__ import annotations

import pytest

from rr_opt.files.issue import InvalidFileError
from rr_opt.files.problem_file import read_problem
from rr_opt.files.source import SHIPPED


def fingerprint_of(path=None):
    return read_problem(path).sha256


def test_bytes_of_both_files(write, robot_text):
    write(robot_text, "robot.yaml")
    problem = write("robot: robot.yaml\n", "problem.yaml")
    first = fingerprint_of(problem)
    assert len(first) == 64
    assert fingerprint_of(problem.parent) == first
    write(robot_text + "# a comment\n", "robot.yaml")
    second = fingerprint_of(problem)
    write("robot: robot.yaml # a comment\n", "problem.yaml")
    assert len({first, second, fingerprint_of(problem)}) == 3


def test_the_place_does_not_matter(write, robot_text):
    prints = set()
    for folder in ("one", "two"):
        write(robot_text, f"{folder}/robot.yaml")
        prints.add(fingerprint_of(write("robot: robot.yaml\n", f"{folder}/problem.yaml")))
    assert len(prints) == 1


def test_shipped():
    assert fingerprint_of() == fingerprint_of(SHIPPED) == fingerprint_of(SHIPPED / "robot.yaml")


def test_a_file_that_is_not_there():
    with pytest.raises(InvalidFileError, match="There is no such file"):
        fingerprint_of("nowhere.yaml")
