"""A model that cannot be simulated or linearised everywhere is fitted where it can."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rr_opt.sysid.candidates import Candidate, fitted
from rr_opt.sysid.estimation import initial, solve
from rr_opt.sysid.model import Linearisation, Simulation
from tests.sysid.linear_model import TRUE, LinearModel

BEGIN = {"a": 0.1, "b": 0.2}


class Edged(LinearModel):
    """Without a simulation, or without derivatives, where a is more than an edge."""

    def __init__(self, simulated: float = math.inf, linearised: float = math.inf) -> None:
        super().__init__()
        self._simulated, self._linearised = simulated, linearised

    def simulate(self, requests, effects):
        made = super().simulate(requests, effects)
        return [
            Simulation(one.residuals, np.full(2, np.nan))
            if r.values["a"] > self._simulated
            else one
            for one, r in zip(made, requests, strict=True)
        ]

    def linearise(self, requests, effects, wanted):
        made = super().linearise(requests, effects, wanted)
        return [
            Linearisation(np.full_like(one.gram, np.nan), one.end)
            if r.values["a"] > self._linearised
            else one
            for one, r in zip(made, requests, strict=True)
        ]


def fit(model, values):
    problem, states = initial(model, (), model.parameters, values, range(3))
    return solve(replace(problem, q=1.0), values, states, 30)


@pytest.mark.parametrize("edge", ["simulated", "linearised"])
def test_a_fit_stops_short_of_the_edge(edge):
    assert fit(Edged(), BEGIN).values["a"] > 0.25
    found = fit(Edged(**{edge: 0.2}), BEGIN)
    assert math.isfinite(found.deviance)
    assert found.values["a"] <= 0.2


@pytest.mark.parametrize("edge", ["simulated", "linearised"])
def test_a_fit_that_begins_beyond_it_comes_back(edge):
    model = Edged(**{edge: 3.0})
    assert fit(model, {"a": 4.0, "b": 0.2}).values["a"] == pytest.approx(TRUE["a"], abs=0.1)


def test_a_candidate_that_never_can_be_is_given_up():
    model = Edged()
    parent = fit(model, BEGIN)
    model._linearised = -math.inf
    found = fitted(model, (), parent, [{}])
    assert found.given_up
    assert not found.predicts_better(Candidate((), parent))
    assert found.elpd == -math.inf
    assert Candidate((), parent).predicts_better(found)
