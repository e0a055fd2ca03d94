"""From rows that a known robot made without scatter, the search finds what made them."""

from __future__ import annotations

import numpy as np
import pytest

from rr_paper.calibration.fit import fit, leave_one_out, library
from rr_paper.calibration.models import MODELS, READINGS, Measured, measured, one_way

TRUTH = np.array([[0.4, 0.55, 0.5, 0.6, 0.8]])


def predict(points: np.ndarray) -> np.ndarray:
    return MODELS["viscous"](points, READINGS[0])


@pytest.fixture(scope="module")
def found():
    data = Measured(one_way(predict(TRUTH))[0], 0.1 * measured("mean").error)
    known = library(predict, 5, 11, lambda: None)
    return data, known, fit(predict, known, data, law="student", slices=6, steps=20)


def test_the_fit_is_perfect(found):
    data, _, best = found
    assert best.deviance < 0.01
    assert best.z(data) == pytest.approx(0, abs=0.1)


def test_a_row_left_out_has_no_say_in_its_prediction(found):
    data, known, best = found
    spoiled = Measured(data.speed.copy(), data.error)
    spoiled.speed[8] *= 1.5
    # By the normal law: Student's would pass over the spoiled row even if it counted.
    predictions = [
        rows.error[8]
        * leave_one_out(predict, known, rows, best, law="normal", slices=2, steps=20)[8]
        + rows.speed[8]
        for rows in (data, spoiled)
    ]
    assert predictions[0] == pytest.approx(predictions[1], rel=0.02)
    assert predictions[0] == pytest.approx(data.speed[8], rel=0.1)
