"""A resized gait keeps its shape: it is the old angle, stretched in time and about its mean."""

import numpy as np
import pytest

from tests.motion.gaits import EVERY


@pytest.mark.parametrize("gait", EVERY.values(), ids=EVERY)
def test_shape_is_kept(gait):
    new = gait.resized(2 * gait.amplitude, 3.1, -0.3)
    assert new.shape == gait.shape
    t = np.linspace(0, 1, 41)
    swing = gait.angle(t * gait.period) - gait.offset
    assert new.angle(t * 3.1) == pytest.approx(2 * swing - 0.3, abs=1e-12)
    assert new.amplitude == pytest.approx(2 * gait.amplitude, rel=1e-12)
    assert new.offset == pytest.approx(-0.3, rel=1e-12)


@pytest.mark.parametrize("gait", EVERY.values(), ids=EVERY)
def test_its_own_size_changes_nothing(gait):
    same = gait.resized(gait.amplitude, gait.period, gait.offset)
    t = np.linspace(0, gait.period, 23)
    assert same.angle(t) == pytest.approx(gait.angle(t), abs=1e-15)
