"""The laboratory's error falls with its step, to nothing."""

import math

from rr_lab.case import record
from rr_opt.model.gait import SineGait
from tests.rr_lab.reduced import LONG, fitted


def test_first_order():
    gait = SineGait(0.9, 0.9, 0.3)
    coarse, fine = (
        fitted(LONG, gait, record(LONG, gait, 5.4, "running", step=step)).rms
        for step in (1e-3, 2.5e-4)
    )
    assert 0.85 < math.log(coarse / fine, 4) < 1.3
