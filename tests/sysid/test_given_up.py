"""A fit that would not reach what is of interest at its pace is given up; others are not."""

import pytest

from rr_opt.sysid.estimation import initial, solve
from tests.sysid.linear_model import TRUE, LinearModel

FAR = {"a": 9.0, "b": 9.0}
"""Several steps away."""


def fit(enough):
    model = LinearModel()
    problem, states = initial(model, (), model.parameters, FAR, range(3))
    return solve(problem, FAR, states, 30, 1e-9, enough)


def test_out_of_reach():
    whole, given_up = fit(float("inf")), fit(-1e9)
    assert whole.converged
    assert whole.values["a"] == pytest.approx(TRUE["a"], abs=0.1)
    assert not given_up.converged
    assert given_up.deviance > whole.deviance + 10


def test_within_reach():
    whole = fit(float("inf"))
    assert fit(whole.deviance - 1e-3).deviance == pytest.approx(whole.deviance, abs=1e-6)
