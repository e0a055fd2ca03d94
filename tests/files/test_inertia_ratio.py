"""Ratios that the robot cannot be given are refused, naming the least one that it can."""

from __future__ import annotations

import pytest

from rr_opt.files.issue import InvalidFileError
from rr_opt.files.lint import lint_file
from rr_opt.files.problem_file import read_problem
from rr_opt.model.ballast import Loads, inertia_ratio, with_inertia_ratio
from rr_opt.model.problem import Interval, RatioChoice


def ratio(write, text: str) -> RatioChoice | None:
    return read_problem(write(f"inertia_ratio: {text}\n")).inertia_ratio


@pytest.mark.parametrize("text", ["0.2", "20 %", "{bounds: 0.2}", "{bounds: [0.2, 0.2]}"])
def test_a_number_fixes_it(write, text: str):
    assert ratio(write, text) == RatioChoice(Interval(0.2, 0.2))


def test_loads(write):
    choice = ratio(
        write, "{bounds: [0.5, 0.6], about: centre, by: loads, loads: {mass: 100 g, whole: true}}"
    )
    loads = Loads(mass=pytest.approx(0.1), whole=True)
    assert choice == RatioChoice(Interval(0.5, 0.6), "centre", "loads", loads)


def test_inertia_must_stay_positive(write):
    with pytest.raises(
        InvalidFileError, match=r"inertia_ratio.bounds: .* above 0\.02421"
    ) as caught:
        ratio(write, "[0.02, 0.3]")
    assert len(caught.value.issues) == 1
    assert ratio(write, "[0.025, 0.3]")
    assert ratio(write, "{bounds: [0.001, 0.3], about: centre}")


def test_loads_only_add(write):
    with pytest.raises(InvalidFileError, match=r"without loads has 0\.1113, and loads only add"):
        ratio(write, "{bounds: [0.05, 0.1], by: loads}")


def test_a_range_of_loads_begins_at_the_bare_robot(write):
    path = write("inertia_ratio: {bounds: [0.05, 0.2], by: loads}\n")
    problem = read_problem(path)
    assert problem.inertia_ratio is not None
    assert problem.inertia_ratio.bounds == Interval(inertia_ratio(problem.robot, "joint"), 0.2)
    for end in (problem.inertia_ratio.bounds.low, problem.inertia_ratio.bounds.high):
        assert with_inertia_ratio(problem.robot, end, by="loads")
    (issue,) = lint_file(path)
    assert (issue.level, issue.path) == ("warning", "inertia_ratio.bounds")
    assert "The ratios from 0.05 up to there are left out." in issue.message


def test_loads_at_the_joint_do_nothing(write):
    text = "{bounds: 0.2, by: loads, loads: {distance: 0, spread: 0}}"
    with pytest.raises(InvalidFileError, match="Read loads at the joint itself"):
        ratio(write, text)


def test_loads_that_are_not_used(write):
    (issue,) = lint_file(write("inertia_ratio: {bounds: 0.2, loads: {mass: 0.1}}\n"))
    assert (issue.level, issue.path) == ("warning", "inertia_ratio.loads")
