"""A lag of first order is told as one, even if a fit was free to have the second."""

import pytest

from rr_opt.diagnose.explain import Chosen
from tests.diagnose.made_up import base_of, explained, search_of, with_effect


@pytest.mark.parametrize(("beta", "form"), [(0.0, 0), (3e-4, 1)])
def test_the_second_order_has_to_pay(beta, form):
    values = {"servo_lag.tau": 0.03, "servo_lag.beta": beta}
    model = with_effect(values, ("servo_lag",))
    base = base_of(model)
    second = explained(model, base, Chosen("servo_lag", 1))
    found = search_of(model, base, second)._simpler(second)
    assert found.chosen == (Chosen("servo_lag", form),)
    assert found.whole.values["servo_lag.tau"] == pytest.approx(0.03, rel=0.02)
