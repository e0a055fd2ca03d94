"""A recorder's clock that runs at another rate than the command's is told and made up for."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.recordings.clock_fit import at_commanded_rate
from tests.sysid.made_up import with_effect


@pytest.fixture(scope="module")
def experiment():
    return with_effect({"servo_lag.tau": 0.03}, ("servo_lag",), seconds=20.0).experiment


def slowed(experiment, rate):
    runs = [
        replace(run, recording=replace(run.recording, t=run.recording.t * rate))
        for run in experiment.runs
    ]
    return replace(experiment, runs=tuple(runs))


@pytest.mark.parametrize("rate", [0.99, 1.0005, 1.01])
def test_times_are_those_of_the_command(experiment, rate):
    found = at_commanded_rate(slowed(experiment, rate))
    for run, true in zip(found.runs, experiment.runs, strict=True):
        assert np.abs(run.recording.t - true.recording.t).max() < 2e-3
        assert "period of phi differs from its command's" in run.recording.doubts[-1]


def test_a_clock_that_is_right_is_left_alone(experiment):
    assert at_commanded_rate(experiment) is experiment
