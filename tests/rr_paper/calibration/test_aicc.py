"""AICc charges for the unknowns by its formula, and is undefined where there are too few rows."""

from __future__ import annotations

import pytest

from rr_paper.calibration.comparison import AICc


@pytest.mark.parametrize(
    ("rows", "unknowns", "penalty"), [(9, 5, 10 + 20), (9, 6, 12 + 42), (6, 4, 8 + 40)]
)
def test_the_penalty(rows: int, unknowns: int, penalty: float):
    assert AICc(rows, unknowns, 7.0).value == pytest.approx(7.0 + penalty)


@pytest.mark.parametrize(("rows", "unknowns"), [(6, 5), (6, 6), (9, 8)])
def test_undefined(rows: int, unknowns: int):
    assert AICc(rows, unknowns, 7.0).value is None
