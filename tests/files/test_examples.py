"""The example problems and the shipped one have no issue at all."""

from __future__ import annotations

from pathlib import Path

import pytest

from rr_opt.files.lint import lint_file
from rr_opt.files.problem_file import read_problem
from rr_opt.files.source import SHIPPED

PROBLEMS = Path(__file__).parents[2] / "problems"
EXAMPLES = [SHIPPED, PROBLEMS / "turning", PROBLEMS / "loads"]


@pytest.mark.parametrize("folder", EXAMPLES, ids=lambda folder: folder.name)
def test_example(folder: Path):
    assert lint_file(folder) == []
    assert read_problem(folder)


def test_they_are_of_different_kinds():
    turning, loads = read_problem(PROBLEMS / "turning"), read_problem(PROBLEMS / "loads")
    assert turning.gait.offset.low > 0
    assert turning.inertia_ratio is None
    assert loads.inertia_ratio is not None
    assert loads.inertia_ratio.loads.whole
    assert loads.robot == read_problem().robot
