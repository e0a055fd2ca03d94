"""Intervals cover the truth as often as they say, and know on what models do not agree."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rr_opt.sysid import intervals
from rr_opt.sysid.candidates import Candidate
from rr_opt.sysid.estimation import fitted, initial
from rr_opt.sysid.intervals import estimates, instead_of, released, wrong
from rr_opt.sysid.settings import SETTINGS
from rr_opt.sysid.verdict import Identification
from tests.sysid.linear_model import LinearModel

FIRST = {"a": 0.0, "b": 0.0}


def fit_of(seed, true, disturbed=0.0, runs=6):
    model = LinearModel(seed, runs, true, disturbed, prior=(np.inf, np.inf))
    problem, states = initial(model, (), model.parameters, FIRST, range(runs))
    return fitted(problem, FIRST, states)


@pytest.mark.parametrize(
    ("disturbed", "least"), [(0.0, 0.88), (0.1, 0.8)], ids=["right model", "wrong model"]
)
def test_they_cover(disturbed, least):
    covered = []
    for seed in range(20):
        rng = np.random.default_rng(1000 + seed)
        true = {"a": 0.5 * rng.normal(), "b": 2.0 * rng.normal()}
        found = estimates(fit_of(seed, true, disturbed))
        covered += [found[name].low <= value <= found[name].high for name, value in true.items()]
    assert least <= np.mean(covered) <= 0.995


def test_wider_by_what_models_of_an_effect_do_not_agree_on():
    fit = fit_of(0, {"a": 0.3, "b": 1.5})
    plain = estimates(fit)
    share = 0.1
    first, second = fit.problem.quantities
    doubtful = replace(fit.problem, quantities=(first, replace(second, form_error=share)))
    wider = estimates(replace(fit, problem=doubtful))
    half = (plain["b"].high - plain["b"].low) / 2
    assert (wider["b"].high - wider["b"].low) / 2 == pytest.approx(
        math.hypot(half, 1.96 * share * fit.values["b"]), rel=1e-3
    )
    assert wider["a"] == plain["a"]


def test_they_cover_what_recordings_that_were_not_fitted_call_for():
    model, other = (LinearModel(0, 6, {"a": a, "b": 1.0}) for a in (0.3, 0.6))
    model.runs = [*model.runs[:4], *other.runs[4:]]

    def candidate(runs):
        problem, states = initial(model, (), model.parameters, FIRST, runs)
        return Candidate((), fitted(problem, FIRST, states))

    best, everywhere = candidate(range(4)), candidate(range(6))
    result: Any = SimpleNamespace(best=best, everywhere=everywhere)
    found = Identification.estimates.func(result)["a"]
    alone, all_of_them = estimates(best.fit)["a"], everywhere.simulated.values["a"]
    assert found.value == alone.value
    assert alone.low <= 0.3 <= alone.high < all_of_them < found.high
    assert found.low == alone.low


def test_where_nothing_was_fitted_there_is_no_interval():
    model = LinearModel()
    problem, states = initial(model, (), (), FIRST, [0])
    assert estimates(fitted(problem, FIRST, states)) == {}


EXCUSES = {
    "at once": {(): (3.5, 3.4), ("a",): (1.9, 4.2), ("b",): (2.7, 5.2)},
    "later": {(): (3.5, 3.4), ("a",): (3.6, 4.2), ("a", "b"): (0.9, 4.1), ("b",): (2.7, 5.2)},
}
"""Surprises of a and b by which of them are released; b is wrong, and a is nearly as good."""


@pytest.mark.parametrize("script", EXCUSES.values(), ids=EXCUSES)
def test_a_value_is_not_wrong_because_another_was_released_first(monkeypatch, script):
    model = LinearModel()
    stated = tuple(replace(q, known=True) for q in model.parameters)
    problem, states = initial(model, (), stated, FIRST, range(3))
    fit = fitted(problem, FIRST, states)

    def scripted(one):
        return np.array(script[tuple(q.name for q in one.problem.quantities if q.free)])

    monkeypatch.setattr(intervals, "surprises", scripted)
    assert [q.name for q in wrong(released(fit))] == ["b"]


class Mixed(LinearModel):
    """b moves the states as a does, to a share."""

    share = 0.0

    def _maps(self, segment):
        by_state, by_values = super()._maps(segment)
        a, b = np.moveaxis(by_values, 2, 0)
        return by_state, np.stack([a, self.share * a + (1 - self.share) * b], axis=2)


def mixed(share):
    """The problem of a model in which a is wrong, and initial states."""
    model = Mixed(true={"a": 4.0, "b": 0.0}, prior=(np.inf, np.inf))
    model.share = share
    return initial(model, (), model.parameters, FIRST, range(3))


@pytest.mark.parametrize("share", [0.0, 0.5, 0.9, 0.99, 1.0])
def test_a_value_that_explains_as_much_is_told_beside_the_wrong_one(share):
    """As refits say, in which the one is held and the other is not."""
    problem, states = mixed(share)
    a, b = problem.quantities
    free_a, free_b = (replace(q, scale=SETTINGS.effect_prior * q.scale, free=True) for q in (a, b))
    own = fitted(replace(problem, quantities=(free_a, b)), FIRST, states)
    other = fitted(replace(problem, quantities=(a, free_b)), FIRST, states)
    apart = other.deviance - own.deviance
    assert abs(apart - 2 * SETTINGS.evidence) > 1.0
    assert instead_of(own, "a") == (("b",) if apart < 2 * SETTINGS.evidence else ())


def test_a_value_that_was_not_released_has_no_other():
    problem, states = mixed(1.0)
    assert instead_of(fitted(problem, FIRST, states), "a") == ()
