"""The gait's peak angle and rate are reached within a period and never passed."""

import numpy as np
import pytest
from hypothesis import given

from rr_opt.model.gait import SineGait
from tests.mechanics.cases import REPEATABLE, numbers


@REPEATABLE
@given(numbers(-2.6, 2.6), numbers(0.3, 3.0), numbers(-1.0, 1.0))
def test_peaks_are_the_largest_samples(amplitude, period, offset):
    gait = SineGait(amplitude, period, offset)
    # A multiple of four: both ends of the swing and the passage through the middle are sampled.
    t = np.arange(400) * period / 400
    assert np.abs(gait.angle(t)).max() == pytest.approx(gait.peak_angle, rel=1e-12, abs=1e-15)
    assert np.abs(gait.rate(t)).max() == pytest.approx(gait.peak_rate, rel=1e-12, abs=1e-15)


def test_the_papers_own_run_is_faster_than_its_table_1():
    # T = 1 s and alpha = 0.785 of Table 3 ask for 47 rpm; Table 1 allows 30.
    assert SineGait(0.785, 1.0).peak_rate * 60 / (2 * np.pi) == pytest.approx(47.1, abs=0.05)
