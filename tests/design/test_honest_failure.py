"""A solver that stops short is reported as that, and never as a solution."""

from benchmarks.optimise.problems import PROBLEMS
from rr_opt import sqp
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.outcome import Status


def test_out_of_iterations(monkeypatch):
    monkeypatch.setattr(sqp, "_ITERATIONS", 1)
    optimum = maximize_speed(PROBLEMS["low_friction_torque"])
    assert optimum.status is Status.NOT_CONVERGED
    assert optimum.best is None
    assert "stopped short" in optimum.message
