"""Where nothing is missing the chance of the misfit is even between 0 and 1."""

import numpy as np
from scipy.stats import kstest

from rr_opt.sysid.candidate import chance
from rr_opt.sysid.diagnose import Steps, answer, found
from tests.sysid.made_up import base_of, with_effect


def test_even_over_recordings_of_the_robot_as_it_is():
    chances = [
        chance(base_of(with_effect({}, (), seed=seed, rate=25.0)).whole) for seed in range(100, 116)
    ]
    assert kstest(chances, "uniform").pvalue > 0.01
    assert np.ptp(chances) > 0.5


def test_and_next_to_none_where_something_is():
    model = with_effect({"floor_tilt.tilt_x": 0.002, "floor_tilt.tilt_y": 0.0}, ("floor_tilt",))
    said = answer(found(model, Steps()))
    assert said.mismatch.p_value < 1e-6
    assert said.mismatch.rms > 0.1
