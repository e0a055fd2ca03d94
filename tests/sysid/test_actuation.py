"""The joint's recorded angle tells which effect of the drive made it, in its fullest form too."""

import pytest

from rr_opt.machines.racer.actuation import actuation_sets
from tests.sysid.made_up import with_effect

SECOND_ORDER = {"servo_lag.tau": 0.009, "servo_lag.beta": 2.5e-5}
"""A late clock is like it to within little."""


def test_lag_of_second_order_beside_a_late_clock():
    model = with_effect(SECOND_ORDER, ("servo_lag",))
    (choices, values), *_ = actuation_sets(model, range(len(model.runs)))
    assert [one.name for one in choices] == ["servo_lag"]
    assert values["servo_lag.tau"] == pytest.approx(0.009, rel=0.02)
    assert values["servo_lag.beta"] == pytest.approx(2.5e-5, rel=0.5)
