"""How well the other runs predict one is what a fit without it says."""

from dataclasses import replace

import pytest

from rr_opt.sysid.estimation import initial, solve
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
