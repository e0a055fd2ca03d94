"""The evidence of a run, its states eliminated, is that of the whole problem solved at once."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.sysid.estimation import initial, solve
from tests.sysid.linear_model import LinearModel, stacked


@pytest.mark.parametrize("least", [0.0, 0.03])
@pytest.mark.parametrize("q", [0.1, 1.0, 30.0])
@pytest.mark.parametrize("prior", [(np.inf, 0.7), (np.inf, np.inf)], ids=["known", "unknown"])
def test_as_by_brute_force(q, prior, least):
    model = LinearModel(disturbed=0.1, prior=prior, least=least)
    values = {"a": 0.1, "b": 0.2}
    problem, states = initial(model, (), model.parameters, values, [0, 1])
    problem = replace(problem, q=q, robust=False)
    found = solve(problem, values, states, 0).linear.evidences(q)[1]
    r, J = stacked(problem, [1], states, values)
    own = J.shape[1] - 2
    X, Q = J[:, :own], J[:, own:]
    # For any change of the quantities, the states are those of least squares.
    shift, *_ = np.linalg.lstsq(X, -r, rcond=None)
    follow, *_ = np.linalg.lstsq(X, -Q, rcond=None)
    left, across = r + X @ shift, Q + X @ follow
    assert len(problem.by_run[1]) == 4
    assert found.value == pytest.approx(left @ left, rel=1e-6)
    assert found.g == pytest.approx(across.T @ left, rel=1e-6)
    assert pytest.approx(across.T @ across, rel=1e-6) == found.H
    assert found.shift == pytest.approx(shift, rel=1e-5, abs=1e-8)
    assert found.follow == pytest.approx(follow, rel=1e-5, abs=1e-8)
    for d in np.array([[0.3, -0.2], [1.0, 2.0]]):
        assert found.at(d) == pytest.approx(np.sum((left + across @ d) ** 2), rel=1e-6)
    # The states' determinant, in units of their scale, and the densities of what joins them.
    units = np.tile(model.state_scale(()), 4)
    log = np.linalg.slogdet((X * units).T @ (X * units))[1]
    log += 2 * 3 * np.sum(np.log(np.hypot(q, least / model.state_scale(()))))
    log += 2 * np.log(0.7 / 0.02) if np.isfinite(prior[1]) else 0.0
    assert found.log == pytest.approx(log, rel=1e-6)
