"""The recorded motion without its noise."""

import numpy as np
import pytest
from scipy.signal import savgol_filter

from rr_opt.machines.racer.observed import _parabolas


@pytest.mark.parametrize(("samples", "half"), [(300, 25), (60, 2), (51, 25)])
def test_parabolas_are_those_of_savitzky_and_golay(samples, half):
    y = np.random.default_rng(1).normal(size=(samples, 3))
    value, slope = _parabolas(y, half, 0.01)
    about = {"window_length": 2 * half + 1, "polyorder": 2, "axis": 0, "delta": 0.01}
    np.testing.assert_allclose(value, savgol_filter(y, **about), atol=1e-12)
    np.testing.assert_allclose(slope, savgol_filter(y, deriv=1, **about), atol=1e-9)
