"""How well the other runs predict one is what a fit without it says."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.sysid.estimation import Evidence, initial, root, solve
from rr_opt.sysid.intervals import covariance
from tests.sysid.linear_model import LinearModel

VALUES = {"a": 0.1, "b": 0.2}


@pytest.mark.parametrize(
    ("robust", "disturbed", "close"),
    [(False, 0.1, 1e-4), (True, 0.0, 4.0)],
    ids=["plain", "robust"],
)
def test_as_by_fitting_again(robust, disturbed, close):
    model = LinearModel(disturbed=disturbed)
    problem, states = initial(model, (), model.parameters, VALUES, [0, 1, 2])
    problem = replace(problem, q=3.0, robust=robust)
    fit = solve(problem, VALUES, states, 30, 1e-9)
    assert set(fit.predictive) == {0, 1, 2}
    for run, density in fit.predictive.items():
        others = tuple(one for one in problem.segments if one.run != run)
        again = solve(replace(problem, segments=others), VALUES, states, 30, 1e-9)
        assert again.values["a"] != pytest.approx(fit.values["a"], rel=1e-3)
        # The weights of the robust loss are kept, which a fit would change.
        assert density == pytest.approx((again.deviance - fit.deviance) / 2, abs=close)


def test_runs_with_values_of_their_own_are_as_likely_as_by_their_covariance():
    rng = np.random.default_rng(3)
    J, y = rng.normal(size=(20, 3)), rng.normal(size=20)
    sigma, none = np.array([0.5, 0.0, 2.0]), np.zeros(0)
    off = -y
    plain = Evidence(20.0, 0.0, off @ off, 1.5, J.T @ off, J.T @ J, none, none)
    wide = plain.spread(sigma)
    C = np.eye(20) + J @ np.diag(sigma**2) @ J.T
    for d in np.vstack([np.zeros(3), np.eye(3), rng.normal(size=(3, 3))]):
        left = J @ d - y
        assert wide.at(d) == pytest.approx(left @ np.linalg.solve(C, left))
    assert wide.log - plain.log == pytest.approx(np.linalg.slogdet(C)[1])


def test_a_run_that_bends_downwards_spreads_too():
    """Elimination can leave that of a run that hardly follows its model."""
    none = np.zeros(0)
    plain = Evidence(20.0, 3.0, 5.0, 1.5, np.ones(2), np.diag([-2.0, 1.0]), none, none)
    wide = plain.spread(np.array([1.0, 0.5]))
    # The rounded part counts as flat; the other is spread by half.
    assert wide.log - plain.log == pytest.approx(np.log(1.25))
    assert pytest.approx(np.diag([0.0, 1 / 1.25])) == wide.H


def test_the_root_of_what_only_bends_downwards():
    H = np.diag([-1.0, 1.25])
    assert root(H) @ root(H).T == pytest.approx(np.diag([1.0, 3.75]))


def test_a_run_is_predicted_no_better_than_machines_agree():
    model = LinearModel(true={"a": 0.3, "b": -0.4})
    problem, states = initial(model, (), model.parameters, VALUES, [0, 1, 2])
    alike, apart = (solve(replace(problem, q=1e-3), VALUES, states, 30, 1e-9) for _ in range(2))
    apart.problem.__dict__["form"] = np.array([0.0, 0.5])
    assert covariance(apart)[1, 1] > 10 * covariance(alike)[1, 1]
    # What all runs share is seen in each as well, and their spread costs each what it is.
    assert all(apart.predictive[run] < density for run, density in alike.predictive.items())
