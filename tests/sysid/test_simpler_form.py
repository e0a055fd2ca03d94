"""What needs less is told, even if a fit was free to have more."""

import pytest

from rr_opt.sysid.candidate import Chosen
from tests.sysid.made_up import base_of, explained, search_of, with_effect


@pytest.mark.parametrize(("beta", "form"), [(0.0, 0), (3e-4, 1)])
def test_the_second_order_has_to_pay(beta, form):
    values = {"servo_lag.tau": 0.03, "servo_lag.beta": beta}
    model = with_effect(values, ("servo_lag",))
    base = base_of(model)
    second = explained(model, base, Chosen("servo_lag", 1))
    found = search_of(model, base, second)._simpler(second)
    assert found.chosen == (Chosen("servo_lag", form),)
    assert found.whole.values["servo_lag.tau"] == pytest.approx(0.03, rel=0.02)


@pytest.mark.parametrize(
    ("effect", "values"),
    [("clock_offset", {"offset": -0.03}), ("servo_lag", {"tau": 0.03, "beta": 2e-5})],
)
def test_a_lag_that_leaves_the_swing_as_it_is_may_be_a_late_clock(effect, values):
    model = with_effect({f"{effect}.{name}": value for name, value in values.items()}, (effect,))
    base = base_of(model)
    for form in (0, 1):
        lag = explained(model, base, Chosen("servo_lag", form))
        search = search_of(model, base, lag)
        assert search._imitated(lag).names == (effect,)
        assert {("servo_lag",), ("clock_offset",)} <= {one.names for one in search.tried}
