"""Offsets and drifts of clocks lie in their 95 % intervals about as often as that says."""

import numpy as np
import pytest
from scipy.signal import lfilter

from rr_opt.model.experiment import Recording
from rr_opt.model.gait import SineGait
from rr_opt.recordings.clock_fit import against_command, clock_fit
from rr_opt.recordings.nuisances import command
from rr_opt.recordings.nuisances.evidence import ExaminedRecording
from rr_opt.recordings.readers.plain_csv import ServoLog
from rr_opt.recordings.servo_clock import against_log, log_notices

GAIT = SineGait(0.7, 1.1, 0.1)
T = np.arange(0, 30, 0.01)
COUNT = np.radians(300) / 1024


def notices(phi):
    """Of an angle against its command."""
    still = np.zeros(len(T))
    given = ExaminedRecording(Recording.of(T, x=still, y=still, psi=still, phi=phi), None, GAIT)
    return list(command.look(given))


@pytest.mark.parametrize("memory", [0.0, 0.7])
def test_the_command_s_clock_is_covered_in_white_and_in_coloured_noise(memory):
    rng, inside, tries = np.random.default_rng(1), np.zeros(2), 100
    for _ in range(tries):
        offset, drift = rng.uniform(-0.1, 0.1), rng.uniform(-2e-4, 2e-4)
        noise = lfilter([1], [1, -memory], rng.normal(0, 3e-3, len(T)))
        phi = GAIT.angle(T + offset + drift * (T - 15)) + noise
        phi[rng.random(len(T)) < 0.03] = np.nan
        fit = against_command(T, phi, GAIT)
        true = (offset + drift * (fit.t_mid - 15), drift)
        for i, value in enumerate(true):
            low, high = fit.interval(i)
            inside[i] += low <= value <= high
    # 95 % of 100 are 95; binomial noise alone is 2.
    assert (inside >= 0.88 * tries).all()
    assert (inside < tries).all()


def test_a_clock_that_has_the_date_is_fitted_as_well():
    phi = GAIT.angle(T + 0.05) + np.random.default_rng(3).normal(0, 3e-3, len(T))

    def fitted(date):
        return clock_fit(T, phi, lambda u: (GAIT.angle(u - date), GAIT.rate(u - date)), date)

    near, far = fitted(0.0), fitted(1.7e9)
    assert far.offset - 1.7e9 == pytest.approx(near.offset, abs=1e-6)
    assert far.drift == pytest.approx(near.drift, abs=1e-7)
    assert far.residual == pytest.approx(near.residual, rel=1e-4)


def log_of(offset, drift, true, rng):
    """A log in counts at 250 Hz whose clock has T + offset + drift (T - 15)."""
    when = np.arange(-1, 29, 0.004)
    counts = np.round(true(when) / COUNT)
    clock = when + offset + drift * (when - 15)
    return ServoLog("log.csv", clock, None, counts, None, counts * COUNT, COUNT, 250.0)


def test_the_servo_s_clock_is_found_seconds_away_and_covered():
    rng, inside, tries = np.random.default_rng(2), 0, 30
    for _ in range(tries):
        offset, drift, period = (
            rng.uniform(-20, 20),
            rng.uniform(-2e-4, 2e-4),
            rng.uniform(0.8, 1.6),
        )

        def true(u, period=period):
            return np.where(u < 3, 0, 0.7 * np.sin(2 * np.pi * (u - 3) / period))

        phi = true(T) + rng.normal(0, 3e-3, len(T))
        (fit,) = against_log(T, phi, log_of(offset, drift, true, rng))
        low, high = fit.interval(0)
        inside += low <= offset + drift * (fit.t_mid - 15) <= high
        assert fit.sigma[0] < 2e-3
    assert inside >= 0.86 * tries


def test_a_motion_that_only_repeats_leaves_whole_periods_open_and_the_longest_overlap_is_taken():
    rng = np.random.default_rng(3)
    phi = GAIT.angle(T) + rng.normal(0, 3e-3, len(T))
    fit, *others = against_log(T, phi, log_of(0.3, 0.0, GAIT.angle, rng))
    apart = [round((other.offset - fit.offset) / GAIT.period, 2) for other in others]
    assert {-1, 1} & set(apart)
    assert all(one == round(one) for one in apart)
    assert all(fit.samples >= other.samples for other in others)
    told = list(log_notices(fit, None, None, tuple(other.offset for other in others)))
    assert "periodic" in told[1]


def test_a_lag_is_told_in_milliseconds_and_said_to_be_one_thing_with_a_clock():
    rng = np.random.default_rng(4)
    phi = GAIT.angle(T - 0.038) + rng.normal(0, 3e-3, len(T))
    (doubt,) = notices(phi)
    assert "phi lags its command by 38" in doubt
    assert "their effect is the same" in doubt


def test_a_lead_is_the_clock_s():
    phi = GAIT.angle(T + 0.02) + np.random.default_rng(6).normal(0, 3e-3, len(T))
    (doubt,) = notices(phi)
    assert "phi leads its command by 20" in doubt
    assert "servo delay" not in doubt


def test_no_lag_is_told_where_there_is_none_and_degrees_are_recognised():
    rng = np.random.default_rng(5)
    phi = GAIT.angle(T) + rng.normal(0, 3e-3, len(T))
    assert not notices(phi)
    (doubt,) = notices(np.degrees(phi))
    assert "one of them in degrees" in doubt


def test_what_does_not_move_has_no_clock():
    assert against_command(T, np.zeros(len(T)), GAIT) is None
    assert against_command(T, np.full(len(T), np.nan), GAIT) is None


def test_a_sign_the_other_way_round_is_half_a_period():
    phi = 0.2 - GAIT.angle(T) + np.random.default_rng(7).normal(0, 3e-3, len(T))
    (doubt,) = notices(phi)
    assert "half a period off its command" in doubt
