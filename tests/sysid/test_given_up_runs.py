"""A fit that gives up a run to explain others is begun again from the fit of its part."""

import pytest

from rr_opt.sysid import selection as module
from rr_opt.sysid.candidates import Candidate, first, fitted
from rr_opt.sysid.estimation import solve
from rr_opt.sysid.model import Choice
from rr_opt.sysid.selection import Selection
from tests.sysid.made_up import with_effect

TILT, DRAG = Choice("floor_tilt"), Choice("quadratic_drag")


@pytest.fixture(scope="module")
def begun():
    hidden = {"floor_tilt.tilt_x": 0.004, "floor_tilt.tilt_y": 0.002}
    model = with_effect(hidden, ("floor_tilt",))
    selection = Selection(model, first(model, range(len(model.runs))))
    selection.fitted((TILT,), [{}])
    return selection


def test_begun_again(begun, monkeypatch):
    ended = []

    def astray(*given) -> Candidate:
        made = fitted(*given)
        ended.append(made)
        values = {**made.fit.values, "floor_tilt.tilt_x": -0.03}
        return Candidate(made.choices, solve(made.fit.problem, values, made.fit.states, 0))

    monkeypatch.setattr(module, "fitted", astray)
    pair = begun.fitted((TILT, DRAG), [{}])
    assert pair.fit.deviance == pytest.approx(ended[0].fit.deviance, abs=0.5)
    assert not pair.sacrifices(begun.tried[(TILT,)])


def test_no_second_fit_where_no_run_is_given_up(begun, monkeypatch):
    monkeypatch.setattr(module, "continued", lambda *_: pytest.fail("It is begun again."))
    begun.fitted((TILT, Choice("marker_offset")), [{}])
