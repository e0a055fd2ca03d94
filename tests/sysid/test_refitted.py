"""A fit to more recordings begins where those that are new are as they were driven."""

from dataclasses import replace

import pytest

from rr_opt.sysid import estimation
from rr_opt.sysid.candidates import first, refitted
from tests.sysid.linear_model import LinearModel


def test_states_of_new_runs_are_fitted_before_the_values_move(monkeypatch):
    model = LinearModel()
    one = first(model, range(2))
    begun = {}

    def seen(problem, values, states, *_, **__):
        begun.update(states)
        return one.fit

    monkeypatch.setattr(estimation, "fitted", seen)
    refitted(one, range(3))
    problem, guessed = estimation.initial(model, (), model.parameters, one.fit.values, range(3))
    new = [s for s in problem.segments if s.run == 2]
    assert all(begun[s] is one.fit.states[s] for s in one.fit.states)
    held = replace(
        problem,
        segments=tuple(new),
        quantities=(),
        values=dict(one.fit.values),
        q=one.fit.problem.q,
    )
    own = estimation.solve(held, one.fit.values, {s: guessed[s] for s in new})
    for s in new:
        assert begun[s] == pytest.approx(own.states[s])
        assert begun[s] != pytest.approx(guessed[s])
