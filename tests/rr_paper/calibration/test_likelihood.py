"""A row's deviance is minus twice Student's log-likelihood; a half width is 4.303 errors."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import norm, t

from rr_paper.calibration.fit import measured, row_deviance, simulated, weight
from rr_paper.publication import COLUMNS, ROWS

Z = np.linspace(-6, 6, 25)


def test_student():
    exact = -2 * (t.logpdf(Z, 2) - t.logpdf(0, 2))
    assert row_deviance(Z, "student") == pytest.approx(exact)


def test_normal():
    exact = -2 * (norm.logpdf(Z) - norm.logpdf(0))
    assert row_deviance(Z, "normal") == pytest.approx(exact)


@pytest.mark.parametrize("distribution", ["student", "normal"])
def test_the_weight_is_the_slope(distribution):
    h = 1e-5
    square = Z[Z > 0] ** 2
    before, after = (row_deviance(np.sqrt(at), distribution) for at in (square, square + h))
    slope = (after - before) / h
    assert weight(np.sqrt(square), distribution) == pytest.approx(slope, rel=1e-3)


def test_what_is_not_a_number_fits_nothing():
    assert row_deviance(np.array([np.nan]), "student") == np.inf


@pytest.mark.parametrize("column", COLUMNS)
def test_the_standard_error(column):
    printed = [row.half_width for row in ROWS]
    assert measured(column).error * t.ppf(0.975, 2) == pytest.approx(printed)


def test_simulated_intervals_keep_their_level():
    """95 % of the intervals mean +- 4.303 errors contain the truth."""
    data = measured("mean")
    truth = np.tile(data.speed, (4000, 1))
    generated = simulated(truth, data, np.random.default_rng(0))
    inside = np.abs(generated.speed - truth) <= t.ppf(0.975, 2) * generated.error
    assert inside.mean() == pytest.approx(0.95, abs=0.005)
    assert np.sqrt((generated.error**2).mean(axis=0)) == pytest.approx(data.error, rel=0.05)
