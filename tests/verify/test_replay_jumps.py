"""A replay sees the torque on both sides of each jump of a free gait's acceleration."""

import numpy as np
import pytest

from rr_opt.model.problem import Limits
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.motion.integrators import cvodes
from rr_opt.verify.replay import replay
from tests.motion.gaits import free_gait
from tests.robots import BENCHMARK

LIMITS = Limits(angle=2.6, rate=10.0, torque=5.0)


def peak_torque(gait, v0, each=200):
    """By the definition: every piece with the acceleration that it has, its ends included."""
    t = np.linspace(0, gait.period, each * gait.pieces + 1)
    v, model = cvodes(BENCHMARK, gait, v0, t)[0], dynamics_of(BENCHMARK)
    p = model.values(BENCHMARK)
    return max(
        abs(float(model.motion(v[i], gait.angle(t[i]), gait.rate(t[i]), u, p)[3]))
        for k, u in enumerate(gait.accelerations)
        for i in range(k * each, (k + 1) * each + 1, 20)
    )


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("backward", [False, True], ids=["forward", "backward"])
def test_peak(seed, backward):
    u = np.random.default_rng(seed).uniform(-20, 20, 16)
    # Turned round in time, what was just before a jump comes just after it.
    gait = free_gait(1.4, -0.2, u[::-1] if backward else u)
    found = replay(BENCHMARK, gait, LIMITS, 0.1)
    expected = peak_torque(gait, found.steady.v[0])
    assert found.reached["torque"] == pytest.approx(expected, rel=1e-3)
    assert found.reached["torque"] >= expected * (1 - 1e-9)
    assert found.reached["rate"] == pytest.approx(gait.peak_rate, rel=1e-9)
    assert found.reached["angle"] == pytest.approx(gait.peak_angle, rel=1e-5)
