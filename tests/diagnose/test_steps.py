"""A run recorded half as often is predicted as exactly."""

import numpy as np
import pytest

from rr_opt.diagnose.model import Piece
from rr_opt.diagnose.racer import RollerRacer
from tests.diagnose.made_up import experiment

VALUES = {
    "": {},
    "servo_rate_limit": {"servo_rate_limit.rate_limit": 2.0},
    "lateral_slip": {"lateral_slip.creep_compliance": 0.01, "lateral_slip.mu": 10.0},
}


@pytest.mark.parametrize("effect", VALUES)
@pytest.mark.parametrize("rate", [25.0, 50.0])
def test_as_at_200_a_second(effect, rate):
    paths = []
    for often in (rate, 200.0):
        model = RollerRacer(experiment(seconds=8.0, rate=often))
        n = len(model.runs[1].t)
        effects = (effect,) if effect else ()
        start = np.array([0.0, 0.0, 0.3, 0.05])
        paths.append(model.respond(Piece(1, 0, n), VALUES[effect], effects, start).predicted)
    fine = paths[1][:: int(200 / rate)]
    assert paths[0] == pytest.approx(fine, abs=5e-5)
