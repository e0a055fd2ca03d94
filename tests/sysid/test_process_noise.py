"""With next to no process noise segments are one run; with a lot of it they are independent."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.sysid import estimation
from rr_opt.sysid.estimation import fitted, initial, root, solve
from rr_opt.sysid.settings import SETTINGS
from tests.sysid.linear_model import LinearModel, stacked

VALUES = {"a": 0.1, "b": 0.2}


def estimate(problem, states):
    fit = solve(problem, VALUES, states, 30)
    return np.array([fit.values["a"], fit.values["b"]])


@pytest.fixture(scope="module")
def model():
    return LinearModel(disturbed=0.05)


def cut(model, q):
    problem, states = initial(model, (), model.parameters, VALUES, [0, 1, 2])
    return replace(problem, q=q, robust=False), states


def test_with_little_it_is_single_shooting():
    free = LinearModel(disturbed=0.05, prior=(np.inf, np.inf))
    whole = LinearModel(disturbed=0.05, prior=(np.inf, np.inf))
    whole.segment_length = 1e9
    single = estimate(*cut(whole, 1.0))
    assert estimate(*cut(free, 1e-3)) == pytest.approx(single, rel=1e-4)
    assert estimate(*cut(free, 10.0)) != pytest.approx(single, rel=1e-2)


def test_with_a_lot_segments_are_independent(model):
    problem, states = cut(model, 1e9)
    found = estimate(problem, states)
    parts = []
    for one in problem.segments:
        alone = replace(problem, segments=(one,))
        parts.append(stacked(alone, [one.run], states, VALUES))
    # Each with states of its own, which are projected out of its part.
    rows, right = [np.diag(problem.prior**0.5)], [-(problem.prior**0.5) * problem.scaled(VALUES)]
    for r, J in parts:
        X, Q = J[:, :2], J[:, 2:]
        out = np.eye(len(r)) - X @ np.linalg.pinv(X)
        rows.append(out @ Q)
        right.append(-out @ r)
    d, *_ = np.linalg.lstsq(np.vstack(rows), np.concatenate(right), rcond=None)
    expected = np.array([*VALUES.values()]) + d * problem.scale
    assert found == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize(("disturbed", "low", "high"), [(0.0, 0.0, 0.5), (0.3, 1.0, 100.0)])
def test_the_likeliest_is_none_for_a_right_model_and_some_for_a_wrong_one(disturbed, low, high):
    wrong = LinearModel(disturbed=disturbed)
    problem, states = initial(wrong, (), wrong.parameters, VALUES, [0, 1, 2])
    q = fitted(replace(problem, robust=False), VALUES, states).problem.q
    assert max(low, SETTINGS.least_process_noise) <= q <= high


def test_the_linearisation_of_a_linear_model_tells_what_less_would_give(model):
    problem, states = cut(model, 1.0)
    fit = solve(problem, VALUES, states)
    less = solve(replace(problem, q=0.3), fit.values, fit.states, known=fit.linear)
    assert fit.least(fit.linear.evidences(0.3)) == pytest.approx(less.deviance, abs=1e-3)
    assert fit.deviance != pytest.approx(less.deviance, abs=1.0)


def test_less_is_not_tried_in_vain(model, monkeypatch):
    tried = []
    monkeypatch.setattr(
        estimation, "solve", lambda one, *rest, **k: tried.append(one.q) or solve(one, *rest, **k)
    )
    problem, states = cut(model, SETTINGS.most_process_noise)
    assert fitted(problem, VALUES, states).problem.q == min(tried)


def test_machines_that_differ_anyway_have_that_much_noise_at_least():
    plain = LinearModel(disturbed=0.05)
    loose = LinearModel(disturbed=0.05, least=plain.state_scale(()))
    assert estimate(*cut(loose, 1e-6)) == pytest.approx(estimate(*cut(plain, 1.0)), rel=1e-9)
    assert estimate(*cut(loose, 1e-6)) != pytest.approx(estimate(*cut(plain, 1e-2)), rel=1e-3)


def test_the_factor_of_a_matrix_that_rounding_made_indefinite():
    Q = np.linalg.qr(np.random.default_rng(0).normal(size=(4, 4)))[0]
    sizes = np.array([1e12, 1e6, 1.0, -1e-3])
    H = Q @ np.diag(sizes) @ Q.T
    L = root(H)
    assert np.abs(L @ L.T - H).max() < 1e-5 * np.abs(H).max()
