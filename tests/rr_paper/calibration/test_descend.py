"""Fits side by side end where scipy's least squares ends, one at a time."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares

from rr_paper.calibration.fit import descend, problems
from rr_paper.calibration.models import MODELS, READINGS, measured, one_way

DATA = measured("mean")
STARTS = np.random.default_rng(5).uniform(0.2, 0.8, (6, 5))


def predict(points: np.ndarray) -> np.ndarray:
    return one_way(MODELS["viscous"](points, READINGS[0]))


def by_scipy(start: np.ndarray) -> float:
    """The normal law's deviance, by a trust region inside the box."""
    found = least_squares(
        lambda x: (predict(x[None])[0] - DATA.speed) / DATA.error,
        start, bounds=(0, 1), x_scale=0.1, diff_step=1e-4,
    )  # fmt: skip
    return float(2 * found.cost)


def test_the_best_is_the_same():
    posed = problems(predict, STARTS, DATA.speed, DATA.error, law="normal")
    _, found = descend(posed, STARTS, 80)
    assert found.min() == pytest.approx(min(by_scipy(start) for start in STARTS), rel=2e-3)


def test_it_never_climbs_and_stays_inside():
    posed = problems(predict, STARTS, DATA.speed, DATA.error)
    before = posed.deviance(predict(STARTS), np.arange(len(STARTS)))
    x, found = descend(posed, STARTS, 10)
    assert (found <= before).all()
    assert ((x >= 0) & (x <= 1)).all()


def test_what_is_held_stays():
    held = np.tile([True, False, False, True, False], (6, 1))
    posed = problems(predict, STARTS, DATA.speed, DATA.error, fixed=held)
    x, _ = descend(posed, STARTS, 10)
    assert x[held] == pytest.approx(STARTS[held], abs=0)
    assert not np.allclose(x[~held], STARTS[~held])


def test_a_row_left_out_does_not_count():
    counted = np.ones((6, 9))
    counted[:, 8] = 0
    spoiled = DATA.speed.copy()
    spoiled[8] = 40.0
    ends = []
    for target in (DATA.speed, spoiled):
        posed = problems(predict, STARTS, target, DATA.error, counted=counted)
        ends.append(descend(posed, STARTS, 10)[1])
    assert ends[0] == pytest.approx(ends[1])
