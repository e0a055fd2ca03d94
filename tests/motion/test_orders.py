"""Each fixed-step method converges with the order its tableau claims, on the robot's equation."""

import numpy as np
import pytest

from rr_opt.mechanics.runge_kutta import BUTCHER6, RK4
from rr_opt.model.gait import SineGait
from rr_opt.motion.integrators import cvodes, fixed_steps
from tests.robots import BENCHMARK

GAIT = SineGait(0.7, 1.4, 0.2)


def end(steps, method):
    return fixed_steps(BENCHMARK, GAIT, 0.1, steps=steps, method=method)[:, -1]


@pytest.mark.parametrize(("method", "steps"), [(RK4, 96), (BUTCHER6, 48)])
def test_slope(method, steps):
    truth = end(3000, BUTCHER6)
    errors = [np.abs(end(n, method) - truth).max() for n in (steps, 2 * steps)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(method.order, abs=0.1)


def test_truth_is_cvodes():
    reference = cvodes(BENCHMARK, GAIT, 0.1, np.array([0.0, GAIT.period]))[:, -1]
    np.testing.assert_allclose(end(3000, BUTCHER6), reference, atol=1e-9)
