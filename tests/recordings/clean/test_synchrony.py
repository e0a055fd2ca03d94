"""The servo's log puts a recording on the command's clock, and leaves the servo's own lag in it."""

import numpy as np
import pytest
from scipy.signal import lfilter

from rr_opt.model.experiment import CHANNELS, Recording
from rr_opt.model.gait import SineGait
from rr_opt.recordings.readers.plain_csv import ServoLog
from rr_opt.recordings.servo_clock import synchronised

COUNT = np.radians(300) / 1024
FINE = np.arange(-40, 60, 1e-3)
"""The command's clock, s, on which all is simulated."""


def late(command, tau):
    """A servo of first order: an exact step each millisecond."""
    share = 1 - np.exp(-1e-3 / tau)
    return lfilter([share], [1, share - 1], command - command[0]) + command[0]


def with_play(shaft, width):
    """What a shaft pushes from side to side."""
    moved, at = shaft.copy(), shaft[0]
    for i, one in enumerate(shaft):
        at = min(max(at, one - width / 2), one + width / 2)
        moved[i] = at
    return moved


def recorded(rng, clock, gait, start="running", log_starts=-0.3, tau=0.0, play=0.0):
    """A recording whose t is the command's time less `clock`, and the log, minutes apart."""
    command = gait.angle(np.maximum(FINE, 0.0 if start == "rest" else -20 * gait.period))
    shaft = late(command, tau) if tau else command
    platform = with_play(shaft, play) if play else shaft
    t = np.arange(0, 20, 0.01)
    n = len(t)
    phi = np.interp(t + clock, FINE, platform) + rng.normal(0, 3e-3, n)
    values = {name: phi if name == "phi" else np.zeros(n) for name in CHANNELS}
    sigma = {name: np.full(n, 3e-3) for name in CHANNELS}
    flags = {name: np.zeros(n, np.uint8) for name in CHANNELS}
    own = np.arange(0, 22, 0.004)
    goal, present = (
        np.round(np.interp(own * (1 + 5e-5) + log_starts, FINE, one) / COUNT)
        for one in (command, shaft)
    )
    log = ServoLog("log.csv", own + 500, goal, present, goal * COUNT, present * COUNT, COUNT, 250.0)
    return Recording("run.csv", t, values, sigma, flags), log


@pytest.mark.parametrize("start", ["rest", "running"])
def test_offsets_lie_in_their_intervals(start):
    rng, inside, tries = np.random.default_rng(1), 0, 20
    for _ in range(tries):
        clock, period = rng.uniform(-0.3, 0.3), rng.uniform(0.8, 1.6)
        gait = SineGait(rng.uniform(0.3, 0.9), period, 0.1)
        made = synchronised(*recorded(rng, clock, gait, start, rng.uniform(-0.5, 0.5)), gait, start)
        low, high = made.shift.interval()
        inside += low < clock < high
        assert made.shift.applied
        assert abs(made.shift.offset - clock) < 1e-3
        np.testing.assert_allclose(made.recording.t[[0, -1]] - [0, 19.99], clock, atol=2e-3)
    assert inside >= 0.8 * tries


def test_a_command_that_begins_is_found_seconds_away():
    rng, gait = np.random.default_rng(2), SineGait(0.6, 1.0, 0.1)
    made = synchronised(*recorded(rng, -4.3, gait, "rest", -6.0), gait, "rest")
    assert made.recording.t[0] == pytest.approx(-4.3, abs=1e-3)


@pytest.mark.parametrize("start", ["rest", "running"])
def test_what_the_servo_is_late_by_stays(start):
    rng, gait = np.random.default_rng(3), SineGait(0.6, 1.0, 0.1)
    made = synchronised(*recorded(rng, 0.15, gait, start, tau=0.04), gait, start)
    assert made.shift.offset == pytest.approx(0.15, abs=5e-4)


def test_a_clock_that_is_right_is_left_alone_without_a_doubt():
    rng, gait = np.random.default_rng(4), SineGait(0.6, 1.0, 0.1)
    recording, log = recorded(rng, 0.0, gait)
    log = ServoLog("log.csv", *(getattr(log, one) for one in (
        "t", "goal", "present", "goal_angle", "present_angle", "resolution", "rate")))  # fmt: skip
    made = synchronised(recording, log, gait)
    assert abs(made.shift.offset) < 1e-3
    if not made.shift.applied:
        np.testing.assert_array_equal(made.recording.t, recording.t)
        assert made.doubts == ()


def test_play_behind_the_shaft_is_not_taken_for_a_clock():
    rng, gait = np.random.default_rng(5), SineGait(0.6, 1.0, 0.1)
    recording, log = recorded(rng, 0.0, gait, play=0.03)
    made = synchronised(recording, log, gait)
    # By friction it makes phi late, which nothing tells from a clock.
    assert abs(made.shift.offset) > 3e-3
    assert not made.shift.applied
    assert "moves less than the servo's shaft" in made.doubts[0]


def test_a_log_of_another_run_is_not_used():
    rng, gait = np.random.default_rng(6), SineGait(0.6, 1.0, 0.1)
    recording, _ = recorded(rng, 0.0, gait)
    _, log = recorded(rng, 0.0, SineGait(0.6, 0.73, 0.1))
    made = synchronised(recording, log, gait)
    assert made.shift is None
    assert "another run's log" in made.doubts[0]
    np.testing.assert_array_equal(made.recording.t, recording.t)


def test_the_goal_of_another_gait_is_told():
    rng, gait = np.random.default_rng(7), SineGait(0.6, 1.0, 0.1)
    made = synchronised(*recorded(rng, 0.2, gait), SineGait(0.4, 1.0, 0.1))
    assert any("another gait" in doubt for doubt in made.doubts)


def test_a_goal_alone_shifts_nothing():
    rng, gait = np.random.default_rng(8), SineGait(0.6, 1.0, 0.1)
    recording, log = recorded(rng, 0.2, gait, tau=0.04)
    alone = ServoLog("log.csv", log.t, log.goal, None, log.goal_angle, None, COUNT, 250.0)
    made = synchronised(recording, alone, gait)
    assert made.shift is None
    assert "`goal` and `present`" in made.doubts[0]
