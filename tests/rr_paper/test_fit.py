"""The fit finds a robot that was planted, and p is that of Student's t."""

from dataclasses import replace

import pytest
from scipy import stats

from rr_paper import consistency as fit
from rr_paper.consistency import ABOUT_P, ROWS, Tried, predicted, prototype
from rr_paper.equation3 import CORRECTED

PLANTED = {"a1": 0.01, "a2": -0.005, "b": 0.05, "k": 0.12}


def test_a_planted_robot(monkeypatch):
    speeds = -predicted(prototype(**PLANTED), ABOUT_P, 1.1)
    rows = tuple(replace(row, mean=float(v)) for row, v in zip(ROWS, speeds, strict=True))
    monkeypatch.setattr(fit, "ROWS", rows)
    found = fit.fit(ABOUT_P, "mean", fixed={"b": 0.05})
    assert found.chi2 < 1e-4
    assert found.values["k"] == pytest.approx(PLANTED["k"], rel=0.1)
    assert found.values["amplitude"] == pytest.approx(1.1, rel=0.1)
    assert found.free == 4


def test_p_of_one_square():
    one = fit.Fit({}, (), 4.303**2, len(ROWS) - 1)
    p = Tried("ratio", "", ABOUT_P, CORRECTED, "mean", one).p
    assert p == pytest.approx(2 * stats.t.sf(4.303, 2), abs=2e-3)
