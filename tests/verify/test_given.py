"""The sweep's model gives gaits of every shape the speed that cvodes gives them."""

from __future__ import annotations

import numpy as np
import pytest

from rr_opt.model.gait import FourierGait, FreeGait, Gait
from rr_opt.motion.steady_cycle import reference_cycle
from rr_opt.verify.speeds import speed_of
from tests.robots import BENCHMARK, DRY

FOURIER = FourierGait(1.3, 0.1, (0.6, 0.1, -0.05), (0.0, 0.05, 0.02))


def free() -> FreeGait:
    """Up, then down, with a pause: jumps of the acceleration."""
    u = np.repeat([12.0, 0.0, -12.0, 0.0, -12.0, 0.0, 12.0, 0.0], 3)
    h = 1.2 / len(u)
    rates = np.concatenate([[0.0], np.cumsum(h * u)])
    drift = (rates[:-1] + h * u / 2).mean()
    return FreeGait(1.2, -0.5, float(-drift), tuple(u))


@pytest.mark.parametrize(
    ("gait", "close"), [(FOURIER, 1e-8), (free(), 1e-6)], ids=["fourier", "free"]
)
@pytest.mark.parametrize("robot", [BENCHMARK, DRY], ids=["viscous", "dry"])
def test_speed(robot, gait: Gait, close: float) -> None:
    if robot is DRY and gait.shape == "free":
        pytest.skip("the tail of both jumps together is not what is extrapolated")
    reference = reference_cycle(robot, gait)
    found, _ = speed_of(robot, gait)
    assert found == pytest.approx(reference.speed, rel=close)
