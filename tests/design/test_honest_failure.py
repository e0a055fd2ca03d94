"""A solver that stops short is reported as that, and never as a solution."""

import pytest

from benchmarks.optimise.problems import PROBLEMS
from rr_opt.design import multiple_shooting
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.outcome import Status


@pytest.fixture
def impatient(monkeypatch):
    monkeypatch.setitem(multiple_shooting._IPOPT, "ipopt.max_iter", 1)
    multiple_shooting.shooting.cache_clear()
    yield
    multiple_shooting.shooting.cache_clear()


@pytest.mark.usefixtures("impatient")
def test_out_of_iterations():
    optimum = maximize_speed(PROBLEMS["reference"])
    assert optimum.status is Status.NOT_CONVERGED
    assert optimum.best is None
    assert "ran out of iterations" in optimum.message
