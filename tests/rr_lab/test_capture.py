"""The capture system sees the tracked point with its noise and its gaps."""

import numpy as np
import pytest

from rr_lab.case import record
from rr_opt.model.experiment import Flag, Noise
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from rr_opt.motion.rollout import rollout
from tests.rr_lab.reduced import LONG

GAIT = SineGait(0.6, 1.0, 0.2)


def test_noise_has_its_size_and_its_seed():
    true = record(LONG, GAIT, 5.0)
    seen, again, other = (
        record(LONG, GAIT, 5.0, noise=Noise(1e-3, 4e-3), seed=seed) for seed in (1, 1, 2)
    )
    for channel, size in (("x", 1e-3), ("y", 1e-3), ("psi", 4e-3), ("phi", 4e-3)):
        error = seen.values[channel] - true.values[channel]
        assert np.std(error) == pytest.approx(size, rel=0.15)
        assert abs(np.mean(error)) < 4 * size / np.sqrt(len(error))
        np.testing.assert_array_equal(seen.values[channel], again.values[channel])
        assert (seen.values[channel] != other.values[channel]).all()


def test_lost_samples_are_flagged():
    seen = record(LONG, GAIT, 5.0, missing=0.2)
    lost = np.isnan(seen.values["x"])
    assert lost.mean() == pytest.approx(0.2, abs=0.07)
    np.testing.assert_array_equal(seen.flags["x"] == Flag.MISSING, lost)


def test_tracked_point_turns_with_platform_1():
    use = EffectUse("marker_offset", {"dx": 0.02, "dy": 0.01})
    true, seen = record(LONG, GAIT, 2.0), record(LONG, GAIT, 2.0, effects=[use])
    psi = true.values["psi"]
    np.testing.assert_array_equal(seen.values["psi"], psi)
    dx = seen.values["x"] - true.values["x"]
    dy = seen.values["y"] - true.values["y"]
    np.testing.assert_allclose(np.cos(psi) * dx + np.sin(psi) * dy, 0.02, atol=1e-9)
    np.testing.assert_allclose(np.cos(psi) * dy - np.sin(psi) * dx, 0.01, atol=1e-9)


def test_torque_is_the_servos_on_platform_2():
    seen = record(LONG, GAIT, 2.0, "running", torque=True, periods=20)
    steady = rollout(LONG, GAIT, 2.0, "steady", 100)
    error = seen.values["torque"] - steady.torque
    assert np.abs(error).max() < 0.01 * np.abs(steady.torque).max()
