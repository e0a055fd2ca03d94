"""Over a steady period the servo's work is what friction takes, whatever the gait's shape."""

import numpy as np
import pytest

from rr_opt.motion.dynamics import dynamics_of
from rr_opt.motion.steady_cycle import reference_cycle
from tests.motion.gaits import EVERY
from tests.robots import BENCHMARK, DRY


def integral(before, after, pieces, h):
    """Simpson's rule on each piece, from the value after a jump to the one before the next."""
    each = len(after[:-1]) // pieces
    rows = np.hstack([after[:-1].reshape(pieces, each), before[each::each, None]])
    weights = np.ones(each + 1)
    weights[1:-1:2], weights[2:-1:2] = 4, 2
    return float((rows @ weights).sum() * h / 3)


@pytest.mark.parametrize("gait", EVERY.values(), ids=EVERY)
@pytest.mark.parametrize("robot", [BENCHMARK, DRY], ids=["viscous", "dry"])
def test_work_is_dissipation(robot, gait):
    steady = reference_cycle(robot, gait, samples=2048)
    model, rate, n = dynamics_of(robot), gait.rate(steady.t), len(steady.t)
    values = np.tile(model.values(robot)[:, None], n)
    lost = np.asarray(model.energy(steady.v[None], steady.phi[None], rate[None], values)[1]).ravel()
    h = gait.period / (n - 1)
    work = integral(steady.torque_before * rate, steady.torque * rate, gait.pieces, h)
    dissipated = integral(lost, lost, gait.pieces, h)
    assert dissipated > 1e-4
    assert work == pytest.approx(dissipated, rel=1e-7)
