"""The recorded motion without its noise."""

import numpy as np
import pytest
from scipy.signal import savgol_filter

from rr_opt.machines.racer.observed import _parabolas, observed
from rr_opt.sysid.model import Request
from tests.sysid.made_up import whole, with_effect


@pytest.mark.parametrize(("samples", "half"), [(300, 25), (60, 2), (51, 25)])
def test_parabolas_are_those_of_savitzky_and_golay(samples, half):
    y = np.random.default_rng(1).normal(size=(samples, 3))
    value, slope = _parabolas(y, half, 0.01)
    about = {"window_length": 2 * half + 1, "polyorder": 2, "axis": 0, "delta": 0.01}
    np.testing.assert_allclose(value, savgol_filter(y, **about), atol=1e-12)
    np.testing.assert_allclose(slope, savgol_filter(y, deriv=1, **about), atol=1e-9)


def test_the_joint_is_where_it_was_whatever_is_recorded_of_it():
    model = with_effect({}, ())
    away = {"marker_offset.dx": 0.05, "marker_offset.dy": -0.02, "psi_zero": 0.1}
    segment, seen = whole(model, 1), []
    start = model.initial_state(segment, (), {})
    for values, effects in (({}, ()), (away, ("marker_offset", "zero_offset"))):
        request = Request(segment, values, start)
        model.runs[1].values[:] = model.predicted(request, effects)
        seen += observed(model, [request], effects)
    plain, other = seen
    for name in ("x", "y", "psi", "u", "places"):
        np.testing.assert_allclose(getattr(other, name), getattr(plain, name), atol=1e-9)
