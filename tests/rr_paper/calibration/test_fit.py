"""Fits side by side end where SciPy's least squares ends, and recover a known robot."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares

from rr_paper.calibration.fit import Data, Effort, descend, estimator, measured, one_way
from rr_paper.calibration.models import MODELS, READINGS, VISCOUS

DATA = measured("mean")
STARTS = np.random.default_rng(5).uniform(0.2, 0.8, (6, 5))
TRUTH = np.array([[0.4, 0.55, 0.5, 0.6, 0.8]])


def signed(points: np.ndarray) -> np.ndarray:
    return MODELS[VISCOUS](points, READINGS[0])


def predict(points: np.ndarray) -> np.ndarray:
    return one_way(signed(points))


def by_scipy(start: np.ndarray) -> float:
    """The normal deviance, by a trust region inside the box."""
    found = least_squares(
        lambda x: DATA.z(predict(x[None])[0]),
        start, bounds=(0, 1), x_scale=0.1, diff_step=1e-4,
    )  # fmt: skip
    return float(2 * found.cost)


def test_the_best_is_the_same():
    _, deviance = descend(predict, STARTS, DATA, 80, distribution="normal")
    assert deviance.min() == pytest.approx(min(by_scipy(start) for start in STARTS), rel=2e-3)


def test_it_never_climbs_and_stays_inside():
    x, deviance = descend(predict, STARTS, DATA, 10)
    assert (deviance <= DATA.deviance(predict(STARTS))).all()
    assert ((x >= 0) & (x <= 1)).all()


def test_fixed_unknowns_stay():
    fixed = np.array([True, False, False, True, False])
    x, _ = descend(predict, STARTS, DATA, 10, fixed=fixed)
    assert x[:, fixed] == pytest.approx(STARTS[:, fixed], abs=0)
    assert not np.allclose(x[:, ~fixed], STARTS[:, ~fixed])


def test_a_row_left_out_does_not_count():
    counted = np.ones(9)
    counted[8] = 0
    spoiled = Data(DATA.speed.copy(), DATA.error)
    spoiled.speed[8] = 40.0
    ends = [descend(predict, STARTS, data, 10, counted=counted)[1] for data in (DATA, spoiled)]
    assert ends[0] == pytest.approx(ends[1])


@pytest.fixture(scope="module")
def known():
    """Rows of a known robot without scatter, and an estimator."""
    work = Effort(log2_size=11, slices=6, values=0, starts=0, steps=20, sets=0)
    data = Data(predict(TRUTH)[0], 0.1 * DATA.error)
    return data, estimator(signed, 5, work)


def test_a_known_robot_is_recovered(known):
    data, fitter = known
    best = fitter.fit(data)
    assert best.deviance < 0.01
    assert best.z(data) == pytest.approx(0, abs=0.1)


def test_a_row_left_out_does_not_affect_its_prediction(known):
    data, fitter = known
    best = fitter.fit(data)
    spoiled = Data(data.speed.copy(), data.error)
    spoiled.speed[8] *= 1.5
    # By the normal distribution: Student's t would ignore the spoiled row even if it counted.
    predictions = [
        rows.error[8] * fitter.leave_one_out(rows, best, "normal")[8] + rows.speed[8]
        for rows in (data, spoiled)
    ]
    assert predictions[0] == pytest.approx(predictions[1], rel=0.02)
    assert predictions[0] == pytest.approx(data.speed[8], rel=0.1)
