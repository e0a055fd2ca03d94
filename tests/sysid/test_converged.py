"""A fit has converged where nothing is expected of a step; that takes no simulation to see."""

from dataclasses import replace

import pytest

from rr_opt.sysid.estimation import initial, solve
from tests.sysid.linear_model import LinearModel

BEGIN = {"a": 0.0, "b": 0.0}


class Counting(LinearModel):
    """How often segments are simulated, and linearised."""

    simulated = linearised = 0

    def simulate(self, requests, effects):
        self.simulated += 1
        return super().simulate(requests, effects)

    def linearise(self, requests, effects, wanted):
        self.linearised += 1
        return super().linearise(requests, effects, wanted)


def begun(model):
    problem, states = initial(model, (), model.parameters, BEGIN, range(3))
    return replace(problem, q=1.0), states


def test_again_from_the_solution():
    model = Counting()
    problem, states = begun(model)
    found = solve(problem, BEGIN, states)
    before = model.simulated, model.linearised
    again = solve(problem, found.values, found.states, known=found.linear)
    assert again.converged
    assert again.values == found.values
    assert (model.simulated, model.linearised) == before


def test_it_is_as_near_as_it_says():
    # With model error losses are robust, and no step ends at the optimum.
    model = Counting(disturbed=0.3)
    problem, states = begun(model)
    rough, exact = (solve(problem, BEGIN, states, 50, tolerance) for tolerance in (0.5, 1e-9))
    assert exact.deviance < rough.deviance < exact.deviance + 0.5
    # Half a nat is what a whole standard deviation in one direction would cost.
    H, _, _ = exact.information()
    off = rough.u - exact.u
    assert off @ H @ off < 1.0


def test_a_share_of_what_is_left_beyond_the_noise():
    # The noise itself counts for nothing: of a right model nothing is left, and so no share.
    problem, states = begun(Counting())
    plain = replace(problem, robust=False)
    share, exact = (solve(plain, BEGIN, states, 50, 1e-9, relative=k) for k in (0.05, 0.0))
    assert share.deviance == pytest.approx(exact.deviance, abs=1e-3)
