"""Every effect of every machine is nothing at 0, and something at its usual size."""

import numpy as np
import pytest

from rr_opt.machines.registry import MACHINES, machine_named
from rr_opt.sysid.model import Request, Segment
from tests.machines.test_prediction import CASES, T, model

EVERY = [(name, one.name) for name in MACHINES for one in machine_named(name).effects]


@pytest.mark.parametrize(("name", "effect"), EVERY)
def test_neutral(name, effect):
    nominal, inputs, start, _, _ = CASES[name]
    one = model(name, nominal, inputs)
    whole = Segment(0, 0, T.size, T.size - 1)
    plain = one.predicted(Request(whole, {}, start), ())
    none = one.predicted(Request(whole, {}, start), (effect,))
    assert none == pytest.approx(plain, abs=1e-9)
    quantities = one.catalogue[effect].forms[0].quantities
    # Nothing moves in what was recorded, so the usual drag is huge.
    small = {q.name: 0.01 * q.scale for q in quantities}
    moved = one.predicted(Request(whole, small, start), (effect,))
    assert np.abs(moved - plain).max() > 1e-7
