"""The nine speeds are those of the steady cycles that the optimiser's integrator finds."""

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.motion.steady_cycle import steady_cycle
from rr_paper.consistency import READINGS, ROWS, predicted, prototype


@pytest.mark.parametrize("reading", READINGS, ids=lambda one: one.name)
def test_speeds(reading):
    robot, amplitude = prototype(0.01, -0.01, 0.05, 0.12), 1.2
    if reading.name.endswith("66 g"):
        robot = prototype(0.0, 0.0, 0.05, 0.12)
    expected = [
        steady_cycle(
            reading.build(robot, row.ratio), SineGait(row.amplitude or amplitude, row.period)
        ).speed
        for row in ROWS
    ]
    np.testing.assert_allclose(predicted(robot, reading, amplitude), expected, rtol=1e-6)


def test_none_beyond_the_singular_posture():
    robot = prototype(0.03, -0.03, 0.05, 0.12)
    found = predicted(robot, READINGS[0], robot.singular_angle + 0.01)
    assert np.isnan(found[:3]).all()
    assert np.isfinite(found[3:]).all()
