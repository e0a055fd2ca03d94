"""The planar engine's error falls with the square of its step, whatever is hidden."""

import math

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from tests.rr_lab.planar.driven import channels, driven
from tests.rr_lab.reduced import LONG

GAIT = SineGait(0.6, 1.0, 0.2)
USES = (
    (),
    (("coulomb_friction", {"force1": 0.02, "force2": 0.03}),),
    (("lateral_slip", {"mu": 0.02}),),
    (("compliant_platform", {"give": 0.3}),),
    (("servo_lag", {"tau": 0.05}),),
)


@pytest.mark.parametrize("uses", USES, ids=lambda uses: uses[0][0] if uses else "nothing")
def test_second_order(uses):
    # From rest, so that nothing is left of a start that was computed more coarsely.
    finest, fine, coarse = (
        channels(driven(LONG, GAIT, 2.0, "rest", *uses, step=step))
        for step in (6.25e-5, 5e-4, 1e-3)
    )
    worst = [np.abs(one - finest).max() for one in (fine, coarse)]
    assert 1.5 < math.log2(worst[1] / worst[0]) < 2.6
    assert worst[0] < 1e-4
