"""The states of one recording do not stop those of another, and come back from where they are
lost."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.sysid.estimation import initial, solve
from rr_opt.sysid.model import Linearisation, Simulation
from tests.sysid.linear_model import TRUE, LinearModel

GUESS = np.array([0.3, -0.2])
"""The linear model's."""


class Rigid(LinearModel):
    """The first recording is lost wherever its states are not as they were guessed."""

    def simulate(self, requests, effects):
        made = super().simulate(requests, effects)
        return [
            Simulation(np.full_like(one.residuals, np.nan), one.end)
            if r.segment.run == 0 and not np.array_equal(r.state, GUESS)
            else one
            for one, r in zip(made, requests, strict=True)
        ]  # fmt: skip


class Flat(LinearModel):
    """Without slopes where a state is far off."""

    def linearise(self, requests, effects, wanted):
        made = super().linearise(requests, effects, wanted)
        return [
            Linearisation(np.eye(len(one.gram)), one.end) if np.abs(r.state).max() > 50 else one
            for one, r in zip(made, requests, strict=True)
        ]


def predictions(model, begun=()):
    """Of all recordings, with the true values: the states alone are fitted."""
    model.segment_length = 9.0
    problem, states = initial(model, (), model.parameters, TRUE, range(3))
    alone = replace(problem, quantities=(), values=dict(TRUE))
    return solve(alone, TRUE, {**states, **dict(begun)})


def test_others_are_fitted_where_one_cannot_be():
    free, rigid = predictions(LinearModel()), predictions(Rigid())
    for one, state in rigid.states.items():
        expected = GUESS if one.run == 0 else free.states[one]
        assert state == pytest.approx(expected, abs=1e-6)
        assert free.states[one] != pytest.approx(GUESS, abs=0.01)


def test_states_that_went_astray_begin_anew():
    free = predictions(Flat(prior=(np.inf, np.inf)))
    lost = {one: np.array([900.0, 0.0]) for one in free.states}
    again = predictions(Flat(prior=(np.inf, np.inf)), lost)
    for one, state in free.states.items():
        assert again.states[one] == pytest.approx(state)
