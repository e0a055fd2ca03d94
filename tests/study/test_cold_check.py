"""An optimum that is not what the neighbours let expect is checked from cold starts."""

import pytest

from rr_opt.design.study.case import Task, solve_case
from rr_opt.design.study.plan import Foothold
from rr_opt.model.gait import SineGait

# Just past the jump: forward gaits are there still, and slower than the backward ones.
PAST = "vary: {inertia_ratio: [0.1]}\n"
FORWARD = Foothold((7,), 1, SineGait(1.5, 3.0), 0.0)


def speed(row):
    assert row.optimum is not None
    return row.optimum.speed


@pytest.fixture
def problem(study_of):
    return study_of(PAST).problems[0]


def test_a_slower_branch_is_not_taken_for_the_best(problem):
    best = abs(speed(solve_case(Task(problem))))
    row = solve_case(Task(problem, (FORWARD,), (0.99 * best, 1.01 * best)))
    assert row.started == "warm and cold"
    assert speed(row) == pytest.approx(-best, rel=1e-6)
    assert row.tried == (7,)
    assert row.continued == ()


@pytest.mark.parametrize("expected", [None, (1e-3, 2e-3)])
def test_without_a_like_expectation_cold_starts_decide(problem, expected):
    assert solve_case(Task(problem, (FORWARD,), expected)).started == "warm and cold"


def test_what_is_expected_is_believed(problem):
    row = solve_case(Task(problem, (FORWARD,), (1e-3, 1.0)))
    assert row.started == "warm"
    assert speed(row) > 0
    assert row.continued == (7,)
