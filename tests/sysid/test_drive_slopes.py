"""A run's derivatives by the servo's faults and the clock are right to six per cent.

Held against differences of whole predictions, from rest and running, where dphi jumps as well.
"""

import numpy as np
import pytest

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.model.experiment import CHANNELS, Experiment, Noise, Recording, Run, Uncertainty
from rr_opt.model.gait import SineGait
from rr_opt.sysid.model import Piece
from tests.robots import BENCHMARK

GAIT = SineGait(0.6, 1.0, 0.1)
NOISE = Noise(1e-3, 3e-3)
FAULTS = {
    "servo_rate_limit.rate_limit": (0.7 * GAIT.peak_rate, 3e-3),
    "servo_backlash.width": (0.02, 2e-4),
    "servo_lag.tau": (0.03, 1e-4),
    "servo_offset.offset": (0.01, 1e-4),
    "clock_offset.offset": (0.01, 1e-4),
}


def racer(start) -> RollerRacer:
    t = np.linspace(0.0, 3.0, 301)
    still = {name: np.zeros(t.size) for name in CHANNELS}
    sigma = {name: np.full(t.size, NOISE.of(name)) for name in CHANNELS}
    flags = {name: np.zeros(t.size, np.uint8) for name in CHANNELS}
    run = Run(Recording("run", t, still, sigma, flags), GAIT, "fit", start)
    return RollerRacer(Experiment(BENCHMARK, NOISE, {"m1": Uncertainty(0.01)}, (run,), "made up"))


@pytest.mark.parametrize("start", ["rest", "running"])
@pytest.mark.parametrize("name", FAULTS)
def test_against_differences(name, start):
    model, effects, (value, step) = racer(start), (name.split(".")[0],), FAULTS[name]
    piece, begin = Piece(0, 0, 301), np.array([0.0, 0.0, 0.3, 0.05])
    found = model.respond(piece, {name: value}, effects, begin, (name,)).by_value[:, :, 0]
    up, down = (
        model.respond(piece, {name: value + way * step}, effects, begin).predicted
        for way in (1, -1)
    )
    expected = (up - down) / (2 * step)
    size = np.sqrt(np.mean(expected**2, axis=0))
    off = np.sqrt(np.mean((found - expected) ** 2, axis=0))
    assert np.all(off <= 0.06 * np.maximum(size, 0.1 * size.max()))


def test_the_joint_swings_in_its_play_as_the_fitted_robot_would():
    model, effects, width = racer("running"), ("servo_backlash",), {"servo_backlash.width": 0.05}
    given = {**model.nominal, **width}
    light, heavy = (
        model.simulated.angle(0, {**given, "I2": share * given["I2"]}, effects)
        for share in (0.5, 2.0)
    )
    assert np.abs(light - heavy).max() > 1e-3
